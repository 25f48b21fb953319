//! The main loop of the server.

use crate::diagnostics::diagnostics;
use crate::dispatch::{answer, capabilities, refusal, waits};
use crate::event::Event;
use crate::lens;
use crate::project::Project;
use crate::settings::Settings;
use crate::snapshot::Snapshot;
use crate::uri;
use crate::worker::Worker;
use crate::workspace::Workspace;
use fc_codegen::project::ProjectDirs;
use fc_spec::model::Text;
use gen_lsp_types as lsp;
use lsp::Notification as _;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use serde::Deserialize as _;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, sync_channel};

/// The maximum number of waiting messages. Further messages wait in the client's pipe.
const WAITING: usize = 256;

/// The maximum number of results in a row that newer edits may replace before the loop publishes one.
const SUPERSEDED: usize = 3;

/// The reason why serving ended early.
#[derive(Debug)]
pub struct ServeError(String);

impl fmt::Display for ServeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the client breaks the protocol: {}", self.0)
    }
}

impl std::error::Error for ServeError {}

/// Serves a client until it exits. Returns `true` if the client asked for a shutdown first, as the protocol requires.
///
/// `dirs` has the directories that the user names, and `today` returns the day that decides whether waivers are expired,
/// `YYYY-MM-DD`. The loop takes all waiting messages at once and never blocks on a check. A worker thread checks the newest state of
/// the files and answers the requests that need a check.
///
/// # Errors
/// [`ServeError`] if the initialization fails.
pub fn serve(
    connection: &Connection,
    dirs: &ProjectDirs,
    today: impl Fn() -> String,
) -> Result<bool, ServeError> {
    let (id, params) = connection
        .initialize_start()
        .map_err(|error| ServeError(error.to_string()))?;
    let settings = Arc::new(Settings::read(&params));
    let info = lsp::ServerInfo {
        name: "fcproto".to_owned(),
        version: Some(env!("CARGO_PKG_VERSION").to_owned()),
    };
    let result = lsp::InitializeResult {
        capabilities: capabilities(settings.encoding),
        server_info: Some(info),
    };
    connection
        .sender
        .send(Response::new_ok(id, result).into())
        .ok();

    let (sender, events) = sync_channel(WAITING);
    let mut server = Server {
        connection,
        dirs,
        today: &today,
        worker: Worker::start(sender.clone()),
        workspace: None,
        settings,
        published: BTreeMap::new(),
        touched: BTreeSet::new(),
        superseded: 0,
        lenses: lens::Checked::default(),
        refreshes: 0,
        is_dirty: false,
        is_shut_down: false,
    };
    let receiver = connection.receiver.clone();
    // This thread ends after the client's last message, or when the loop no longer receives.
    std::thread::spawn(move || {
        let messages = receiver.iter().map(Event::Message);
        messages
            .chain(std::iter::once(Event::End))
            .try_for_each(|event| sender.send(event))
    });
    let was_asked_to_end = server.run(&events);
    // The loop has ended, so the worker's remaining events are dropped.
    drop(events);
    server.worker.end();
    Ok(was_asked_to_end)
}

struct Server<'h> {
    connection: &'h Connection,
    dirs: &'h ProjectDirs,
    today: &'h dyn Fn() -> String,
    worker: Worker,
    workspace: Option<Workspace>,
    settings: Arc<Settings>,
    /// The diagnostics that were last sent, by file.
    published: BTreeMap<String, Vec<lsp::Diagnostic>>,
    /// The files that have changed since the last current publication.
    touched: BTreeSet<String>,
    /// The number of results in a row that were not published.
    superseded: usize,
    /// The lens contents that the client may have seen, and the number of refreshes requested.
    lenses: lens::Checked,
    refreshes: usize,
    /// `true` if there are changes that the worker does not have yet.
    is_dirty: bool,
    is_shut_down: bool,
}

impl Server<'_> {
    fn run(&mut self, events: &Receiver<Event>) -> bool {
        while let Ok(first) = events.recv() {
            let batch = std::iter::once(first).chain(events.try_iter());
            if self.handle(batch.take(WAITING).collect()).is_break() {
                return self.is_shut_down;
            }
            self.check();
        }
        false
    }

    /// Handles events. Breaks if the loop must end.
    fn handle(&mut self, batch: Vec<Event>) -> ControlFlow<()> {
        let cancelled: Vec<RequestId> = batch.iter().filter_map(cancelled).collect();
        for id in &cancelled {
            if self.worker.cancel(id) {
                self.cancel(id.clone());
            }
        }
        for event in batch {
            match event {
                Event::Message(Message::Request(request)) if cancelled.contains(&request.id) => {
                    self.cancel(request.id);
                }
                Event::Message(Message::Request(request)) => self.request(request),
                Event::Message(Message::Notification(notification)) => {
                    self.notification(&notification)?;
                }
                Event::Message(Message::Response(_)) => {}
                Event::Checked(snapshot) => self.checked(&snapshot),
                Event::Compared(snapshot) => self.compared(&snapshot),
                Event::Answered(response) => self.send(response),
                Event::End => return ControlFlow::Break(()),
            }
        }
        ControlFlow::Continue(())
    }

    /// Sends changes to the worker.
    fn check(&mut self) {
        if let Some(workspace) = self.workspace.as_mut().filter(|_| self.is_dirty) {
            self.worker.check(workspace.snapshot());
            self.is_dirty = false;
        }
    }

    fn cancel(&self, id: RequestId) {
        let code = ErrorCode::RequestCanceled;
        self.send(refusal(id, code, "the client no longer wants to know"));
    }

    fn request(&mut self, request: Request) {
        if self.is_shut_down {
            let code = ErrorCode::InvalidRequest;
            self.send(refusal(request.id, code, "the server is shut down"));
        } else if request.method == lsp::LspRequestMethod::Shutdown.as_str() {
            self.is_shut_down = true;
            for id in self.worker.clear() {
                self.cancel(id);
            }
            self.send(Response::new_ok(request.id, ()));
        } else {
            let snapshot = self.workspace.as_mut().map(Workspace::snapshot);
            match snapshot {
                Some(snapshot) if waits(&request.method, &snapshot) => {
                    self.later(request, snapshot);
                }
                snapshot => self.send(answer(request, snapshot.as_deref())),
            }
        }
    }

    /// Queues a request for the worker, behind the check of its snapshot.
    fn later(&mut self, request: Request, snapshot: Arc<Snapshot>) {
        self.check();
        if let Err(id) = self.worker.ask(request, snapshot) {
            let code = ErrorCode::ServerCancelled;
            self.send(refusal(id, code, "too many requests wait"));
        }
    }

    /// Handles a notification. Ignores one with an unknown method.
    fn notification(&mut self, notification: &Notification) -> ControlFlow<()> {
        if let Some(params) = read::<lsp::DidOpenTextDocumentNotification>(notification) {
            self.open(params.text_document);
        } else if let Some(params) = read::<lsp::DidChangeTextDocumentNotification>(notification) {
            let document = params.text_document;
            let uri = document.text_document_identifier.uri;
            let changes = params.content_changes;
            self.with(uri, |workspace, uri| {
                workspace.change(uri, document.version, changes)
            });
        } else if let Some(params) = read::<lsp::DidCloseTextDocumentNotification>(notification) {
            self.with(params.text_document.uri, Workspace::close);
        } else if let Some(params) = read::<lsp::DidChangeWatchedFilesNotification>(notification) {
            self.files_changed(&params.changes);
        } else if notification.method == lsp::InitializedNotification::METHOD.as_str() {
            self.begin();
        } else if notification.method == lsp::ExitNotification::METHOD.as_str() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Looks for the project in the client's directories. Logs the reason if there is none.
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
            // The first opened file may still belong to a project.
            self.notify::<lsp::LogMessageNotification>(&lsp::LogMessageParams {
                kind: lsp::MessageType::Info,
                message: self.settings.lang.text(&why).to_owned(),
            });
        }
    }

    fn find(&mut self, directory: &Path) -> Result<(), Text> {
        let project = Project::find(self.dirs, directory)?;
        let settings = Arc::clone(&self.settings);
        self.workspace = Some(Workspace::new(project, settings, (self.today)()));
        self.is_dirty = true;
        Ok(())
    }

    fn open(&mut self, document: lsp::TextDocumentItem) {
        if self.workspace.is_none()
            && let Some(file) = uri::to_path(document.uri.as_ref())
            && let Some(directory) = file.parent()
        {
            // A file outside any project gets no diagnostics.
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
            // The project stays unchanged while `fc.yaml` cannot be read.
            if let Ok(project) = Project::find(self.dirs, &workspace.project().root) {
                workspace.set_project(project);
            }
        } else {
            workspace.read();
        }
        self.is_dirty = true;
    }

    /// Publishes the diagnostics of a snapshot if it is the newest. An outdated snapshot is published only after
    /// [`SUPERSEDED`] others in a row were skipped.
    fn checked(&mut self, snapshot: &Arc<Snapshot>) {
        let Some(workspace) = &mut self.workspace else {
            return;
        };
        let is_newest = !self.is_dirty && Arc::ptr_eq(snapshot, &workspace.snapshot());
        if !is_newest {
            workspace.learn(snapshot);
            self.superseded += 1;
            if self.superseded <= SUPERSEDED {
                return;
            }
        }
        self.superseded = 0;
        self.publish(snapshot, is_newest);
    }

    /// Asks the client to request lenses again if their contents have changed.
    fn compared(&mut self, snapshot: &Snapshot) {
        if !self.settings.refreshes_lenses {
            return;
        }
        let lenses = lens::checked(snapshot);
        if lenses != self.lenses {
            self.lenses = lenses;
            self.refreshes += 1;
            let id = RequestId::from(format!("lenses {}", self.refreshes));
            let method = lsp::LspRequestMethod::WorkspaceCodeLensRefresh.as_str();
            self.send(Request::new(id, method.to_owned(), ()));
        }
    }

    /// Publishes the diagnostics of each file that changed, including files that have none any more.
    fn publish(&mut self, snapshot: &Snapshot, is_newest: bool) {
        let found = diagnostics(snapshot);
        // Changed files are published again even if their diagnostics are the same.
        let touched = if is_newest {
            std::mem::take(&mut self.touched)
        } else {
            self.touched.clone()
        };
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

    /// Asks the client to report changes of files on the disk.
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

    /// Sends a message. Ignores that the client is gone, because the loop notices it on its next receive.
    fn send(&self, message: impl Into<Message>) {
        let _ = self.connection.sender.send(message.into());
    }
}

/// Returns the parameters of a notification `N`. Returns `None` for another one, or if the parameters are invalid: a
/// notification has no error response.
fn read<N: lsp::Notification>(notification: &Notification) -> Option<N::Params> {
    let is_one = notification.method == N::METHOD.as_str();
    is_one.then(|| N::Params::deserialize(&notification.params).ok())?
}

/// Returns the request that a message cancels.
fn cancelled(event: &Event) -> Option<RequestId> {
    let Event::Message(Message::Notification(notification)) = event else {
        return None;
    };
    if notification.method != lsp::LspNotificationMethod::CancelRequest.as_str() {
        return None;
    }
    serde_json::from_value(notification.params.get("id")?.clone()).ok()
}
