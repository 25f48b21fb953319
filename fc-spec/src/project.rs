//! Reads `fc.yaml`, the settings of a project, except the key `lint`, which [`lint`](crate::lint::settings) reads.

use crate::diagnostic::Faults;
use crate::language::Cursor;
use crate::language::grammar::{CRATE, Key, Kind, PROJECT, Project, TARGET, Target};
use crate::load::{check_keys, check_kind};
use crate::model::{Lang, Languages, Value};
use crate::source::{FileId, Span};
use crate::syntax::{Entry, Node, parse};

/// The settings of a project.
#[derive(Clone, Debug, Default)]
pub struct ProjectSettings {
    /// The directory of the spec, relative to the project.
    pub spec: Option<String>,
    /// The languages that each text of the spec must have.
    pub languages: Option<Languages>,
    /// The targets. `None` without the key.
    pub targets: Option<Vec<TargetSettings>>,
}

/// The settings of a target.
#[derive(Clone, Debug)]
pub struct TargetSettings {
    /// The name.
    pub name: String,
    /// The place of the name.
    pub span: Span,
    /// The directory of the files, relative to the project.
    pub out: Option<String>,
    /// The languages of the pages or of the comments.
    pub languages: Option<Languages>,
    /// The name of the Rust package.
    pub krate: Option<String>,
    /// `true` if each entity has an id type.
    pub newtypes: Option<bool>,
    /// The program that generates the files.
    pub plugin: Option<String>,
    /// The programming language that must be able to use the names of the spec.
    pub names: Option<String>,
    /// The audience whose part of the protocol the target contains.
    pub audience: Option<String>,
    /// The maximum run time of the plugin, in milliseconds.
    pub timeout_ms: Option<u64>,
    /// The maximum output of the plugin, in bytes.
    pub output_bytes: Option<u64>,
    /// The options that are passed to the plugin.
    pub options: Option<Value>,
    /// The keys of the target, and the places of the key and of its value.
    keys: Vec<(String, Span, Span)>,
}

impl TargetSettings {
    /// Returns the place of a key that the target has.
    #[must_use]
    pub fn key(&self, name: &str) -> Option<Span> {
        let mut keys = self.keys.iter();
        keys.find(|(key, ..)| key == name).map(|(_, key, _)| *key)
    }

    /// Returns the place of the value of a key that the target has.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<Span> {
        let mut keys = self.keys.iter();
        keys.find(|(key, ..)| key == name)
            .map(|(_, _, value)| *value)
    }
}

/// Reads the text of `fc.yaml`. Returns `None` if it has errors, which are added to `faults`.
pub fn read(file: FileId, text: &str, faults: &mut Faults) -> Option<ProjectSettings> {
    let before = faults.errors();
    let tree = parse(file, text, faults)?;
    let root = tree.root();
    if root.is_null() {
        return Some(ProjectSettings::default());
    }
    check(root, faults);
    if faults.errors() > before {
        return None;
    }
    let targets = PROJECT.targets.of(root).filter(|it| !it.is_null());
    Some(ProjectSettings {
        spec: PROJECT.spec.read(root),
        languages: languages(PROJECT.languages, root),
        targets: targets.map(|it| it.entries().map(target).collect()),
    })
}

fn check(root: Node<'_>, faults: &mut Faults) {
    if root.as_mapping().is_none() {
        check_table(&Kind::Map(Project::TABLE), root, root.span(), faults);
        return;
    }
    check_keys(Cursor::Declared(Project::TABLE), root, faults);
    for entry in root.entries() {
        let Some(key) = Project::TABLE.key(entry.name()) else {
            continue;
        };
        if key.name == PROJECT.targets.name {
            check_targets(entry, &key.kind, faults);
        } else if key.name != PROJECT.lint.name {
            check_table(&key.kind, entry.value, entry.key.span(), faults);
        }
    }
}

/// Checks the targets. An empty one has the defaults of its product.
fn check_targets(targets: Entry<'_>, kind: &Kind, faults: &mut Faults) {
    if targets.value.is_null() {
        return;
    }
    if targets.value.as_mapping().is_none() {
        check_table(kind, targets.value, targets.key.span(), faults);
        return;
    }
    for target in targets.value.entries() {
        if !target.value.is_null() {
            let kind = Kind::Map(Target::TABLE);
            check_table(&kind, target.value, target.key.span(), faults);
        }
    }
}

fn check_table(kind: &Kind, node: Node<'_>, at: Span, faults: &mut Faults) {
    check_kind(kind, node, at, Languages::Any, faults);
}

fn target(entry: Entry<'_>) -> TargetSettings {
    let node = entry.value;
    let keys = node.entries().map(|it| {
        let (key, value) = (it.key.span(), it.value.span());
        (it.name().to_owned(), key, value)
    });
    TargetSettings {
        name: entry.name().to_owned(),
        span: entry.key.span(),
        out: TARGET.out.read(node),
        languages: languages(TARGET.languages, node),
        krate: CRATE.read(node),
        newtypes: TARGET.newtypes.read(node),
        plugin: TARGET.plugin.read(node),
        names: TARGET.names.read(node),
        audience: TARGET.audience.read(node),
        timeout_ms: TARGET.timeout_ms.read(node),
        output_bytes: TARGET.output_bytes.read(node),
        options: TARGET.options.read(node),
        keys: keys.collect(),
    }
}

/// Returns a list of languages as a set.
pub(crate) fn languages<F>(key: Key<F>, node: Node<'_>) -> Option<Languages>
where
    F: for<'a> crate::language::grammar::Form<Value<'a> = Vec<Lang>>,
{
    let listed = key.read(node)?;
    let (first, others) = listed.split_first()?;
    Some(if others.iter().all(|it| it == first) {
        Languages::Only(*first)
    } else {
        Languages::All
    })
}
