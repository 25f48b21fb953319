//! Tests the comparison of one file, with the other files from the disk.

use crate::support::base;
use fc_diff::{FileDiff, FileVersion, Lang, Packages, ProjectSpec, file_diff};
use fc_spec::source::Sources;
use std::path::Path;
use tempfile::TempDir;

/// The object id of a file that git does not have.
const NO_OBJECT: &str = "0000000000000000000000000000000000000000";

/// Writes a spec to a new directory.
fn project(sources: &Sources) -> TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    for (_, file) in sources.iter() {
        let path = directory.path().join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("written");
        std::fs::write(path, &file.text).expect("written");
    }
    directory
}

/// Compares the first file that has `from` with the same file with `to` instead.
fn changed(from: &str, to: &str) -> Option<FileDiff> {
    let base = base();
    let mut files = base.iter();
    let (_, file) = files
        .find(|(_, file)| file.text.contains(from))
        .expect("such a file");
    let directory = project(&base);
    let spec = ProjectSpec {
        root: directory.path(),
        spec: Path::new("spec"),
        packages: Packages::default(),
    };
    let version = |text| FileVersion {
        path: file.path.clone(),
        text: Some(text),
        object: NO_OBJECT,
    };
    let after = file.text.replacen(from, to, 1);
    file_diff(spec, [&version(&file.text), &version(&after)], "2027-01-01")
}

#[test]
fn changed_port_is_described() {
    let diff =
        changed("command: { number: 4000,", "command: { number: 4002,").expect("two versions");
    assert!(!diff.findings.is_empty());
    assert!(diff.text(Lang::En).starts_with("FC07"));
}

#[test]
fn comment_has_no_effect() {
    let diff = changed("\ncommands:\n", "\n# A remark.\ncommands:\n").expect("two versions");
    assert!(diff.findings.is_empty());
    assert_eq!(diff.text(Lang::En), "");
}

#[test]
fn invalid_file_has_no_description() {
    assert!(changed("\ncommands:\n", "\ncommands: [\n").is_none());
}
