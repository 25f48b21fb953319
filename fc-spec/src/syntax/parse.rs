//! From text to one tree.

use super::node::Tree;
use super::span::{FileId, Span};
use super::tree::{Builder, Outcome};
use super::{conflict, control, limits, recover};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::text;

/// Errors of the YAML itself that are reported for one file; behind so many there is only noise.
const ERRORS: usize = 20;

/// The tree of a file's text, and all of its faults.
///
/// `None` where the tree would not say what the file means: it is no YAML, it is empty, it is several documents or the
/// two sides of a conflict, or it uses an alias, a merge key or a key that is no word. Where a key stands twice, the first one stays in the tree.
///
/// After text that is not YAML, parsing resumes at the next top-level key, or key one level below, so that
/// the faults behind it show up in the same run.
pub fn parse<'s>(file: FileId, text: &'s str, faults: &mut Faults) -> Option<Tree<'s>> {
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
        return None;
    }
    control::check(file, text, faults);
    if conflict::check(file, text, faults) {
        return None;
    }

    let mut builder = Builder::new(file, text, 0..text.len());
    match builder.run(faults) {
        Outcome::Tree(tree) => tree.or_else(|| {
            let message = text!("文件为空", "the file is empty");
            faults.push(
                Diagnostic::error(FaultCode::EmptyFile, Span::point(file, 0), message)
                    .note(text!("写入内容，或删除文件", "add content or delete it")),
            );
            None
        }),
        Outcome::Unfaithful | Outcome::Stopped => None,
        Outcome::Broken(at) => {
            resume(file, text, at, faults);
            None
        }
    }
}

/// Looks for more faults behind a broken place.
fn resume(file: FileId, text: &str, mut at: usize, faults: &mut Faults) {
    let mut last = 0;
    for _ in 1..ERRORS {
        let Some(chunk) = recover::next_chunk(text, at, last) else {
            return;
        };
        last = chunk.start;
        at = match Builder::new(file, text, chunk.clone()).run(faults) {
            Outcome::Tree(_) | Outcome::Unfaithful => chunk.end,
            Outcome::Broken(at) => at,
            Outcome::Stopped => return,
        };
    }
}
