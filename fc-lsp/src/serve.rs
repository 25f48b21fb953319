//! The loop: messages in, answers and faults out.

use crate::diagnostics::diagnostics;
use crate::dispatch::{answer, capabilities};
use crate::project::Host;
use crate::settings::Settings;
use crate::uri;
use crate::workspace::Workspace;
use gen_lsp_types as lsp;
use lsp::Notification as _;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

/// Most messages that wait here; the client's further ones wait in its pipe.
const WAITING: usize = 256;

/// How long nothing may come before all is checked: a client that changes a text asks about it at once, and what it asks
/// need not wait for the check.
const QUIET: Duration = Duration::from_millis(15);

/// How often in a row something may come in that time.
const AT_MOST: usize = 8;

/// How often in a row checking may be begun again because the client has typed on in the meantime.
const SUPERSEDED: usize = 3;

/// Why serving ended before the client said so.
#[derive(Debug)]
pub struct ServeError(String);

impl fmt::Display for ServeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the client does not speak as a client should: {}",
            self.0
        )
    }
}

impl std::error::Error for ServeError {}

/// Serves a client until it says that it is done. Whether it has asked for that before, as it should.
///
/// All messages that wait are taken at once; what is wrong is found out once behind them, when no more come for a moment, and again rather than told
/// when the client has typed on in the meantime.
///
/// # Errors
/// [`ServeError`], where there is no beginning.
pub fn serve(connection: &Connection, host: &dyn Host) -> Result<bool, ServeError> {
    let (id, params) = connection
        .initialize_start()
        .map_err(|error| ServeError(error.to_string()))?;
    let settings = Arc::new(Settings::read(&params));
    let info = lsp::ServerInfo {
        name: "fc".to_owned(),
        version: Some(env!("CARGO_PKG_VERSION").to_owned()),
    };
    let result = lsp::InitializeResult {
        capabilities: capabilities(settings.encoding),
        server_info: Some(info),
    };
    let mut server = Server {
        connection,
        host,
        workspace: None,
        settings,
        published: BTreeMap::new(),
        touched: BTreeSet::new(),
        is_dirty: false,
        is_shut_down: false,
    };
    server.send(Response::new_ok(id, result));

    let receiver = connection.receiver.clone();
    let (sender, waiting) = sync_channel(WAITING);
    // It ends with the client's last message, or with this function.
    std::thread::spawn(move || receiver.iter().try_for_each(|message| sender.send(message)));
    Ok(server.run(&waiting))
}

struct Server<'h> {
    connection: &'h Connection,
    host: &'h dyn Host,
    workspace: Option<Workspace>,
    settings: Arc<Settings>,
    /// What the client was told last of each file of which it was told something.
    published: BTreeMap<String, Vec<lsp::Diagnostic>>,
    /// Files that have changed since.
    touched: BTreeSet<String>,
    /// Whether anything has.
    is_dirty: bool,
    is_shut_down: bool,
}

/// Whether the loop goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    GoOn,
    Exit,
}

impl Server<'_> {
    fn run(&mut self, waiting: &Receiver<Message>) -> bool {
        while let Ok(first) = waiting.recv() {
            let batch = std::iter::once(first).chain(waiting.try_iter());
            let mut next = self.handle(batch.take(WAITING).collect());
            let (mut waited, mut superseded) = (0, 0);
            while next == Next::GoOn && self.is_dirty {
                if waited < AT_MOST
                    && let Ok(first) = waiting.recv_timeout(QUIET)
                {
                    waited += 1;
                    let batch = std::iter::once(first).chain(waiting.try_iter());
                    next = self.handle(batch.take(WAITING).collect());
                    continue;
                }
                if let Some(workspace) = &mut self.workspace {
                    workspace.snapshot().analysis();
                }
                let more: Vec<_> = waiting.try_iter().take(WAITING).collect();
                if superseded < SUPERSEDED && more.iter().any(is_change) {
                    superseded += 1;
                } else {
                    self.publish();
                    (waited, superseded) = (0, 0);
                }
                next = self.handle(more);
            }
            if next == Next::Exit {
                return self.is_shut_down;
            }
        }
        false
    }

    fn handle(&mut self, batch: Vec<Message>) -> Next {
        let cancelled: Vec<RequestId> = batch.iter().filter_map(cancelled).collect();
        for message in batch {
            match message {
                Message::Request(request) if cancelled.contains(&request.id) => {
                    let message = "the client no longer wants to know".to_owned();
                    let code = ErrorCode::RequestCanceled as i32;
                    self.send(Response::new_err(request.id, code, message));
                }
                Message::Request(request) => self.request(request),
                Message::Notification(notification) => {
                    if self.notification(notification) == Next::Exit {
                        return Next::Exit;
                    }
                }
                Message::Response(_) => {}
            }
        }
        Next::GoOn
    }

    fn request(&mut self, request: Request) {
        let response = if self.is_shut_down {
            let code = ErrorCode::InvalidRequest as i32;
            Response::new_err(request.id, code, "the server is shut down".to_owned())
        } else if request.method == lsp::LspRequestMethod::Shutdown.as_str() {
            self.is_shut_down = true;
            Response::new_ok(request.id, ())
        } else {
            let snapshot = self.workspace.as_mut().map(Workspace::snapshot);
            answer(request, snapshot.as_deref())
        };
        self.send(response);
    }

    fn notification(&mut self, notification: Notification) -> Next {
        let Notification { method, params } = notification;
        match method.as_str() {
            m if m == lsp::ExitNotification::METHOD.as_str() => return Next::Exit,
            m if m == lsp::InitializedNotification::METHOD.as_str() => self.begin(),
            m if m == lsp::DidOpenTextDocumentNotification::METHOD.as_str() => {
                if let Some(params) = read::<lsp::DidOpenTextDocumentParams>(params) {
                    self.open(params.text_document);
                }
            }
            m if m == lsp::DidChangeTextDocumentNotification::METHOD.as_str() => {
                if let Some(params) = read::<lsp::DidChangeTextDocumentParams>(params) {
                    let document = params.text_document;
                    let uri = document.text_document_identifier.uri;
                    let changes = params.content_changes;
                    self.with(uri, |workspace, uri| {
                        workspace.change(uri, document.version, changes)
                    });
                }
            }
            m if m == lsp::DidCloseTextDocumentNotification::METHOD.as_str() => {
                if let Some(params) = read::<lsp::DidCloseTextDocumentParams>(params) {
                    self.with(params.text_document.uri, Workspace::close);
                }
            }
            m if m == lsp::DidChangeWatchedFilesNotification::METHOD.as_str() => {
                if let Some(params) = read::<lsp::DidChangeWatchedFilesParams>(params) {
                    self.files_changed(&params.changes);
                }
            }
            // Others need no answer.
            _ => {}
        }
        Next::GoOn
    }

    /// Looks for the project in the client's directories, and tells what is wrong with it.
    fn begin(&mut self) {
        if self.settings.can_watch {
            self.watch();
        }
        let folders = self.settings.folders.clone();
        let mut why = None;
        for folder in &folders {
            match self.find(folder) {
                Ok(()) => return,
                Err(error) => why = Some(error),
            }
        }
        if let Some(why) = why {
            // The first file that is opened may be in one.
            self.notify::<lsp::LogMessageNotification>(&lsp::LogMessageParams {
                kind: lsp::MessageType::Info,
                message: why,
            });
        }
    }

    fn find(&mut self, directory: &Path) -> Result<(), String> {
        let project = self.host.find(directory)?;
        let settings = Arc::clone(&self.settings);
        self.workspace = Some(Workspace::new(project, settings, self.host.today()));
        self.is_dirty = true;
        Ok(())
    }

    fn open(&mut self, document: lsp::TextDocumentItem) {
        if self.workspace.is_none()
            && let Some(file) = uri::to_path(document.uri.as_ref())
            && let Some(directory) = file.parent()
        {
            // Where there is no project, nothing is said of the file.
            let _ = self.find(directory);
        }
        let lsp::TextDocumentItem {
            uri, version, text, ..
        } = document;
        self.with(uri, |workspace, uri| {
            workspace.open(uri.clone(), version, text)
        });
    }

    fn with(&mut self, uri: lsp::Uri, change: impl FnOnce(&mut Workspace, &lsp::Uri) -> bool) {
        if let Some(workspace) = &mut self.workspace
            && change(workspace, &uri)
        {
            self.touched.insert(uri.0);
            self.is_dirty = true;
        }
    }

    fn files_changed(&mut self, changes: &[lsp::FileEvent]) {
        let Some(workspace) = &mut self.workspace else {
            return;
        };
        let mut files = changes
            .iter()
            .filter_map(|it| uri::to_path(it.uri.as_ref()));
        if files.any(|file| workspace.project().is_about(&file)) {
            // While `fc.yaml` cannot be read, the project stays as it was.
            if let Ok(project) = self.host.find(&workspace.project().root.clone()) {
                workspace.set_project(project);
            }
        } else {
            workspace.read();
        }
        self.is_dirty = true;
    }

    /// Tells the client what is wrong in each file, and of which nothing is any more.
    fn publish(&mut self) {
        self.is_dirty = false;
        let Some(workspace) = &mut self.workspace else {
            return;
        };
        let snapshot = workspace.snapshot();
        let mut found: BTreeMap<String, Vec<lsp::Diagnostic>> = BTreeMap::new();
        for (file, faults) in diagnostics(&snapshot) {
            if let Some(uri) = snapshot.uri(file) {
                found.insert(uri.0.clone(), faults);
            }
        }
        let touched = std::mem::take(&mut self.touched);
        let told = self.published.keys().chain(found.keys()).chain(&touched);
        let told: BTreeSet<String> = told.cloned().collect();
        for uri in told {
            let new = found.get(&uri);
            if new == self.published.get(&uri) && !touched.contains(&uri) {
                continue;
            }
            let uri = lsp::Uri(uri);
            let version = snapshot.file(&uri).and_then(|file| snapshot.version(file));
            self.notify::<lsp::PublishDiagnosticsNotification>(&lsp::PublishDiagnosticsParams {
                uri,
                version,
                diagnostics: new.cloned().unwrap_or_default(),
            });
        }
        self.published = found;
    }

    /// Asks the client to say when files change beside it.
    fn watch(&mut self) {
        let watchers = ["**/*.yaml", "**/releases/*.json"]
            .map(|pattern| serde_json::json!({ "globPattern": pattern }));
        let method = lsp::DidChangeWatchedFilesNotification::METHOD.as_str();
        let params = serde_json::json!({ "registrations": [
            { "id": "files", "method": method, "registerOptions": { "watchers": watchers } }
        ] });
        let method = lsp::LspRequestMethod::ClientRegisterCapability.as_str();
        let id = RequestId::from("files".to_owned());
        self.send(Request::new(id, method.to_owned(), params));
    }

    fn notify<N: lsp::Notification>(&self, params: &N::Params) {
        if let Ok(params) = serde_json::to_value(params) {
            let method = N::METHOD.as_str().to_owned();
            self.send(Notification { method, params });
        }
    }

    /// To a client that is gone nothing can be said; that it is gone shows where its next message would be.
    fn send(&self, message: impl Into<Message>) {
        let _ = self.connection.sender.send(message.into());
    }
}

/// The parameters of a notification; `None` where they are not as they should be, which nobody can be told.
fn read<P: DeserializeOwned>(params: serde_json::Value) -> Option<P> {
    serde_json::from_value(params).ok()
}

fn is_change(message: &Message) -> bool {
    let Message::Notification(notification) = message else {
        return false;
    };
    notification.method == lsp::DidChangeTextDocumentNotification::METHOD.as_str()
}

/// The request that a message takes back.
fn cancelled(message: &Message) -> Option<RequestId> {
    let Message::Notification(notification) = message else {
        return None;
    };
    if notification.method != lsp::LspNotificationMethod::CancelRequest.as_str() {
        return None;
    }
    serde_json::from_value(notification.params.get("id")?.clone()).ok()
}
