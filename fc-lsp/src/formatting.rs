//! Formatting of a file with the rules of `fcproto fmt`.

use crate::snapshot::Snapshot;
use fc_spec::format::format;
use gen_lsp_types::{TextEdit, Uri};

/// Returns one edit from the first to the last line that changes, or no edit for a formatted file. Returns `None` for a
/// file that cannot be parsed; its diagnostics give the reason.
#[must_use]
pub fn formatting(snapshot: &Snapshot, uri: &Uri) -> Option<Vec<TextEdit>> {
    let file = snapshot.file(uri)?;
    let source = snapshot.source(file).filter(|source| source.whole)?;
    let new = format(file, source).ok()?;
    let old = source.text.as_str();
    if new == old {
        return Some(Vec::new());
    }
    let head = common(old.split_inclusive('\n'), new.split_inclusive('\n'));
    let (old, new) = (old.get(head..)?, new.get(head..)?);
    let tail = common(
        old.split_inclusive('\n').rev(),
        new.split_inclusive('\n').rev(),
    );
    let span = fc_spec::source::Span::new(file, head, head + old.len() - tail);
    Some(vec![TextEdit {
        range: snapshot.range(span),
        new_text: new.get(..new.len() - tail)?.to_owned(),
    }])
}

/// Returns the total length in bytes of the common leading lines.
fn common<'t>(old: impl Iterator<Item = &'t str>, new: impl Iterator<Item = &'t str>) -> usize {
    let same = old.zip(new).take_while(|(old, new)| old == new);
    same.map(|(line, _)| line.len()).sum()
}
