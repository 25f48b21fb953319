//! Differences between stale files and their new contents.

use super::plan::{Plan, StaleFile};
use similar::TextDiff;
use std::fmt::Write as _;
use std::time::Duration;

/// The maximum number of lines that are shown per file.
const MAX_LINES: usize = 40;

/// The time limit of the search for the smallest difference of a file. After it, the difference is still correct, but
/// longer.
const PATIENCE: Duration = Duration::from_secs(1);

/// The difference between a stale file and its new contents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileDiff {
    /// The path, relative to the root.
    pub path: String,
    /// A unified diff from the disk to the new contents, cut off if it is long.
    pub text: String,
}

impl Plan {
    /// Returns the difference of every stale file, sorted by path. Foreign files are not compared.
    #[must_use]
    pub fn diffs(&self) -> Vec<FileDiff> {
        let stale = self.created.iter().chain(&self.updated);
        let mut diffs: Vec<FileDiff> = stale.chain(&self.orphaned).map(diff).collect();
        diffs.sort_by(|a, b| a.path.cmp(&b.path));
        diffs
    }
}

/// Returns a unified diff of two texts below two file names. Returns an empty string for equal texts.
#[must_use]
pub fn unified(old_name: &str, new_name: &str, old: &str, new: &str) -> String {
    let diff = TextDiff::configure().timeout(PATIENCE).diff_lines(old, new);
    diff.unified_diff()
        .context_radius(3)
        .header(old_name, new_name)
        .to_string()
}

fn diff(file: &StaleFile) -> FileDiff {
    let StaleFile {
        path,
        before,
        contents,
    } = file;
    let old = String::from_utf8_lossy(before.as_deref().unwrap_or_default());
    let new = contents.as_deref().unwrap_or_default();
    let name = |prefix: &str, there: bool| {
        if there {
            format!("{prefix}/{path}")
        } else {
            "/dev/null".to_owned()
        }
    };
    let unified = unified(
        &name("a", before.is_some()),
        &name("b", contents.is_some()),
        &old,
        new,
    );
    let mut text: String = unified.split_inclusive('\n').take(MAX_LINES).collect();
    let rest = unified.lines().count().saturating_sub(MAX_LINES);
    if rest > 0 {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "… {rest} more lines");
    }
    FileDiff {
        path: path.clone(),
        text,
    }
}
