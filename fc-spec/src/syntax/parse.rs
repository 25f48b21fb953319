//! Parses the text of a file into one tree.

use super::builder::{Builder, Outcome};
use super::tree::Tree;
use super::{conflict, control, limits, recover};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::source::{FileId, Span};
use crate::text;
use std::collections::HashSet;

/// The maximum number of YAML errors reported for a file. Further ones would mostly be consequences.
const ERRORS: usize = 20;

/// Parses the text of a file and reports all of its errors.
///
/// Returns `None` if a tree would not have the meaning of the file. The text is not YAML or is empty, has several
/// documents or a conflict, or uses an alias, a merge key or an invalid key. The tree keeps the first entry of a
/// repeated key.
///
/// After text that is not YAML, parsing continues, so that one run reports the later errors too.
pub fn parse<'s>(file: FileId, text: &'s str, faults: &mut Faults) -> Option<Tree<'s>> {
    let (tree, is_whole) = parse_parts(file, text, faults);
    tree.filter(|_| is_whole)
}

/// Parses a text that must have no errors. Returns `None` for any other text.
pub(crate) fn parse_faultless(file: FileId, text: &str) -> Option<Tree<'_>> {
    let mut faults = Faults::new();
    parse(file, text, &mut faults).filter(|_| !faults.has_errors())
}

/// Like [`parse`], but also returns a tree if a part of the file is not YAML. The tree lacks the entries with such
/// text, and they are marked as hidden. The flag is `true` for a complete tree.
pub(crate) fn parse_parts<'s>(
    file: FileId,
    text: &'s str,
    faults: &mut Faults,
) -> (Option<Tree<'s>>, bool) {
    if text.len() > limits::FILE_BYTES {
        let message = text!(
            "文本超过 {limit} MiB",
            "the text is longer than {limit} MiB",
            limit = limits::FILE_BYTES >> 20
        );
        faults.push(Diagnostic::error(
            FaultCode::TooLarge,
            Span::point(file, 0),
            message,
        ));
        return (None, false);
    }
    control::check(file, text, faults);
    if conflict::check(file, text, faults) {
        return (None, false);
    }
    let outcome = Builder::new(file, text, 0..text.len()).run(faults);
    match outcome {
        Outcome::Tree(Some(tree)) => (Some(tree), true),
        Outcome::Tree(None) => {
            let message = text!("文件为空", "the file is empty");
            faults.push(
                Diagnostic::error(FaultCode::EmptyFile, Span::point(file, 0), message)
                    .note(text!("写入内容，或删除文件", "add content or delete it")),
            );
            (None, false)
        }
        Outcome::Unfaithful | Outcome::Stopped => (None, false),
        Outcome::Broken(at) => (resume(file, text, at, faults), false),
    }
}

/// Returns the tree of a file without the entries that are not YAML. Reports the other errors.
fn resume<'s>(file: FileId, text: &'s str, mut at: usize, faults: &mut Faults) -> Option<Tree<'s>> {
    let mut rest = text.to_owned();
    let mut known: HashSet<_> = faults.iter().map(place).collect();
    let mut said = faults
        .iter()
        .last()
        .map_or(at, |fault| fault.primary.span.start);
    for _ in 1..ERRORS {
        let broken = recover::entry(&rest, said.min(at), at)?;
        rest = recover::without(&rest, broken.clone());
        faults.leave_out(Span::new(file, broken.start, broken.end));
        // A file that breaks off has lost content.
        if broken.end == text.len() {
            faults.lose();
        }
        let mut found = Faults::new();
        let outcome = Builder::new(file, &rest, 0..rest.len()).run(&mut found);
        said = found
            .iter()
            .last()
            .map_or(usize::MAX, |fault| fault.primary.span.start);
        // The text before the broken place is parsed again, so its errors are known already.
        faults.extend(
            found
                .iter()
                .filter(|fault| known.insert(place(fault)))
                .cloned(),
        );
        found.hidden().iter().for_each(|text| faults.hide(*text));
        match outcome {
            Outcome::Tree(tree) => return tree.map(|tree| tree.of_source(text)),
            Outcome::Unfaithful | Outcome::Stopped => return None,
            Outcome::Broken(next) => at = next,
        }
    }
    None
}

/// Returns the code and the place of an error, which identify it.
fn place(fault: &Diagnostic) -> (FaultCode, Span) {
    (fault.code, fault.primary.span)
}
