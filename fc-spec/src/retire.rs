//! Removes an operation from a spec.
//!
//! Its code becomes retired, so that no other operation gets it. Types, entities, coordinate systems and stores that only this operation
//! uses are removed as well.

use crate::diagnostic::{FaultCode, Faults, nearest};
use crate::format::Revised;
use crate::language::grammar::{CODES, FILE, RETIRED, TEXT};
use crate::load::Trees;
use crate::model::{Kind, Languages, Model, Text};
use crate::source::{Edits, SourceFile, Sources, Span};
use crate::syntax::{Entry, Tree, parse, quoted};
use crate::{text, text_error};

/// A spec without one of its operations.
#[derive(Clone, Debug)]
pub struct Retired {
    /// The files.
    pub sources: Sources,
    /// The retired code in the spelling of the spec. `None` if the operation had no code, or shared it with another one.
    pub code: Option<String>,
    /// The names of the removed things that only this operation used, in the order of removal.
    pub with_it: Vec<String>,
    /// The path and the lines of each change, as diffs without line numbers.
    pub diffs: Vec<(String, String)>,
}

/// The reason why an operation cannot be removed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RetireError {
    /// The spec has no such operation.
    Unknown {
        /// The requested name.
        name: String,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// The part to change is not in block style.
    Layout {
        /// The path of the file.
        path: String,
        /// The name of the part.
        what: String,
    },
}

impl RetireError {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Unknown {
                name,
                nearest: Some(nearest),
            } => text!(
                "没有接口 `{name}`；是否想写 `{nearest}`？",
                "there is no operation `{name}`; did you mean `{nearest}`?"
            ),
            Self::Unknown {
                name,
                nearest: None,
            } => text!("没有接口 `{name}`", "there is no operation `{name}`"),
            Self::Layout { path, what } => text!(
                "{path} 中的 `{what}` 写在大括号或方括号中；改成逐行书写，或手工修改",
                "`{what}` in {path} is written in braces or brackets; write it in block style, or change it by hand"
            ),
        }
    }
}

text_error!(RetireError);

/// Removes an operation and the comments above it. `why` becomes the text of its retired code.
///
/// [`load`](crate::load::load) reports the errors of the result, such as remaining uses of the operation.
///
/// # Errors
/// [`RetireError`] if the spec has no such operation, or if a part to change is not in block style.
pub fn retire(
    model: &Model,
    sources: &Sources,
    name: &str,
    why: &Text,
) -> Result<Retired, RetireError> {
    let Some(operation) = model.operation(name) else {
        let names = model.operations.iter().map(|it| it.name.as_str());
        return Err(RetireError::Unknown {
            name: name.to_owned(),
            nearest: nearest(name, names).map(str::to_owned),
        });
    };
    let section = match operation.kind() {
        Kind::Command => FILE.commands.name,
        Kind::Report => FILE.reports.name,
        Kind::Stream => FILE.streams.name,
    };
    let mut rest = Rest {
        sources: sources.clone(),
        diffs: Vec::new(),
    };
    rest.change(name, |tree, file| {
        let parent = tree.root().entry(section)?;
        let entry = parent.value.entry(name)?;
        Some(without(file, entry, parent))
    })?;

    let mut others = model.operations.iter().filter(|it| it.name != name);
    let is_free = operation.code.value.is_some()
        && others.all(|other| other.code.value != operation.code.value);
    let code = is_free.then(|| operation.code.spelling.clone());
    if let Some(code) = &code {
        rest.change(FILE.codes.name, |tree, file| {
            let codes = tree.root().entry(FILE.codes.name)?;
            Some(buried(file, codes, code, why))
        })?;
    }

    let mut with_it = Vec::new();
    while let Some(span) = unused(&rest.sources) {
        let name = rest.sources.slice(span).to_owned();
        rest.change(&name, |tree, file| {
            let mut entries = tree.root().entries();
            let (entry, parent) = entries.find_map(|section| find(section, span))?;
            Some(without(file, entry, parent))
        })?;
        with_it.push(name);
    }
    Ok(Retired {
        sources: rest.sources,
        code,
        with_it,
        diffs: rest.diffs,
    })
}

/// The spec during the removal.
struct Rest {
    sources: Sources,
    diffs: Vec<(String, String)>,
}

impl Rest {
    /// Changes the first file for which `edits` does not return `None`.
    ///
    /// `edits` returns `None` if the file does not contain the part, and `Some(None)` if the part is not on its own lines.
    fn change(
        &mut self,
        what: &str,
        mut edits: impl FnMut(&Tree<'_>, &SourceFile) -> Option<Option<Edits>>,
    ) -> Result<(), RetireError> {
        let found = self.sources.iter().find_map(|(id, file)| {
            let tree = parse(id, &file.text, &mut Faults::new())?;
            Some((file, edits(&tree, file)?))
        });
        let Some((file, Some(edits))) = found else {
            return Err(RetireError::Layout {
                path: found.map_or_else(String::new, |(file, _)| file.path.clone()),
                what: what.to_owned(),
            });
        };
        let revised = Revised::new(&self.sources, file, &edits);
        self.diffs.push((revised.path, revised.diff));
        self.sources = revised.sources;
        Ok(())
    }
}

/// Returns the place of the first unused thing.
fn unused(sources: &Sources) -> Option<Span> {
    let mut faults = Faults::new();
    let _ = Trees::new(sources).load(Languages::Any, &mut faults);
    // Words of `availability` stay, because they belong to the whole protocol.
    let is_unused = |code| {
        let mut declared = FaultCode::DECLARED.iter().map(|[_, unused]| *unused);
        code != FaultCode::UnusedAvailability && declared.any(|unused| unused == code)
    };
    let fault = faults.iter().find(|fault| is_unused(fault.code))?;
    // The place of such an error is the key of the thing.
    Some(fault.primary.span)
}

/// Returns the entry with this key at any depth below another, and its parent.
fn find(parent: Entry<'_>, key: Span) -> Option<(Entry<'_>, Entry<'_>)> {
    let value = parent.value.span();
    if value.file != key.file || key.start < value.start || value.end < key.end {
        return None;
    }
    let mut entries = parent.value.entries();
    entries.find_map(|entry| {
        if entry.key.span() == key {
            Some((entry, parent))
        } else {
            find(entry, key)
        }
    })
}

/// Returns the edits that remove an entry and the comments above it.
///
/// They remove the parent if it has no other entry. `None` if the entry is not on its own lines.
fn without(file: &SourceFile, entry: Entry<'_>, parent: Entry<'_>) -> Option<Edits> {
    if is_flow(file, parent) {
        return None;
    }
    let alone = parent.value.entries().nth(1).is_none();
    let gone = if alone { parent } else { entry };
    let mut edits = Edits::default();
    edits.remove_lines(file, with_comments(file, gone));
    Some(edits)
}

/// Returns the span of an entry with the comments above it. The span includes the blank line above if another one follows.
pub(crate) fn with_comments(file: &SourceFile, gone: Entry<'_>) -> Span {
    let key = gone.key.span();
    let above = gone.key.comments().find(|it| it.start < key.start);
    let mut start = above.map_or(key.start, |comment| comment.start.min(key.start));
    let end = gone.value.span().end.max(key.end);
    // One of the two blank lines is enough.
    let is_blank = |line| {
        let text = file.line_text(line);
        text.is_none_or(|text| text.trim().is_empty())
    };
    let first = file.line(start);
    if first > 1 && is_blank(first - 1) && is_blank(file.line(end.saturating_sub(1)) + 1) {
        start = file.lines(first - 1, first - 1).map_or(start, |it| it.0);
    }
    Span::new(key.file, start, end)
}

/// Returns the edits that add a code to the retired ones. `None` if the section is in flow style.
fn buried(file: &SourceFile, codes: Entry<'_>, code: &str, why: &Text) -> Option<Edits> {
    let one_line = |text: &str| quoted(&text.split_whitespace().collect::<Vec<_>>().join(" "));
    let texts = [(TEXT.zh.name, &why.zh), (TEXT.en.name, &why.en)].into_iter();
    let texts = texts.filter(|(_, text)| !text.is_empty());
    let texts = texts.map(|(key, text)| format!("{key}: {}", one_line(text)));
    let code = format!("{}: {code}", RETIRED.code.name);
    let entries: Vec<_> = std::iter::once(code).chain(texts).collect();
    let item = format!("- {{ {} }}", entries.join(", "));
    if is_flow(file, codes) {
        return None;
    }
    let mut edits = Edits::default();
    if let Some(retired) = codes.value.entry(CODES.retired.name) {
        let last = retired.value.items().last()?;
        if is_flow(file, retired) {
            return None;
        }
        let line = format!("{}{item}", indent(file, last.span()));
        edits.add_line(file, last.span(), &line);
    } else {
        let ranges = codes.value.entry(CODES.ranges.name)?;
        let indent = indent(file, ranges.key.span());
        let lines = format!("{indent}{}:\n{indent}  {item}", CODES.retired.name);
        edits.add_line(file, ranges.span(), &lines);
    }
    Some(edits)
}

/// Returns the indentation of the line on which the span begins.
fn indent(file: &SourceFile, span: Span) -> String {
    " ".repeat(file.indentation(span.start))
}

/// Returns `true` if the value is empty or begins on the line of its key.
pub(crate) fn is_flow(file: &SourceFile, entry: Entry<'_>) -> bool {
    let value = entry.value.span();
    value.start == value.end || file.line(value.start) == file.line(entry.key.span().start)
}
