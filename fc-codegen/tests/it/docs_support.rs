//! Helpers for the tests of pages, vectors and samples.

use fc_codegen::product::Artifact;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::syntax::read_dir;
use std::path::{Path, PathBuf};

/// Returns a project whose `spec/` uses every part of the language once.
pub fn fixture() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/docs")
}

/// Returns the root of this project.
pub fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the model of a project's spec, which must have no errors.
pub fn model(root: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    let model = load(&sources, &mut faults).model();
    let shown = render(&faults, &sources, Format::Text, Lang::En);
    model.unwrap_or_else(|| panic!("{shown}"))
}

/// Returns the contents of the artifact with this path.
pub fn artifact<'a>(artifacts: &'a [Artifact], path: &str) -> &'a str {
    let found = artifacts.iter().find(|artifact| artifact.path == path);
    &found
        .unwrap_or_else(|| panic!("{path} is not made"))
        .contents
}

/// Compares with a golden file. `BLESS=1` in the environment writes the file first.
pub fn golden(name: &str, actual: &str) {
    let path = fixture().join("golden").join(name);
    if std::env::var_os("BLESS").is_some() {
        let directory = path.parent().expect("a golden file lies in a directory");
        std::fs::create_dir_all(directory).expect("the directory can be made");
        std::fs::write(&path, actual).expect("the golden file can be written");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let diff = similar::TextDiff::from_lines(expected.as_str(), actual);
    assert!(
        expected == actual,
        "{} differs; run the test with BLESS=1 and read the diff\n{}",
        path.display(),
        diff.unified_diff(),
    );
}
