//! The YAML that a new operation begins as, and the place in its group's file where it belongs.

use crate::diagnostic::Faults;
use crate::load::is_operation_name;
use crate::model::{Kind, Model, RangeUse};
use crate::syntax::{Entry, SourceFile, Sources, parse};
use std::fmt;

/// What is wanted.
#[derive(Clone, Copy, Debug)]
pub struct NewOperation<'a> {
    /// Its name, in `snake_case`.
    pub name: &'a str,
    /// Id of the group it belongs to.
    pub group: &'a str,
    /// A report of the robot instead of a command of the app.
    pub report: bool,
    /// Its code; `None` for the next free one.
    pub code: Option<u16>,
}

/// A new operation in its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scaffold {
    /// Path of the group's file from the project's root.
    pub path: String,
    /// The file's new text.
    pub text: String,
    /// Line on which the operation begins, counted from 1.
    pub line: usize,
    /// Its code.
    pub code: u16,
}

/// Why there is no place for a new operation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScaffoldError {
    /// The name is not in `snake_case`.
    Name(String),
    /// There is no such group.
    Group {
        /// What was asked for.
        wanted: String,
        /// Ids of all groups.
        known: Vec<String>,
    },
    /// All codes are taken from which new operations get theirs.
    Codes,
    /// The section that it belongs to is not written line by line.
    Layout {
        /// Path of the file.
        path: String,
        /// Name of the section.
        section: &'static str,
    },
}

impl fmt::Display for ScaffoldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => {
                write!(f, "`{name}` is not a snake_case name such as `get_battery`")
            }
            Self::Group { wanted, known } => {
                write!(
                    f,
                    "there is no group `{wanted}`; the groups are {}",
                    known.join(", ")
                )
            }
            Self::Codes => f.write_str(
                "no code is free in the ranges that new operations get theirs from; add a range to \
                 `codes.ranges`, or name a code with --code",
            ),
            Self::Layout { path, section } => write!(
                f,
                "`{section}` in {path} is written in braces; write it in block style, or add the operation by hand"
            ),
        }
    }
}

impl std::error::Error for ScaffoldError {}

/// Puts the beginning of a new operation behind the last of its kind in its group's file.
///
/// Whether the result is sound, a name not taken for instance, is for [`load`](crate::load::load) to
/// say.
///
/// # Errors
/// [`ScaffoldError`].
pub fn scaffold(
    model: &Model,
    sources: &Sources,
    new: &NewOperation<'_>,
) -> Result<Scaffold, ScaffoldError> {
    if !is_operation_name(new.name) {
        return Err(ScaffoldError::Name(new.name.to_owned()));
    }
    let group = model.groups.iter().find(|group| group.id == new.group);
    let group = group.ok_or_else(|| ScaffoldError::Group {
        wanted: new.group.to_owned(),
        known: model.groups.iter().map(|group| group.id.clone()).collect(),
    })?;
    let (kind, section, usage) = if new.report {
        (Kind::Report, "reports", RangeUse::Reports)
    } else {
        (Kind::Command, "commands", RangeUse::Commands)
    };
    let code = new.code.or_else(|| model.next_code(usage));
    let code = code.ok_or(ScaffoldError::Codes)?;

    let path = &group.location.file;
    let files = sources.iter().find(|(_, source)| source.path == *path);
    let layout = || ScaffoldError::Layout {
        path: path.clone(),
        section,
    };
    let (file, source) = files.ok_or_else(layout)?;
    let tree = parse(file, &source.text, &mut Faults::new()).ok_or_else(layout)?;
    let place = match tree.root().entry(section) {
        Some(entry) => inside(source, entry).ok_or_else(layout)?,
        None => Place::behind_all(source),
    };
    let heading = place.heading.then(|| format!("{section}:\n"));
    let block = place.indented(&beginning(kind, new.name, code));
    let (before, after) = source.text.split_at_checked(place.at).ok_or_else(layout)?;
    let ends = before.is_empty() || before.ends_with('\n');
    let gap = if ends { "\n" } else { "\n\n" };
    let above = format!("{before}{gap}{}", heading.unwrap_or_default());
    Ok(Scaffold {
        path: path.clone(),
        line: above.lines().count() + 1,
        text: format!("{above}{block}{after}"),
        code,
    })
}

/// Where an operation is put.
struct Place {
    /// Byte offset, at the start of a line or at the end of the file.
    at: usize,
    /// Columns in front of the operation's name.
    indent: usize,
    /// The section begins here as well.
    heading: bool,
}

impl Place {
    fn behind_all(source: &SourceFile) -> Self {
        Self {
            at: source.text.len(),
            indent: 2,
            heading: true,
        }
    }

    fn indented(&self, lines: &str) -> String {
        let indent = " ".repeat(self.indent);
        let lines = lines.lines().flat_map(|line| [&indent, line, "\n"]);
        lines.collect()
    }
}

/// Behind the last operation of a section; `None` if the section is not written line by line.
fn inside(source: &SourceFile, section: Entry<'_>) -> Option<Place> {
    let value = section.value.span();
    let first = section.value.entries().next()?;
    let key = source.line_col(first.key.span().start);
    if key.line == source.line_col(section.key.span().start).line {
        return None;
    }
    let rest = source.text.get(value.end..)?;
    let end = rest
        .find('\n')
        .map_or(source.text.len(), |end| value.end + end + 1);
    Some(Place {
        at: end,
        indent: key.column - 1,
        heading: false,
    })
}

/// An operation that says nothing yet: sound as it stands, with a note wherever something is to be
/// written.
fn beginning(kind: Kind, name: &str, code: u16) -> String {
    let field = "value: { type: i32, example: 1, zh: （待写）, en: (to be written) }";
    let head = format!(
        "{name}:\n  code: 0x{code:04X}\n  zh: （待写：做什么）\n  en: (to be written, what it does)\n"
    );
    let rest = if kind == Kind::Report {
        format!("  source: {{ sections: [] }}\n  body:\n    data:\n      {field}\n")
    } else {
        format!(
            "  effect: read # or config, motion, unknown: only what reads is repeated by itself\n  \
               source: {{ sections: [] }}\n  \
               request: # drop it if there is nothing to say\n    data:\n      {field}\n  \
               response: # the same\n    data:\n      {field}\n"
        )
    };
    head + &rest
}
