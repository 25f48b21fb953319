//! Taking an operation out of the spec: its code is kept from ever being given out again, and what only it has used
//! goes with it.

use crate::diagnostic::{FaultCode, Faults, nearest};
use crate::format::{Edited, edited};
use crate::language::grammar::{CODES, FILE, RETIRED, TEXT};
use crate::load::Trees;
use crate::model::{Kind, Languages, Model, Text};
use crate::source::{Edits, SourceFile, Sources, Span};
use crate::syntax::{Entry, Tree, parse, quoted};
use crate::text;
use std::fmt;

/// Faults of what nothing uses any more; their place is its key.
const UNUSED: [FaultCode; 4] = [
    FaultCode::UnusedType,
    FaultCode::UnusedEntity,
    FaultCode::UnusedCoordinates,
    FaultCode::UnusedStore,
];

/// A spec without one of its operations.
#[derive(Clone, Debug)]
pub struct Retired {
    /// Its files.
    pub sources: Sources,
    /// The code that nobody gets any more, as the spec writes it; `None` if it had none, or if another operation has
    /// it as well.
    pub code: Option<String>,
    /// Names of what only it has used, in the order in which it went.
    pub with_it: Vec<String>,
    /// Path and lines of each change, as diffs without line numbers.
    pub diffs: Vec<(String, String)>,
}

/// Why an operation cannot be taken out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RetireError {
    /// There is no such operation.
    Unknown {
        /// What was asked for.
        name: String,
        /// What it may be a slip of.
        nearest: Option<String>,
    },
    /// What is to change is not written line by line.
    Layout {
        /// Path of the file.
        path: String,
        /// What it is.
        what: String,
    },
}

impl RetireError {
    /// The sentence for the user.
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

impl fmt::Display for RetireError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for RetireError {}

/// Takes an operation out, with the comments above it; `why` stands beside its code from then on.
///
/// [`load`](crate::load::load) reports the errors of the result, such as uses of the operation that are left.
///
/// # Errors
/// [`RetireError`].
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

/// What is left of a spec.
struct Rest {
    sources: Sources,
    diffs: Vec<(String, String)>,
}

impl Rest {
    /// Changes the file that has what is to change; the others have no word of it (`None`), or it does not stand on
    /// lines of its own there (`Some(None)`).
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
        let Edited { text, diff } = edited(file, &edits);
        self.diffs.push((file.path.clone(), diff));
        let file = SourceFile::new(&file.path, text);
        self.sources.replace(file);
        Ok(())
    }
}

/// The first thing that nothing uses.
fn unused(sources: &Sources) -> Option<Span> {
    let mut faults = Faults::new();
    let _ = Trees::new(sources).load(Languages::Any, &mut faults);
    let fault = faults.iter().find(|fault| UNUSED.contains(&fault.code))?;
    Some(fault.primary.span)
}

/// The entry with this key, somewhere below another, and the one that it stands in.
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

/// Without an entry and the comments above it; without what it stands in if nothing else is there. `None` if it does
/// not stand on lines of its own.
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

/// An entry, the comments above it, and the blank line above if there is one below as well.
pub(crate) fn with_comments(file: &SourceFile, gone: Entry<'_>) -> Span {
    let key = gone.key.span();
    let above = gone.key.comments().find(|it| it.start < key.start);
    let mut start = above.map_or(key.start, |comment| comment.start.min(key.start));
    let end = gone.value.span().end.max(key.end);
    // One of the blank lines around it is enough.
    let is_blank = |line: usize| {
        let text = file.lines(line, line);
        let text = text.and_then(|(start, end)| file.text.get(start..end));
        text.is_none_or(|text| text.trim().is_empty())
    };
    let first = file.line(start);
    if first > 1 && is_blank(first - 1) && is_blank(file.line(end.saturating_sub(1)) + 1) {
        start = file.lines(first - 1, first - 1).map_or(start, |it| it.0);
    }
    Span::new(key.file, start, end)
}

/// With a code among the retired ones. `None` if there is no line for it.
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

/// The blanks at the start of the line on which something begins.
fn indent(file: &SourceFile, span: Span) -> String {
    let line = file.line(span.start);
    let line = file.lines(line, line);
    let text = line.and_then(|(start, end)| file.text.get(start..end));
    let text = text.unwrap_or_default();
    " ".repeat(text.len() - text.trim_start_matches(' ').len())
}

/// Whether what stands under a key begins on its line.
pub(crate) fn is_flow(file: &SourceFile, entry: Entry<'_>) -> bool {
    let value = entry.value.span();
    value.start == value.end || file.line(value.start) == file.line(entry.key.span().start)
}
