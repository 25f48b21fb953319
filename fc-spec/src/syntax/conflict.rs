//! Conflict markers that git leaves in a file.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::source::{FileId, Span};
use crate::text;

/// The start, the divisions and the end of a conflict.
const MARKERS: [&str; 4] = ["<<<<<<<", "|||||||", "=======", ">>>>>>>"];

/// Reports every conflict in the file. Returns `true` if there is one. A file with conflicts is two files at once, so
/// no other error is reported.
pub(super) fn check(file: FileId, text: &str, faults: &mut Faults) -> bool {
    if !MARKERS.iter().any(|marker| text.contains(marker)) {
        return false;
    }
    let mut conflicts: Vec<Vec<(Span, &str)>> = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let at = start;
        start += line.len();
        let Some(marker) = marker(line) else { continue };
        let place = (Span::new(file, at, at + marker.len()), marker);
        let ended = |conflict: &&mut Vec<(Span, &str)>| {
            marker != "<<<<<<<" && !conflict.iter().any(|(_, marker)| *marker == ">>>>>>>")
        };
        match conflicts.last_mut().filter(ended) {
            Some(conflict) => conflict.push(place),
            None => conflicts.push(vec![place]),
        }
    }
    for conflict in &conflicts {
        let mut places = conflict.iter();
        let Some((span, marker)) = places.next() else {
            continue;
        };
        let message = text!(
            "`{marker}` 是未解决的合并冲突的标记",
            "`{marker}` is a marker of an unresolved merge conflict"
        );
        let fault = Diagnostic::error(FaultCode::ConflictMarker, *span, message)
            .label(text!("冲突从这里开始", "the conflict starts here"))
            .note(text!(
                "保留其中一方的内容，或合并两方正确的部分，并删除标记",
                "keep the lines of one side, or the right parts of both, and delete the markers"
            ));
        faults.push(places.fold(fault, |fault, (span, marker)| {
            let side = match *marker {
                "=======" => text!("另一方从这里开始", "the other side starts here"),
                ">>>>>>>" => text!("冲突到这里结束", "it ends here"),
                _ => text!("共同祖先从这里开始", "the common ancestor starts here"),
            };
            fault.also(*span, side)
        }));
    }
    !conflicts.is_empty()
}

/// Returns the marker at the start of a line. Only a space or nothing may follow it.
fn marker(line: &str) -> Option<&'static str> {
    MARKERS.into_iter().find(|marker| {
        let rest = line.strip_prefix(marker);
        rest.is_some_and(|rest| rest.trim().is_empty() || rest.starts_with(' '))
    })
}
