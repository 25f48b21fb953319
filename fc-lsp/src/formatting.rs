//! A file laid out as `fcproto fmt` does it.

use crate::snapshot::Snapshot;
use fc_spec::format::format;
use gen_lsp_types::{TextEdit, Uri};

/// What changes: the lines from the first that differs to the last. `None` for a file that stays as it is because it
/// cannot be read, which its faults say.
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

/// Bytes of the lines that are the same.
fn common<'t>(old: impl Iterator<Item = &'t str>, new: impl Iterator<Item = &'t str>) -> usize {
    let same = old.zip(new).take_while(|(old, new)| old == new);
    same.map(|(line, _)| line.len()).sum()
}
