//! One state of a project's files, and the results computed for it.

use crate::project::Project;
use crate::settings::Settings;
use fc_codegen::check::check_trees;
use fc_diff::{Against, Finding, diff_since, waive};
use fc_spec::diagnostic::Faults;
use fc_spec::index::{
    DefId, DefSite, Definitions, Index, Occurrence, References, described, occurrence_at,
};
use fc_spec::load::{Partial, Trees};
use fc_spec::model::{Group, Model, Operation, RangeUse, Text, Types};
use fc_spec::source::{FileId, SourceFile, Sources, Span};
use gen_lsp_types::{
    Location, OptionalVersionedTextDocumentIdentifier, Position, Range, TextDocumentEdit,
    TextDocumentIdentifier, TextDocumentPositionParams, TextEdit, Uri, WorkspaceEdit,
};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// One state of a project's files. Each result is computed on first use.
#[derive(Debug)]
pub struct Snapshot {
    /// The project.
    pub project: Arc<Project>,
    /// The settings of the client.
    pub settings: Arc<Settings>,
    /// The URI of each file, and its version if the client has the file open.
    documents: Vec<(Uri, Option<i32>)>,
    state: Arc<State>,
    /// The last earlier state whose files could all be parsed.
    before: Option<Arc<State>>,
}

/// The results for one state of the files.
#[derive(Debug)]
pub struct State {
    project: Arc<Project>,
    index: Index,
    /// The errors from reading files on the disk.
    unread: Faults,
    today: String,
    analysis: OnceLock<Analysis>,
    places: OnceLock<Definitions>,
    uses: OnceLock<References>,
    findings: OnceLock<Vec<Finding>>,
}

/// The result of a check.
#[derive(Debug)]
pub struct Analysis {
    /// The diagnostics in file order. They include the lint findings if the spec has no errors.
    pub faults: Faults,
    /// The model, or the readable parts of a spec with errors.
    pub read: Result<Model, Box<Partial>>,
    /// `true` if all files could be parsed.
    is_whole: bool,
}

impl State {
    /// Checks the files.
    pub fn analysis(&self) -> &Analysis {
        self.analysis.get_or_init(|| {
            let mut faults = self.unread.clone();
            let requirements = self.project.targets.requirements();
            let checked = check_trees(self.index.trees(), &requirements, &mut faults);
            if let Ok(model) = &checked.read
                && !faults.has_errors()
            {
                let places = || self.definitions();
                let linted = self.project.linted(model, &self.today, places);
                faults.extend(linted.iter().cloned());
                faults.sort();
            }
            Analysis {
                faults,
                read: checked.read,
                is_whole: checked.is_whole,
            }
        })
    }

    /// Returns the place of each definition.
    pub fn definitions(&self) -> &Definitions {
        self.places.get_or_init(|| self.index.definitions())
    }

    /// Returns the title of a definition. Operations and types take it from the model, other kinds from the file.
    pub fn title(&self, item: &DefId, place: &DefSite) -> Option<Text> {
        if item.is_operation() {
            let mut operations = self.analysis().operations().iter();
            let operation = operations.find(|it| it.name == item.name)?;
            return Some(operation.title.clone());
        }
        if item.is_type() {
            return Some(self.analysis().types().named(&item.name)?.title.clone());
        }
        described(self.index.trees(), place).map(|(title, _)| title)
    }

    /// Returns the differences from the last release. Returns none without a release, or while the spec has errors.
    pub fn findings(&self) -> &[Finding] {
        self.findings.get_or_init(|| {
            let (Some(model), [release, earlier @ ..]) =
                (self.analysis().model(), self.project.releases())
            else {
                return Vec::new();
            };
            let earlier = earlier.iter().map(|it| (it.name.as_str(), &it.model));
            let packages = self.project.packages();
            let mut findings = diff_since(earlier, &release.model, model, packages);
            waive(&mut findings, &model.waivers, &self.today, Against::Release);
            findings
        })
    }

    /// Returns whether all files could be parsed, or `None` before the check.
    fn is_whole(&self) -> Option<bool> {
        Some(self.analysis.get()?.is_whole)
    }
}

impl Snapshot {
    pub(crate) fn new(
        project: Arc<Project>,
        settings: Arc<Settings>,
        (index, unread): (Index, Faults),
        documents: Vec<(Uri, Option<i32>)>,
        today: String,
        before: Option<Arc<State>>,
    ) -> Self {
        let state = State {
            project: Arc::clone(&project),
            index,
            unread,
            today,
            analysis: OnceLock::new(),
            places: OnceLock::new(),
            uses: OnceLock::new(),
            findings: OnceLock::new(),
        };
        Self {
            project,
            settings,
            documents,
            state: Arc::new(state),
            before,
        }
    }

    /// Returns the files.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        self.trees().sources()
    }

    /// Returns the parsed files.
    #[must_use]
    pub fn trees(&self) -> &Trees {
        self.state.index.trees()
    }

    /// Returns the index of the files.
    #[must_use]
    pub fn index(&self) -> &Index {
        &self.state.index
    }

    /// Checks the files and returns the result.
    #[must_use]
    pub fn analysis(&self) -> &Analysis {
        self.state.analysis()
    }

    /// Returns `true` if the files have been checked.
    #[must_use]
    pub fn is_checked(&self) -> bool {
        self.state.is_whole().is_some()
    }

    /// Returns the place of each definition.
    #[must_use]
    pub fn definitions(&self) -> &Definitions {
        self.state.definitions()
    }

    /// Returns the places that name each definition.
    #[must_use]
    pub fn references(&self) -> &References {
        let uses = &self.state.uses;
        uses.get_or_init(|| self.state.index.references())
    }

    /// Returns this state if it is checked and all its files could be parsed, otherwise the last earlier state of that
    /// kind. Without an earlier state, returns this state. Completion and hover use it: they need not wait for a check,
    /// and names stay available while a file is half typed.
    #[must_use]
    pub fn known(&self) -> &State {
        match &self.before {
            Some(before) if self.state.is_whole() != Some(true) => before,
            _ => &self.state,
        }
    }

    /// Returns `true` if [`Self::known`] is checked and needs no wait.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.known().is_whole().is_some()
    }

    /// Returns `true` if lenses can be shown without a check. The known state must be checked, and compared if there is
    /// a release. If this snapshot is not checked, either the client supports refreshes or there is no release.
    #[must_use]
    pub fn has_lenses(&self) -> bool {
        let may_be_old = self.settings.refreshes_lenses || self.project.is_unreleased();
        let is_compared = self.project.is_unreleased() || self.known().findings.get().is_some();
        self.is_known() && is_compared && (may_be_old || self.is_checked())
    }

    /// Returns the state for later snapshots. Returns `None` before the check, or if a file could not be parsed.
    pub(crate) fn whole(&self) -> Option<Arc<State>> {
        let is_whole = self.state.is_whole() == Some(true);
        is_whole.then(|| Arc::clone(&self.state))
    }

    /// Returns the file with a URI.
    #[must_use]
    pub fn file(&self, uri: &Uri) -> Option<FileId> {
        let at = self.documents.iter().position(|(known, _)| known == uri)?;
        Some(FileId(u32::try_from(at).ok()?))
    }

    /// Returns the source of a file.
    #[must_use]
    pub fn source(&self, file: FileId) -> Option<&SourceFile> {
        self.sources().get(file)
    }

    /// Returns the URI of a file.
    #[must_use]
    pub fn uri(&self, file: FileId) -> Option<&Uri> {
        self.document(file).map(|(uri, _)| uri)
    }

    /// Returns the version of a file, if the client has it open.
    #[must_use]
    pub fn version(&self, file: FileId) -> Option<i32> {
        self.document(file)?.1
    }

    fn document(&self, file: FileId) -> Option<&(Uri, Option<i32>)> {
        self.documents.get(usize::try_from(file.0).ok()?)
    }

    /// Returns the range of a span.
    #[must_use]
    pub fn range(&self, span: Span) -> Range {
        match self.source(span.file) {
            Some(file) => self.settings.encoding.range(file, span),
            None => Range::default(),
        }
    }

    /// Returns the location of a span.
    #[must_use]
    pub fn location(&self, span: Span) -> Option<Location> {
        Some(Location {
            uri: self.uri(span.file)?.clone(),
            range: self.range(span),
        })
    }

    /// Returns the file and byte offset of the position that a request names.
    #[must_use]
    pub fn position(&self, at: &TextDocumentPositionParams) -> Option<(FileId, usize)> {
        self.offset(&at.text_document.uri, at.position)
    }

    /// Returns the file with a URI and the byte offset of a position in it.
    #[must_use]
    pub fn offset(&self, uri: &Uri, position: Position) -> Option<(FileId, usize)> {
        let file = self.file(uri)?;
        let source = self.source(file)?;
        Some((file, self.settings.encoding.offset(source, position)))
    }

    /// Passes the key or scalar at an offset to `then`. Returns `None` if there is neither, or if the file is invalid
    /// YAML.
    pub fn at<T>(
        &self,
        (file, offset): (FileId, usize),
        then: impl FnOnce(&Occurrence<'_>) -> Option<T>,
    ) -> Option<T> {
        let tree = self.trees().tree(file)?;
        then(&occurrence_at(tree.root(), offset)?)
    }

    /// Returns replacements as a workspace edit. The edit names the version of each open file, so that the client
    /// rejects it if the text has changed.
    pub fn edit(&self, changes: impl IntoIterator<Item = (Span, String)>) -> WorkspaceEdit {
        let mut files: BTreeMap<FileId, Vec<TextEdit>> = BTreeMap::new();
        for (span, new_text) in changes {
            let range = self.range(span);
            let edit = TextEdit { range, new_text };
            files.entry(span.file).or_default().push(edit);
        }
        let files = files.into_iter().filter_map(|(file, edits)| {
            let text_document = OptionalVersionedTextDocumentIdentifier {
                version: self.version(file),
                text_document_identifier: TextDocumentIdentifier {
                    uri: self.uri(file)?.clone(),
                },
            };
            let edits = edits.into_iter().map(Into::into).collect();
            Some(
                TextDocumentEdit {
                    text_document,
                    edits,
                }
                .into(),
            )
        });
        WorkspaceEdit {
            document_changes: Some(files.collect()),
            ..WorkspaceEdit::default()
        }
    }
}

impl Analysis {
    /// Returns the model, or `None` if the spec has errors.
    pub fn model(&self) -> Option<&Model> {
        self.read.as_ref().ok()
    }

    /// Returns the operations, including those of a spec with errors.
    pub fn operations(&self) -> &[Operation] {
        match &self.read {
            Ok(model) => &model.operations,
            Err(partial) => &partial.operations,
        }
    }

    /// Returns the types.
    pub fn types(&self) -> &Types {
        match &self.read {
            Ok(model) => &model.types,
            Err(partial) => &partial.types,
        }
    }

    /// Returns the groups.
    pub fn groups(&self) -> &[Group] {
        match &self.read {
            Ok(model) => &model.groups,
            Err(partial) => &partial.groups,
        }
    }

    /// Returns the code that the next operation in a file gets from the ranges of this use.
    pub fn next_code(&self, usage: RangeUse, path: &str) -> Option<u16> {
        let mut groups = self.groups().iter();
        let group = groups.find(|group| group.location.file == path);
        let group = group.map(|group| group.id.as_str());
        match &self.read {
            Ok(model) => model.next_code(usage, group),
            Err(partial) => partial.next_code(usage, group),
        }
    }
}
