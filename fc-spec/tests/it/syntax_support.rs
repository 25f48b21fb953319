//! Helpers that the tests of the syntax share.

use std::path::{Path, PathBuf};

use fc_spec::diagnostic::Faults;
use fc_spec::source::{FileId, Sources};
use fc_spec::syntax::{Tree, parse, read_dir};

/// Returns the directory of the malformed files.
pub fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/adversarial")
}

/// Returns the files of a directory with this extension, sorted.
pub fn files(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(directory)
        .expect("the directory exists")
        .map(|entry| entry.expect("the entry can be read").path())
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    files.sort();
    files
}

/// Writes files with these names and bytes to a disk, and reads them as a spec.
pub fn read(files: &[(&str, &[u8])]) -> (Sources, Faults) {
    let root = tempfile::tempdir().expect("a directory for the test");
    let spec = root.path().join("spec");
    std::fs::create_dir_all(spec.join("commands")).expect("the spec's directories");
    for (name, bytes) in files {
        std::fs::write(spec.join(name), bytes).expect("a file of the spec");
    }
    let mut faults = Faults::new();
    let sources = read_dir(root.path(), Path::new("spec"), &mut faults);
    (sources, faults)
}

/// Parses the files that were read whole. Returns their trees, and sorts all errors.
pub fn parse_all<'s>(sources: &'s Sources, faults: &mut Faults) -> Vec<Option<Tree<'s>>> {
    let trees = sources
        .iter()
        .filter(|(_, file)| file.whole)
        .map(|(id, file)| parse(id, &file.text, faults))
        .collect();
    faults.sort();
    trees
}

/// Parses a text. Returns its tree and its errors.
pub fn parse_text(text: &str) -> (Sources, Option<Tree<'_>>, Faults) {
    let sources = Sources::from_texts([("spec/test.yaml", text)]);
    let mut faults = Faults::new();
    let tree = parse(FileId(0), text, &mut faults);
    faults.sort();
    (sources, tree, faults)
}

/// Returns the codes of the errors, in order.
pub fn codes(faults: &Faults) -> Vec<&'static str> {
    faults.iter().map(|fault| fault.code.as_str()).collect()
}

/// Compares with a golden file. With `BLESS=1` in the environment, writes it first.
pub fn golden(path: &Path, actual: &str) {
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, actual).expect("the golden file can be written");
    }
    let expected = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        expected == actual,
        "{} differs; run the test with BLESS=1 and read the diff\n--- expected\n{expected}\n--- actual\n{actual}",
        path.display(),
    );
}
