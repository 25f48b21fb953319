//! Collects the top keys of all files and checks their place and number.

use super::draft::Origin;
use super::shape;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{self, FILE, File, GROUP};
use crate::language::{Cursor, Occurrence, references};
use crate::model::{Languages, Text};
use crate::source::Span;
use crate::syntax::{self, Entry, Node};
use crate::text;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::collections::HashMap;

/// A parsed file.
pub(super) struct Parsed<'s> {
    /// Path from the project's root.
    pub path: &'s str,
    /// The syntax tree of the file.
    pub tree: syntax::Tree<'s>,
    /// The parts of the text that are not in the tree.
    pub gaps: &'s [Span],
    /// `true` if the tree covers all of the text.
    pub is_whole: bool,
}

impl Parsed<'_> {
    /// Returns the top mapping.
    fn root(&self) -> Node<'_> {
        self.tree.root()
    }
}

/// A top key of a file and its content.
pub(super) struct Section<'a> {
    /// The key.
    pub name: &'static str,
    /// The place of the key.
    pub origin: Origin<'a>,
    /// Group of the file.
    pub group: Option<&'a str>,
    /// Values and keys in the section that name a thing.
    pub references: Vec<Occurrence<'a>>,
    /// `true` if the shape of the section is valid.
    pub clean: bool,
}

/// Returns the sections of all files, in order, and reports errors in their shape.
///
/// `whole`: `true` if every file was parsed, so that a missing thing is really missing. Becomes `false` if a required
/// file is absent, because that explains all other missing things.
pub(super) fn collect<'a>(
    trees: &'a [Parsed<'_>],
    texts: Languages,
    whole: &mut bool,
    faults: &mut Faults,
) -> Vec<Section<'a>> {
    let mut sections = Vec::new();
    let shaped: Vec<_> = trees.par_iter().map(|tree| shaped(tree, texts)).collect();
    for (found, own) in shaped {
        sections.extend(found);
        faults.append(own);
    }
    drop_repeated(&mut sections, faults);
    let is_complete = trees.iter().all(|tree| tree.is_whole);
    if *whole && is_complete {
        *whole = check_files(trees, &sections, faults);
    }
    if *whole && is_complete && !faults.has_lost() {
        check_present(trees, &sections, faults);
    }
    sections
}

/// Returns the sections of one file.
pub(super) fn of_file<'a>(tree: &'a Parsed<'_>) -> Vec<Section<'a>> {
    let (mut sections, mut faults) = shaped(tree, Languages::Any);
    drop_repeated(&mut sections, &mut faults);
    sections
}

/// Returns the sections of one file and the errors in their shape.
fn shaped<'a>(tree: &'a Parsed<'_>, texts: Languages) -> (Vec<Section<'a>>, Faults) {
    let mut sections = Vec::new();
    let mut faults = Faults::new();
    tree.gaps.iter().for_each(|gap| faults.leave_out(*gap));
    check_file(tree, &mut faults);
    let group = GROUP.id.of(FILE.group.of(tree.root()));
    for entry in tree.root().entries() {
        if let Some(key) = File::TABLE.key(entry.name()) {
            let before = (faults.errors(), faults.hidden().len());
            if !(entry.value.is_null() && shape::is_left_behind(File::TABLE, tree.root(), entry)) {
                shape::check_kind(&key.kind, entry.value, entry.key.span(), texts, &mut faults);
            }
            sections.push(Section {
                name: key.name,
                origin: Origin::from(entry),
                group: group.and_then(Node::as_str),
                references: references(key, entry.value),
                clean: (faults.errors(), faults.hidden().len()) == before
                    && !entry.value.lacks(tree.gaps, entry.key.span()),
            });
        }
    }
    (sections, faults)
}

/// Returns `true` if the file is in `commands/`.
fn holds_operations(tree: &Parsed<'_>) -> bool {
    let mut parts = tree.path.rsplit('/');
    parts.nth(1) == Some("commands")
}

fn check_file(tree: &Parsed<'_>, faults: &mut Faults) {
    let Some(entries) = tree.root().as_mapping() else {
        return shape::check_root(tree.root(), faults);
    };
    shape::check_keys(Cursor::file(tree.root()), tree.root(), faults);
    let grouped = |entry: &Entry<'_>| grammar::GROUPED.contains(&entry.name());
    if !holds_operations(tree) {
        for entry in entries.filter(grouped) {
            let message = text!(
                "`{key}` 应当写在 `commands/` 下的文件中",
                "`{key}` belongs in a file under `commands/`",
                key = entry.name()
            );
            let fault = Diagnostic::error(FaultCode::MisplacedSection, entry.key.span(), message);
            faults.push(fault);
        }
    } else if FILE.group.of(tree.root()).is_none()
        && tree.is_whole
        && !faults.suggests(FILE.group.name)
    {
        let at = entries
            .clone()
            .find(|entry| grouped(entry))
            .or(entries.clone().next());
        let span = at.map_or(tree.root().span(), |entry| entry.key.span());
        let message = text!(
            "这个文件没有为其中的接口定义 `group`",
            "this file does not define the `group` of its operations"
        );
        let fault = Diagnostic::error(FaultCode::SectionMissing, span, message);
        faults.push(fault.note(text!(
            "在文件开头写 `group: {{ id: …, zh: …, en: … }}`",
            "write `group: {{ id: …, zh: …, en: … }}` at the top of the file"
        )));
    }
}

/// Keeps the first of sections that may occur only once, and reports the others.
fn drop_repeated(sections: &mut Vec<Section<'_>>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    sections.retain(|section| {
        let mut once = grammar::ONCE.iter().chain(&grammar::AT_MOST_ONCE);
        if !once.any(|name| *name == section.name) {
            return true;
        }
        let span = section.origin.name();
        let earlier = *first.entry(section.name).or_insert(span);
        if earlier == span {
            return true;
        }
        let message = text!(
            "`{name}` 定义了两次",
            "`{name}` is defined twice",
            name = section.name
        );
        let fault = Diagnostic::error(FaultCode::SectionTwice, span, message);
        faults.push(fault.also(earlier, text!("首次定义在这里", "first defined here")));
        false
    });
}

/// Checks that there is a file for the sections below the messages, and one with operations.
fn check_files(trees: &[Parsed<'_>], sections: &[Section<'_>], faults: &mut Faults) -> bool {
    let Some(first) = trees.first() else {
        return true;
    };
    let before = faults.errors();
    let mut missing = |message: Text, note: Text| {
        let span = Span::point(first.root().span().file, 0);
        faults.push(Diagnostic::error(FaultCode::SectionMissing, span, message).note(note));
    };
    let absent = |name: &&&str| !sections.iter().any(|section| section.name == **name);
    let absent: Vec<_> = grammar::ONCE.iter().filter(absent).copied().collect();
    let has_protocol = trees.iter().any(|tree| file_name(tree) == PROTOCOL);
    if !has_protocol && !absent.is_empty() {
        let note = text!(
            "它定义 {absent}",
            "it defines {absent}",
            absent = Text::listed(absent.iter().map(|name| format!("`{name}`")))
        );
        missing(
            text!(
                "规范中没有文件 `{PROTOCOL}`",
                "the spec has no file `{PROTOCOL}`"
            ),
            note,
        );
    }
    if !trees.iter().any(holds_operations) {
        let note = text!(
            "`commands/` 中每个文件定义一组接口",
            "each file in `commands/` defines a group of operations"
        );
        missing(
            text!(
                "规范的 `commands/` 中没有文件",
                "the spec has no file in `commands/`"
            ),
            note,
        );
    }
    faults.errors() == before
}

/// The file of the protocol-wide sections.
const PROTOCOL: &str = "protocol.yaml";

fn file_name<'t>(tree: &'t Parsed<'_>) -> &'t str {
    tree.path.rsplit('/').next().unwrap_or_default()
}

fn check_present(trees: &[Parsed<'_>], sections: &[Section<'_>], faults: &mut Faults) {
    let at_protocol = |tree: &&Parsed<'_>| file_name(tree) == PROTOCOL;
    let Some(home) = trees.iter().find(at_protocol).or(trees.first()) else {
        return;
    };
    let span = Span::point(home.root().span().file, 0);
    for name in grammar::ONCE {
        let is_there = sections.iter().any(|section| section.name == name);
        if !is_there && !faults.suggests(name) {
            let message = text!("规范中没有 `{name}`", "the spec has no `{name}`");
            let fault = Diagnostic::error(FaultCode::SectionMissing, span, message);
            faults.push(fault.note(text!(
                "在 `{PROTOCOL}` 中定义 `{name}`",
                "define `{name}` in `{PROTOCOL}`"
            )));
        }
    }
}
