//! How a stale file differs from what it has to be.

use super::plan::Plan;
use similar::TextDiff;
use std::fmt::Write as _;
use std::time::Duration;

/// Lines shown of one file.
const SHOWN: usize = 40;

/// How long the search for the smallest difference of one file may take; what it finds until then
/// is right as well, only longer.
const PATIENCE: Duration = Duration::from_secs(1);

/// How a stale file differs from what it has to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileDiff {
    /// Path from the root.
    pub path: String,
    /// Unified diff from the disk to what has to be, its end cut off if it is long.
    pub text: String,
}

impl Plan {
    /// How every stale file differs from what it has to be, sorted by path. Files in the way are
    /// not compared: they are somebody else's.
    #[must_use]
    pub fn diffs(&self) -> Vec<FileDiff> {
        let created = self
            .created
            .iter()
            .map(|file| diff(&file.path, None, Some(&file.contents)));
        let updated = self
            .updated
            .iter()
            .map(|file| diff(&file.path, Some(&file.before), Some(&file.contents)));
        let orphaned = self
            .orphaned
            .iter()
            .map(|file| diff(&file.path, Some(&file.before), None));
        let mut diffs: Vec<FileDiff> = created.chain(updated).chain(orphaned).collect();
        diffs.sort_by(|a, b| a.path.cmp(&b.path));
        diffs
    }
}

/// Unified diff from one text to another of a file, with both of its names above it; empty where they are the same.
#[must_use]
pub fn unified(old_name: &str, new_name: &str, old: &str, new: &str) -> String {
    let diff = TextDiff::configure().timeout(PATIENCE).diff_lines(old, new);
    diff.unified_diff()
        .context_radius(3)
        .header(old_name, new_name)
        .to_string()
}

fn diff(path: &str, before: Option<&[u8]>, after: Option<&str>) -> FileDiff {
    let old = String::from_utf8_lossy(before.unwrap_or_default());
    let new = after.unwrap_or_default();
    let name = |prefix: &str, there: bool| {
        if there {
            format!("{prefix}/{path}")
        } else {
            "/dev/null".to_owned()
        }
    };
    let unified = unified(
        &name("a", before.is_some()),
        &name("b", after.is_some()),
        &old,
        new,
    );
    let mut text: String = unified.split_inclusive('\n').take(SHOWN).collect();
    let rest = unified.lines().count().saturating_sub(SHOWN);
    if rest > 0 {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "… {rest} more lines");
    }
    FileDiff {
        path: path.to_owned(),
        text,
    }
}
