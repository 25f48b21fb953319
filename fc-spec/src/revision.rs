//! The spec under another number of its version.

use crate::diagnostic::Faults;
use crate::load::grammar::{FILE, PROTOCOL};
use crate::syntax::{Edits, SourceFile, Sources, parse, quoted};

/// A spec that calls itself by another version.
#[derive(Clone, Debug)]
pub struct Renumbered {
    /// Its files.
    pub sources: Sources,
    /// Path of the file that has changed.
    pub path: String,
    /// The line that has changed, as a diff without line numbers.
    pub diff: String,
}

/// Writes `version` as that of the protocol; everything else stays as it is, to the byte. `None` where no file says of
/// which version the protocol is, which [`load`](crate::load::load) reports.
#[must_use]
pub fn renumbered(sources: &Sources, version: &str) -> Option<Renumbered> {
    let (file, edits) = sources.iter().find_map(|(id, file)| {
        let tree = parse(id, &file.text, &mut Faults::new())?;
        let written = PROTOCOL.version.of(FILE.protocol.of(tree.root()))?;
        let mut edits = Edits::default();
        // Always in quotes: without them other parsers read it as a number.
        edits.replace(written.span(), quoted(version));
        Some((file, edits))
    })?;
    let (path, diff) = (file.path.clone(), edits.diff(file));
    let text = edits.apply(file);
    let mut changed = sources.clone();
    changed.replace(SourceFile::new(&path, text));
    Some(Renumbered {
        sources: changed,
        path,
        diff,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_number_changes() {
        let before = "# a comment\nprotocol:\n  version: \"2024.09\" # of the month\n  id: fc\n";
        let sources = Sources::from_texts([
            ("spec/other.yaml", "types:\n"),
            ("spec/protocol.yaml", before),
        ]);
        let Some(after) = renumbered(&sources, "2026.12") else {
            panic!("there is a version");
        };
        assert_eq!(after.path, "spec/protocol.yaml");
        let texts: Vec<_> = after
            .sources
            .iter()
            .map(|(_, file)| file.text.clone())
            .collect();
        assert_eq!(texts[0], "types:\n");
        assert_eq!(texts[1], before.replace("2024.09", "2026.12"));
        assert!(renumbered(&Sources::from_texts([("spec/other.yaml", "types:\n")]), "1").is_none());
    }
}
