//! One state of a project's files, and what has been found out about it.

use crate::project::Project;
use crate::settings::Settings;
use fc_codegen::check::check_trees;
use fc_diff::{Against, Finding, diff_since, waive};
use fc_spec::diagnostic::Faults;
use fc_spec::index::{Index, Item, Place, Places, Site, Uses, described, site_at};
use fc_spec::load::{Partial, Trees};
use fc_spec::model::{Group, Model, Operation, RangeUse, Text, Types};
use fc_spec::source::{FileId, SourceFile, Sources, Span};
use gen_lsp_types::{
    Location, OptionalVersionedTextDocumentIdentifier, Position, Range, TextDocumentEdit,
    TextDocumentIdentifier, TextEdit, Uri, WorkspaceEdit,
};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// One state of a project's files. What is asked of it is found out once, when it is asked first.
#[derive(Debug)]
pub struct Snapshot {
    /// The project.
    pub project: Arc<Project>,
    /// How the client wants its answers.
    pub settings: Arc<Settings>,
    /// What the client calls each file, and the version of its text if the client has it open.
    documents: Vec<(Uri, Option<i32>)>,
    state: Arc<State>,
    /// The last state before in which all files could be read.
    before: Option<Arc<State>>,
}

/// What can be found out about some files.
#[derive(Debug)]
pub struct State {
    project: Arc<Project>,
    index: Index,
    /// What was wrong with files on the disk.
    unread: Faults,
    today: String,
    analysis: OnceLock<Analysis>,
    places: OnceLock<Places>,
    uses: OnceLock<Uses>,
    findings: OnceLock<Vec<Finding>>,
}

/// What checking a spec comes to.
#[derive(Debug)]
pub struct Analysis {
    /// Its faults in the order of their places, and, where it has no errors, what the lint finds.
    pub faults: Faults,
    /// What it means, or what could be read of it.
    pub read: Result<Model, Box<Partial>>,
    /// Whether all files could be read.
    is_whole: bool,
}

impl State {
    /// What checking the files comes to.
    pub fn analysis(&self) -> &Analysis {
        self.analysis.get_or_init(|| {
            let mut faults = self.unread.clone();
            let requirements = self.project.targets.requirements();
            let checked = check_trees(self.index.trees(), &requirements, &mut faults);
            if let Ok(model) = &checked.read
                && !faults.has_errors()
            {
                let places = || self.places();
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

    /// Where each thing is written.
    pub fn places(&self) -> &Places {
        self.places.get_or_init(|| self.index.places())
    }

    /// The title of an operation or type; of what else the spec declares, what its file says.
    pub fn title(&self, item: &Item, place: &Place) -> Option<Text> {
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

    /// What differs from the last release; nothing where there is none, or while the spec has errors.
    pub fn findings(&self) -> &[Finding] {
        self.findings.get_or_init(|| {
            let (Some(model), [release, earlier @ ..]) =
                (self.analysis().model(), self.project.releases())
            else {
                return Vec::new();
            };
            let earlier = earlier.iter().map(|it| (it.number.as_str(), &it.model));
            let packages = self.project.packages();
            let mut findings = diff_since(earlier, &release.model, model, packages);
            waive(&mut findings, &model.waivers, &self.today, Against::Release);
            findings
        })
    }

    /// Whether all files could be read; `None` while it has not been checked.
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

    /// The files.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        self.trees().sources()
    }

    /// The files as trees.
    #[must_use]
    pub fn trees(&self) -> &Trees {
        self.state.index.trees()
    }

    /// The index of the files.
    #[must_use]
    pub fn index(&self) -> &Index {
        &self.state.index
    }

    /// What checking it comes to.
    #[must_use]
    pub fn analysis(&self) -> &Analysis {
        self.state.analysis()
    }

    /// Whether that has been found out.
    #[must_use]
    pub fn is_checked(&self) -> bool {
        self.state.is_whole().is_some()
    }

    /// Where each thing is written.
    #[must_use]
    pub fn places(&self) -> &Places {
        self.state.places()
    }

    /// Where each thing is named.
    #[must_use]
    pub fn uses(&self) -> &Uses {
        let uses = &self.state.uses;
        uses.get_or_init(|| self.state.index.uses())
    }

    /// This state or the last one before in which all files could be read: for names and texts to offer and to show, for
    /// which nobody waits until all is checked, and which do not go while a file is half written.
    #[must_use]
    pub fn known(&self) -> &State {
        match &self.before {
            Some(before) if self.state.is_whole() != Some(true) => before,
            _ => &self.state,
        }
    }

    /// Whether that has been checked, so that nobody waits who asks for it.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.known().is_whole().is_some()
    }

    /// Whether lenses can be shown without a check: with what is known, where there is nothing to compare with, or the
    /// client will ask again.
    #[must_use]
    pub fn has_lenses(&self) -> bool {
        let may_be_old = self.settings.refreshes_lenses || self.project.is_unreleased();
        let is_compared = self.project.is_unreleased() || self.known().findings.get().is_some();
        self.is_known() && is_compared && (may_be_old || self.is_checked())
    }

    /// What later snapshots may know of it: nothing while it has not been checked, or where a file could not be read.
    pub(crate) fn whole(&self) -> Option<Arc<State>> {
        let is_whole = self.state.is_whole() == Some(true);
        is_whole.then(|| Arc::clone(&self.state))
    }

    /// The file that the client calls so.
    #[must_use]
    pub fn file(&self, uri: &Uri) -> Option<FileId> {
        let at = self.documents.iter().position(|(known, _)| known == uri)?;
        Some(FileId(u32::try_from(at).ok()?))
    }

    /// The text of a file.
    #[must_use]
    pub fn source(&self, file: FileId) -> Option<&SourceFile> {
        self.sources().get(file)
    }

    /// What the client calls a file.
    #[must_use]
    pub fn uri(&self, file: FileId) -> Option<&Uri> {
        self.document(file).map(|(uri, _)| uri)
    }

    /// The version of the text of a file that the client has open.
    #[must_use]
    pub fn version(&self, file: FileId) -> Option<i32> {
        self.document(file)?.1
    }

    fn document(&self, file: FileId) -> Option<&(Uri, Option<i32>)> {
        self.documents.get(usize::try_from(file.0).ok()?)
    }

    /// A span as the client counts it.
    #[must_use]
    pub fn range(&self, span: Span) -> Range {
        match self.source(span.file) {
            Some(file) => self.settings.encoding.range(file, span),
            None => Range::default(),
        }
    }

    /// A span in its file.
    #[must_use]
    pub fn location(&self, span: Span) -> Option<Location> {
        Some(Location {
            uri: self.uri(span.file)?.clone(),
            range: self.range(span),
        })
    }

    /// The file and byte offset of a position.
    #[must_use]
    pub fn offset(&self, uri: &Uri, position: Position) -> Option<(FileId, usize)> {
        let file = self.file(uri)?;
        let source = self.source(file)?;
        Some((file, self.settings.encoding.offset(source, position)))
    }

    /// Hands the key or scalar at an offset to `then`; `None` where there is none, or where the file is no YAML.
    pub fn at<T>(
        &self,
        (file, offset): (FileId, usize),
        then: impl FnOnce(&Site<'_>) -> Option<T>,
    ) -> Option<T> {
        let tree = self.trees().tree(file)?;
        then(&site_at(tree.root(), offset)?)
    }

    /// Replacements as a client makes them. Of files that it has open the version is named, so that nothing is
    /// replaced in a text that has changed since.
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
    /// The model; `None` if there is an error in the spec.
    pub fn model(&self) -> Option<&Model> {
        self.read.as_ref().ok()
    }

    /// Operations, those of a spec with errors too.
    pub fn operations(&self) -> &[Operation] {
        match &self.read {
            Ok(model) => &model.operations,
            Err(partial) => &partial.operations,
        }
    }

    /// Types.
    pub fn types(&self) -> &Types {
        match &self.read {
            Ok(model) => &model.types,
            Err(partial) => &partial.types,
        }
    }

    /// Groups.
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
