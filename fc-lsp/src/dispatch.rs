//! The table of requests and their handlers.

use crate::snapshot::Snapshot;
use crate::{
    actions, completion, definition, document_symbols, fix_all, formatting, hover, lenses,
    prepare_rename, references, rename, workspace_symbols,
};
use gen_lsp_types as lsp;
use lsp::Request as _;
use lsp_server::{ErrorCode, Request, RequestId, Response, ResponseError};
use serde_json::Value;

/// Returns the capabilities of the server for the response to `initialize`.
pub fn capabilities(encoding: crate::Encoding) -> lsp::ServerCapabilities {
    lsp::ServerCapabilities {
        position_encoding: Some(match encoding {
            crate::Encoding::Utf8 => lsp::PositionEncodingKind::UTF8,
            crate::Encoding::Utf16 => lsp::PositionEncodingKind::UTF16,
        }),
        text_document_sync: Some(
            lsp::TextDocumentSyncOptions {
                open_close: Some(true),
                change: Some(lsp::TextDocumentSyncKind::Incremental),
                ..lsp::TextDocumentSyncOptions::default()
            }
            .into(),
        ),
        completion_provider: Some(lsp::CompletionOptions {
            trigger_characters: Some([" ", "{", "[", ","].map(str::to_owned).to_vec()),
            ..lsp::CompletionOptions::default()
        }),
        hover_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        document_symbol_provider: Some(true.into()),
        workspace_symbol_provider: Some(true.into()),
        code_action_provider: Some(
            lsp::CodeActionOptions {
                code_action_kinds: Some(vec![
                    lsp::CodeActionKind::QuickFix,
                    lsp::CodeActionKind::SourceFixAll,
                ]),
                ..lsp::CodeActionOptions::default()
            }
            .into(),
        ),
        code_lens_provider: Some(lsp::CodeLensOptions::default()),
        document_formatting_provider: Some(true.into()),
        rename_provider: Some(
            lsp::RenameOptions {
                prepare_provider: Some(true),
                ..lsp::RenameOptions::default()
            }
            .into(),
        ),
        ..lsp::ServerCapabilities::default()
    }
}

/// Returns `true` if a request needs a checked snapshot or a separate check. The worker then answers it instead of the
/// loop.
pub fn waits(method: &str, snapshot: &Snapshot) -> bool {
    let is_one = |others: &[lsp::LspRequestMethod<'_>]| {
        let mut others = others.iter();
        others.any(|other| other.as_str() == method)
    };
    if is_one(&[lsp::CodeActionRequest::METHOD]) {
        !snapshot.is_checked()
    } else if is_one(&[lsp::CodeLensRequest::METHOD]) {
        !snapshot.has_lenses()
    } else if is_one(&[
        lsp::CompletionRequest::METHOD,
        lsp::HoverRequest::METHOD,
        lsp::PrepareRenameRequest::METHOD,
    ]) {
        !snapshot.is_known()
    } else {
        is_one(&[lsp::RenameRequest::METHOD])
    }
}

/// Returns an error response.
pub fn refusal(id: RequestId, code: ErrorCode, message: &str) -> Response {
    Response::new_err(id, code as i32, message.to_owned())
}

/// Handles a request. Without a project there is no snapshot, and the result is empty.
pub fn answer(request: Request, snapshot: Option<&Snapshot>) -> Response {
    let Request { id, method, params } = request;
    let ask = Ask {
        id,
        params,
        snapshot,
    };
    match method.as_str() {
        m if m == lsp::CompletionRequest::METHOD.as_str() => {
            ask.of::<lsp::CompletionRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let offset = snapshot.offset(&at.text_document.uri, at.position)?;
                Some(completion(snapshot, offset).into())
            })
        }
        m if m == lsp::HoverRequest::METHOD.as_str() => {
            ask.of::<lsp::HoverRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let offset = snapshot.offset(&at.text_document.uri, at.position)?;
                hover(snapshot, offset)
            })
        }
        m if m == lsp::DefinitionRequest::METHOD.as_str() => {
            ask.of::<lsp::DefinitionRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let offset = snapshot.offset(&at.text_document.uri, at.position)?;
                let place = definition(snapshot, offset)?;
                Some(lsp::Definition::from(place).into())
            })
        }
        m if m == lsp::ReferencesRequest::METHOD.as_str() => {
            ask.of::<lsp::ReferencesRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let offset = snapshot.offset(&at.text_document.uri, at.position)?;
                references(snapshot, offset, params.context.include_declaration)
            })
        }
        m if m == lsp::DocumentSymbolRequest::METHOD.as_str() => ask
            .of::<lsp::DocumentSymbolRequest>(|snapshot, params| {
                let file = snapshot.file(&params.text_document.uri)?;
                Some(document_symbols(snapshot, file).into())
            }),
        m if m == lsp::WorkspaceSymbolRequest::METHOD.as_str() => ask
            .of::<lsp::WorkspaceSymbolRequest>(|snapshot, params| {
                Some(workspace_symbols(snapshot, &params.query).into())
            }),
        m if m == lsp::CodeActionRequest::METHOD.as_str() => {
            ask.of::<lsp::CodeActionRequest>(|snapshot, params| {
                let uri = &params.text_document.uri;
                let only = params.context.only;
                let wants = |kind| only.as_ref().is_none_or(|only| is_among(kind, only));
                let mut found = Vec::new();
                if wants(lsp::CodeActionKind::QuickFix) {
                    found.extend(actions(snapshot, uri, params.range));
                }
                // Fix-all covers the whole file, so the client gets it only on request.
                if only.is_some() && wants(lsp::CodeActionKind::SourceFixAll) {
                    found.extend(fix_all(snapshot, uri));
                }
                Some(found.into_iter().map(Into::into).collect())
            })
        }
        m if m == lsp::CodeLensRequest::METHOD.as_str() => {
            ask.of::<lsp::CodeLensRequest>(|snapshot, params| {
                Some(lenses(snapshot, snapshot.file(&params.text_document.uri)?))
            })
        }
        m if m == lsp::DocumentFormattingRequest::METHOD.as_str() => ask
            .of::<lsp::DocumentFormattingRequest>(
            |snapshot, params| formatting(snapshot, &params.text_document.uri),
        ),
        m if m == lsp::PrepareRenameRequest::METHOD.as_str() => ask
            .of::<lsp::PrepareRenameRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let offset = snapshot.offset(&at.text_document.uri, at.position)?;
                prepare_rename(snapshot, offset).map(Into::into)
            }),
        m if m == lsp::RenameRequest::METHOD.as_str() => {
            ask.trying::<lsp::RenameRequest>(|snapshot, params| {
                let at = params.text_document_position_params;
                let Some(offset) = snapshot.offset(&at.text_document.uri, at.position) else {
                    return Ok(None);
                };
                rename(snapshot, offset, &params.new_name).map(Some)
            })
        }
        _ => {
            let message = format!("`{method}` is not known here");
            Response::new_err(ask.id, ErrorCode::MethodNotFound as i32, message)
        }
    }
}

/// Returns `true` if a kind of action equals one of `asked`, or is below one: `source.fixAll` is below `source`.
fn is_among(kind: lsp::CodeActionKind, asked: &[lsp::CodeActionKind]) -> bool {
    let kind = String::from(kind);
    asked.iter().any(|asked| {
        let asked = String::from(asked.clone());
        let below = kind.strip_prefix(&asked);
        below.is_some_and(|rest| asked.is_empty() || rest.is_empty() || rest.starts_with('.'))
    })
}

/// A request, and the snapshot that answers it.
struct Ask<'s> {
    id: RequestId,
    params: Value,
    snapshot: Option<&'s Snapshot>,
}

impl Ask<'_> {
    fn of<R: lsp::Request>(self, answer: impl FnOnce(&Snapshot, R::Params) -> R::Result) -> Response
    where
        R::Result: Default,
    {
        self.trying::<R>(|snapshot, params| Ok(answer(snapshot, params)))
    }

    /// Like [`Self::of`], for a handler that can fail with a sentence for the user.
    fn trying<R: lsp::Request>(
        self,
        answer: impl FnOnce(&Snapshot, R::Params) -> Result<R::Result, String>,
    ) -> Response
    where
        R::Result: Default,
    {
        let fails = |code: ErrorCode, message| ResponseError {
            code: code as i32,
            message,
            data: None,
        };
        let result = match (
            serde_json::from_value::<R::Params>(self.params),
            self.snapshot,
        ) {
            (Err(error), _) => Err(fails(ErrorCode::InvalidParams, error.to_string())),
            (Ok(_), None) => Ok(R::Result::default()),
            (Ok(params), Some(snapshot)) => {
                answer(snapshot, params).map_err(|message| fails(ErrorCode::RequestFailed, message))
            }
        };
        let response_result = result.and_then(|result| {
            serde_json::to_value(result)
                .map_err(|error| fails(ErrorCode::InternalError, error.to_string()))
        });
        Response {
            id: self.id,
            response_result,
        }
    }
}
