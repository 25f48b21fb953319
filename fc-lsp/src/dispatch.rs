//! The table of requests and their handlers.

use crate::snapshot::Snapshot;
use crate::{
    actions, completion, definition, document_symbols, fix_all, formatting, hover, lenses,
    prepare_rename, references, rename, workspace_symbols,
};
use gen_lsp_types as lsp;
use lsp::Request as _;
use lsp_server::{ErrorCode, Request, RequestId, Response, ResponseError};

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
    let dispatch = Dispatch {
        request,
        snapshot,
        response: None,
    };
    dispatch
        .on::<lsp::CompletionRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params)?;
            Some(completion(snapshot, at).into())
        })
        .on::<lsp::HoverRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params)?;
            hover(snapshot, at)
        })
        .on::<lsp::DefinitionRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params)?;
            Some(lsp::Definition::from(definition(snapshot, at)?).into())
        })
        .on::<lsp::ReferencesRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params)?;
            references(snapshot, at, params.context.include_declaration)
        })
        .on::<lsp::DocumentSymbolRequest>(|snapshot, params| {
            let file = snapshot.file(&params.text_document.uri)?;
            Some(document_symbols(snapshot, file).into())
        })
        .on::<lsp::WorkspaceSymbolRequest>(|snapshot, params| {
            Some(workspace_symbols(snapshot, &params.query).into())
        })
        .on::<lsp::CodeActionRequest>(|snapshot, params| {
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
        .on::<lsp::CodeLensRequest>(|snapshot, params| {
            let file = snapshot.file(&params.text_document.uri)?;
            Some(lenses(snapshot, file))
        })
        .on::<lsp::DocumentFormattingRequest>(|snapshot, params| {
            formatting(snapshot, &params.text_document.uri)
        })
        .on::<lsp::PrepareRenameRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params)?;
            prepare_rename(snapshot, at).map(Into::into)
        })
        .on_fallible::<lsp::RenameRequest>(|snapshot, params| {
            let at = snapshot.position(&params.text_document_position_params);
            let edit = at.map(|at| rename(snapshot, at, &params.new_name));
            edit.transpose()
        })
        .finish()
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

/// A request on its way through the handlers. The handler of its method sets the response.
struct Dispatch<'s> {
    request: Request,
    snapshot: Option<&'s Snapshot>,
    response: Option<Response>,
}

impl Dispatch<'_> {
    fn on<R: lsp::Request>(self, answer: impl FnOnce(&Snapshot, R::Params) -> R::Result) -> Self
    where
        R::Result: Default,
    {
        self.on_fallible::<R>(|snapshot, params| Ok(answer(snapshot, params)))
    }

    /// Like [`Self::on`], for a handler that can fail with a sentence for the user.
    fn on_fallible<R: lsp::Request>(
        mut self,
        answer: impl FnOnce(&Snapshot, R::Params) -> Result<R::Result, String>,
    ) -> Self
    where
        R::Result: Default,
    {
        if self.request.method != R::METHOD.as_str() {
            return self;
        }
        let fails = |code: ErrorCode, message| ResponseError {
            code: code as i32,
            message,
            data: None,
        };
        let params = std::mem::take(&mut self.request.params);
        let result = match (serde_json::from_value::<R::Params>(params), self.snapshot) {
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
        self.response = Some(Response {
            id: self.request.id.clone(),
            response_result,
        });
        self
    }

    fn finish(self) -> Response {
        let Request { id, method, .. } = self.request;
        self.response.unwrap_or_else(|| {
            let message = format!("`{method}` is not known here");
            refusal(id, ErrorCode::MethodNotFound, &message)
        })
    }
}
