//! A file of a hundred megabytes is refused without being read. The test is a separate program, because it measures the
//! memory of the whole process.

#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "tests")]

#[allow(dead_code, reason = "a part of it is used here")]
#[path = "it/syntax_support.rs"]
mod syntax_support;

use std::fs::File;

/// Returns the peak memory of this process so far in KiB, if the system reports it.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse().ok()
}

#[test]
fn hundred_megabytes() {
    let root = tempfile::tempdir().expect("a directory for the test");
    let spec = root.path().join("spec");
    std::fs::create_dir(&spec).expect("the spec's directory");
    let file = File::create(spec.join("huge.yaml")).expect("a file");
    // A sparse file of zeros, which takes no space on the disk.
    file.set_len(100 << 20).expect("its length");
    std::fs::write(spec.join("small.yaml"), "a: 1\na: 2\n").expect("a file");

    let before = peak();
    let mut faults = fc_spec::diagnostic::Faults::new();
    let sources = fc_spec::syntax::read_dir(root.path(), "spec".as_ref(), &mut faults);
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after - before < 10 << 10, "{} KiB", after - before);
    }
    assert_eq!(syntax_support::codes(&faults), ["FC0003"]);
    assert_eq!(sources.iter().filter(|(_, file)| file.whole).count(), 1);
}
