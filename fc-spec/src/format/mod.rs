//! One layout for the text of a spec file: keys in the order of the grammar, two columns a level, one blank line at most.
//!
//! Kept to the byte are comments and scalars; kept as they are the order of everything whose order says something (the
//! keys of a body, the values of an enum, operations), and whether a mapping or list is in brackets: only where one
//! does not fit its line, or has a comment in it, does it go over several.
//!
//! **Architecture invariant.** What comes out is read again and compared with what went in, thing by thing, before
//! anybody sees it: see `same`.

mod block;
mod comments;
mod flow;
mod order;
mod printer;
mod same;
mod scalar;

use crate::diagnostic::Faults;
use crate::load::inside;
use crate::source::{Edits, FileId, SourceFile, changed_lines};
use crate::syntax::parse;

/// Why a text stays as it is.
#[derive(Clone, Debug)]
pub enum Refused {
    /// It cannot be read, or has keys that the language does not have; whose they are nobody knows.
    Faults(Faults),
    /// The new text would not have said the same.
    NotTheSame,
}

/// The text of a file in its layout; the same text where it has it already.
///
/// Line ends become those of the first line.
///
/// # Errors
///
/// For a text that stays as it is, and why.
pub fn format(file: FileId, source: &SourceFile) -> Result<String, Refused> {
    let text = source.text.as_str();
    let newline = source.newline();
    let mut faults = Faults::new();
    // Of the text as it is in the file, so that the places of faults are right.
    let tree = parse(file, text, &mut faults);
    let Some(tree) = tree.filter(|_| !faults.has_errors()) else {
        return Err(Refused::Faults(faults));
    };
    let top = inside(tree.root(), &mut faults);
    order::check(tree.root(), top, &mut faults);
    if faults.has_errors() {
        return Err(Refused::Faults(faults));
    }

    let unread = |_| Refused::NotTheSame;
    let source = SourceFile::new(source.path.as_str(), text.replace("\r\n", "\n"));
    let tree = read(file, &source.text).map_err(unread)?;
    let mut root = block::build(&tree, &source);
    let head = order::head(&mut root);
    order::arrange(&mut root, top, 0, &source);
    let new = printer::print(&head, &root, top, &source.text);
    let again = read(file, &new).map_err(unread)?;
    if !same::same((&tree, &source.text), (&again, &new), top) {
        return Err(Refused::NotTheSame);
    }
    Ok(new.replace('\n', newline))
}

/// A file with edits made in it.
pub(crate) struct Edited {
    /// Its text.
    pub text: String,
    /// The lines that change, as a diff without line numbers.
    pub diff: String,
}

/// Makes edits in a file. A formatted file stays formatted.
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

/// Formats the new text of a file. `None` if the old text was not formatted, or if the new one cannot be.
fn formatted_like(before: &SourceFile, text: &str) -> Option<String> {
    // Spans of faults are not shown.
    let file = FileId(0);
    if format(file, before).ok()? != before.text {
        return None;
    }
    format(file, &SourceFile::new(before.path.as_str(), text)).ok()
}

/// The tree of a text without errors.
fn read(file: FileId, text: &str) -> Result<crate::syntax::Tree<'_>, Faults> {
    let mut faults = Faults::new();
    match parse(file, text, &mut faults) {
        Some(tree) if !faults.has_errors() => Ok(tree),
        _ => Err(faults),
    }
}
