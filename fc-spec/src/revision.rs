//! Edits of a spec for a release: sets the version and removes old waivers.

use crate::diagnostic::Faults;
use crate::format::Revised;
use crate::language::grammar::{FILE, PROTOCOL};
use crate::retire::{is_flow, with_comments};
use crate::source::{Edits, SourceFile, Sources, Span};
use crate::syntax::{Tree, parse, quoted};

/// Sets the version of the protocol. All other bytes stay the same.
///
/// Returns `None` if no file has the version of the protocol, which [`load`](crate::load::load) reports.
#[must_use]
pub fn renumbered(sources: &Sources, version: &str) -> Option<Revised> {
    revised(sources, |tree, _| {
        let written = PROTOCOL.version.of(FILE.protocol.of(tree.root()))?;
        let mut edits = Edits::default();
        // The quotes are necessary: without them, other parsers read a number.
        edits.replace(written.span(), quoted(version));
        Some(edits)
    })
}

/// Removes a waiver and the comments above it. The edit leaves `waivers: {}` if it was the last one.
///
/// Returns `None` if no waiver has this id, or if it is not on its own lines.
#[must_use]
pub fn without_waiver(sources: &Sources, id: &str) -> Option<Revised> {
    revised(sources, |tree, file| {
        let waivers = tree.root().entry(FILE.waivers.name)?;
        let gone = waivers.value.entry(id)?;
        if is_flow(file, waivers) {
            return None;
        }
        let mut edits = Edits::default();
        if waivers.value.entries().nth(1).is_none() {
            edits.insert_after(colon(file, waivers.key.span())?, " {}");
        }
        edits.remove_lines(file, with_comments(file, gone));
        Some(edits)
    })
}

/// Returns the span of the colon after a key.
fn colon(file: &SourceFile, key: Span) -> Option<Span> {
    let at = key.end + file.text.get(key.end..)?.find(':')?;
    Some(Span::new(key.file, at, at + 1))
}

fn revised(
    sources: &Sources,
    edits: impl Fn(&Tree<'_>, &SourceFile) -> Option<Edits>,
) -> Option<Revised> {
    sources.iter().find_map(|(id, file)| {
        let tree = parse(id, &file.text, &mut Faults::new())?;
        Some(Revised::new(sources, file, &edits(&tree, file)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the texts of all files. Empty if there was no edit.
    fn texts(revised: Option<&Revised>) -> Vec<String> {
        let files = revised.into_iter().flat_map(|it| it.sources.iter());
        files.map(|(_, file)| file.text.clone()).collect()
    }

    #[test]
    fn only_the_number_changes() {
        let before = "# a comment\nprotocol:\n  version: \"2024.09\" # of the month\n  id: fc\n";
        let sources = Sources::from_texts([
            ("spec/other.yaml", "types:\n"),
            ("spec/protocol.yaml", before),
        ]);
        let after = renumbered(&sources, "2026.12");
        let path = after.as_ref().map(|it| it.path.as_str());
        assert_eq!(path, Some("spec/protocol.yaml"));
        let expected = ["types:\n", &before.replace("2024.09", "2026.12")];
        assert_eq!(texts(after.as_ref()), expected);
        let again = after.and_then(|it| renumbered(&it.sources, "2026.12"));
        assert_eq!(texts(again.as_ref()), expected);
        assert_eq!(again.map(|it| it.diff), Some(String::new()));
        assert!(renumbered(&Sources::from_texts([("spec/other.yaml", "types:\n")]), "1").is_none());
    }

    #[test]
    fn only_the_waiver_goes() {
        let one = "  # agreed in March\n  FC0725-1a2b3c4d5e6f: { by: a }\n";
        let other = "  FC0717-1a2b3c4d5e6f:\n    by: b # still\n";
        let text = format!("# head\nwaivers: # accepted\n{one}{other}");
        let sources = Sources::from_texts([("spec/waivers.yaml", text.as_str())]);
        let after = without_waiver(&sources, "FC0725-1a2b3c4d5e6f");
        assert_eq!(texts(after.as_ref()), [text.replace(one, "")]);
        let last = after.and_then(|it| without_waiver(&it.sources, "FC0717-1a2b3c4d5e6f"));
        let left = "# head\nwaivers: {} # accepted\n";
        assert_eq!(texts(last.as_ref()), [left]);
        assert!(without_waiver(&sources, "FC0799-1a2b3c4d5e6f").is_none());
        let flow = "waivers: { FC0725-1a2b3c4d5e6f: { by: a } }\n";
        let flow = Sources::from_texts([("spec/waivers.yaml", flow)]);
        assert!(without_waiver(&flow, "FC0725-1a2b3c4d5e6f").is_none());
    }
}
