//! The files of a project. Open files come from the client, the others from the disk.

use crate::project::Project;
use crate::settings::Settings;
use crate::snapshot::{Snapshot, State};
use crate::uri;
use fc_spec::diagnostic::Faults;
use fc_spec::index::Index;
use fc_spec::source::{SourceFile, Sources};
use fc_spec::syntax::{is_spec_file, read_dir};
use gen_lsp_types::{TextDocumentContentChangeEvent, Uri};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files of a project.
#[derive(Debug)]
pub struct Workspace {
    project: Arc<Project>,
    settings: Arc<Settings>,
    today: String,
    /// The files on the disk, and the errors from reading them.
    disk: (Sources, Faults),
    /// The open files, by path in the project.
    open: BTreeMap<String, Document>,
    /// The index of the last snapshot. The next snapshot parses only changed files.
    index: Index,
    snapshot: Option<Arc<Snapshot>>,
    before: Option<Arc<State>>,
}

/// A file that is open in the client.
#[derive(Debug)]
struct Document {
    uri: Uri,
    version: i32,
    file: Arc<SourceFile>,
}

impl Workspace {
    /// Reads the files of a project. `today` is the day that decides whether waivers are expired.
    #[must_use]
    pub fn new(project: Project, settings: Arc<Settings>, today: String) -> Self {
        let mut workspace = Self {
            project: Arc::new(project),
            settings,
            today,
            disk: (Sources::new(), Faults::new()),
            open: BTreeMap::new(),
            index: Index::default(),
            snapshot: None,
            before: None,
        };
        workspace.read();
        workspace
    }

    /// Returns the project.
    #[must_use]
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Replaces the project after a change of its configuration.
    pub fn set_project(&mut self, project: Project) {
        self.project = Arc::new(project);
        self.read();
    }

    /// Reads the files on the disk again.
    pub fn read(&mut self) {
        let mut faults = Faults::new();
        let sources = read_dir(&self.project.root, &self.project.spec, &mut faults);
        self.disk = (sources, faults);
        self.forget();
    }

    /// Takes the text of a file from the client. Returns `true` if the file belongs to the spec.
    pub fn open(&mut self, uri: Uri, version: i32, text: String) -> bool {
        let Some(path) = self.path(&uri) else {
            return false;
        };
        let file = Arc::new(SourceFile::new(path.as_str(), text));
        let document = Document { uri, version, file };
        self.open.insert(path, document);
        self.forget();
        true
    }

    /// Changes the text of an open file. Returns `true` if the file is open.
    pub fn change(
        &mut self,
        uri: &Uri,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
    ) -> bool {
        let Some(document) = self.open.values_mut().find(|it| it.uri == *uri) else {
            return false;
        };
        for change in changes {
            document.file = Arc::new(self.settings.encoding.changed(&document.file, change));
        }
        document.version = version;
        self.forget();
        true
    }

    /// Takes the text of a file from the disk again. Returns `true` if the file was open.
    pub fn close(&mut self, uri: &Uri) -> bool {
        let before = self.open.len();
        self.open.retain(|_, document| document.uri != *uri);
        if self.open.len() == before {
            return false;
        }
        self.read();
        true
    }

    /// Returns a snapshot of the current files.
    pub fn snapshot(&mut self) -> Arc<Snapshot> {
        if let Some(snapshot) = &self.snapshot {
            return Arc::clone(snapshot);
        }
        let (sources, faults) = &self.disk;
        let mut sources = sources.clone();
        for (path, document) in &self.open {
            if sources.iter().any(|(_, file)| file.path == *path) {
                sources.replace(Arc::clone(&document.file));
            } else {
                sources.push(Arc::clone(&document.file));
            }
        }
        // Errors from reading a file on the disk are dropped if the client has the file open.
        let is_open = |fault: &&_| {
            let fault: &fc_spec::diagnostic::Diagnostic = fault;
            self.open.contains_key(sources.path(fault.primary.span))
        };
        let mut unread = Faults::new();
        unread.extend(faults.iter().filter(|fault| !is_open(fault)).cloned());
        let documents = sources.iter().map(|(_, file)| self.document(&file.path));
        let documents = documents.collect();
        self.index = self.index.with(self.index.trees().with(&sources));
        let snapshot = Arc::new(Snapshot::new(
            Arc::clone(&self.project),
            Arc::clone(&self.settings),
            (self.index.clone(), unread),
            documents,
            self.today.clone(),
            self.before.clone(),
        ));
        self.snapshot = Some(Arc::clone(&snapshot));
        snapshot
    }

    /// Returns the URI of a file, and its version if the client has it open.
    fn document(&self, path: &str) -> (Uri, Option<i32>) {
        match self.open.get(path) {
            Some(document) => (document.uri.clone(), Some(document.version)),
            None => (uri::of_path(&self.project.root.join(path)).into(), None),
        }
    }

    /// Returns the path in the project of a file that can belong to the spec: directly in its directory, or in
    /// `commands`.
    fn path(&self, uri: &Uri) -> Option<String> {
        let file = uri::to_path(uri.as_ref())?;
        let root = &self.project.root;
        let below = below(&file, root).or_else(|| {
            // The client may see the project through a symbolic link.
            let directory = file.parent()?.canonicalize().ok()?;
            below(
                &directory.join(file.file_name()?),
                &root.canonicalize().ok()?,
            )
        })?;
        let inside = below.strip_prefix(&self.project.spec).ok()?;
        if !is_spec_file(inside) {
            return None;
        }
        let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
        Some(parts.join("/"))
    }

    /// Keeps the results of a checked snapshot for later ones, even if the files have changed since.
    pub(crate) fn learn(&mut self, checked: &Snapshot) {
        if let Some(whole) = checked.whole() {
            self.before = Some(whole);
        }
    }

    fn forget(&mut self) {
        if let Some(snapshot) = self.snapshot.take() {
            self.learn(&snapshot);
        }
    }
}

fn below(file: &Path, root: &Path) -> Option<PathBuf> {
    file.strip_prefix(root).ok().map(Path::to_owned)
}
