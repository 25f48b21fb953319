//! From text to one tree.

use super::node::Tree;
use super::tree::{Builder, Outcome};
use super::{conflict, control, limits, recover};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::source::{FileId, Span};
use crate::text;
use std::collections::HashSet;

/// Errors of the YAML itself that are reported for one file; behind so many there is only noise.
const ERRORS: usize = 20;

/// The tree of a file's text, and all of its faults.
///
/// `None` where the tree would not say what the file means: it is no YAML, it is empty, it is several documents or the
/// two sides of a conflict, or it uses an alias, a merge key or a key that is no word. Where a key stands twice, the first one stays in the tree.
///
/// Behind text that is not YAML parsing goes on, so that the faults behind it show up in the same run.
pub fn parse<'s>(file: FileId, text: &'s str, faults: &mut Faults) -> Option<Tree<'s>> {
    let (tree, is_whole) = parse_parts(file, text, faults);
    tree.filter(|_| is_whole)
}

/// The same, with the tree also where a part of the file is not YAML: of all but the entries with such text, which are
/// noted as hidden. `false` with it where there are such.
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

/// The tree of a file without the entries that are no YAML, and what else is wrong with it.
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
        // What breaks off has had more in it.
        if broken.end == text.len() {
            faults.lose();
        }
        let mut found = Faults::new();
        let outcome = Builder::new(file, &rest, 0..rest.len()).run(&mut found);
        said = found
            .iter()
            .last()
            .map_or(usize::MAX, |fault| fault.primary.span.start);
        // What stands before the broken place is read again.
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

/// What a fault is and where.
fn place(fault: &Diagnostic) -> (FaultCode, Span) {
    (fault.code, fault.primary.span)
}
