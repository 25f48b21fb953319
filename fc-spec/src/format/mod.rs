//! Formats spec files: keys in the order of the grammar, two columns per level, at most one blank line.
//!
//! The formatter keeps comments and scalars byte for byte. It keeps every order that has a meaning: keys of a body,
//! values of an enum, operations. It keeps brackets, and opens them only if their content does not fit on the line or
//! has a comment.
//!
//! **Architecture invariant.** The formatter parses its output and compares it with the input, node by node, before it
//! returns the output: see `same`.

mod block;
mod comments;
mod flow;
mod order;
mod printer;
mod same;
mod scalar;

use crate::diagnostic::Faults;
use crate::language::Cursor;
use crate::load::check_root;
use crate::source::{Edits, FileId, SourceFile, Sources, changed_lines};
use crate::syntax::{parse, parse_faultless};

/// The reason why a text is not formatted.
#[derive(Clone, Debug)]
pub enum Refused {
    /// The text has errors, or keys that the language does not have. The owner of such a key is unknown.
    Faults(Faults),
    /// The new text would have another meaning.
    NotTheSame,
}

/// Formats the text of a file. A formatted text stays the same.
///
/// All line ends become those of the first line.
///
/// # Errors
///
/// The reason why the text cannot be formatted.
pub fn format(file: FileId, source: &SourceFile) -> Result<String, Refused> {
    let text = source.text.as_str();
    let newline = source.newline();
    let mut faults = Faults::new();
    // This parses the original text, so that errors have the right places.
    let tree = parse(file, text, &mut faults);
    let Some(tree) = tree.filter(|_| !faults.has_errors()) else {
        return Err(Refused::Faults(faults));
    };
    let top = Cursor::file(tree.root());
    check_root(tree.root(), &mut faults);
    order::check(tree.root(), top, &mut faults);
    if faults.has_errors() {
        return Err(Refused::Faults(faults));
    }

    let source = SourceFile::new(source.path.as_str(), text.replace("\r\n", "\n"));
    let tree = parse_faultless(file, &source.text).ok_or(Refused::NotTheSame)?;
    let mut root = block::build(&tree, &source);
    let head = order::head(&mut root);
    order::arrange(&mut root, top, 0, &source);
    let new = printer::print(&head, &root, top, &source.text);
    let again = parse_faultless(file, &new).ok_or(Refused::NotTheSame)?;
    if !same::same((&tree, &source.text), (&again, &new), top) {
        return Err(Refused::NotTheSame);
    }
    Ok(new.replace('\n', newline))
}

/// A spec after edits of one of its files.
#[derive(Clone, Debug)]
pub struct Revised {
    /// The files.
    pub sources: Sources,
    /// The path of the edited file.
    pub path: String,
    /// The changed lines, as a diff without line numbers. Empty if the edits change nothing.
    pub diff: String,
}

impl Revised {
    /// Applies edits to a file of a spec.
    pub(crate) fn new(sources: &Sources, file: &SourceFile, edits: &Edits) -> Self {
        let Edited { text, mut diff } = edited(file, edits);
        if text == file.text {
            diff.clear();
        }
        let path = file.path.clone();
        let mut sources = sources.clone();
        sources.replace(SourceFile::new(&path, text));
        Self {
            sources,
            path,
            diff,
        }
    }
}

/// A file with edits.
pub(crate) struct Edited {
    /// The new text.
    pub text: String,
    /// The changed lines, as a diff without line numbers.
    pub diff: String,
}

/// Applies edits to a file. A formatted file stays formatted.
pub(crate) fn edited(source: &SourceFile, edits: &Edits) -> Edited {
    let text = edits.apply(source);
    let formatted = formatted_like(source, &text);
    let diff = match &formatted {
        Some(formatted) if *formatted != text => changed_lines(&source.text, formatted),
        _ => edits.diff(source),
    };
    Edited {
        text: formatted.unwrap_or(text),
        diff,
    }
}

/// Formats the new text of a file. Returns `None` if the old text was not formatted, or if the new one cannot be.
fn formatted_like(before: &SourceFile, text: &str) -> Option<String> {
    // The spans of these errors are never shown.
    let file = FileId(0);
    if format(file, before).ok()? != before.text {
        return None;
    }
    format(file, &SourceFile::new(before.path.as_str(), text)).ok()
}
