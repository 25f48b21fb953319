//! The small spec without errors in `good/`.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use std::fs;
use std::path::Path;

/// Paths of its files below the spec's folder.
pub const FILES: [&str; 2] = ["protocol.yaml", "commands/demo.yaml"];

/// Returns a file of `fc-spec/tests/`.
pub fn read(path: impl AsRef<Path>) -> String {
    // Tests of other crates include this module, so the path names this crate.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-spec/tests");
    fs::read_to_string(root.join(path)).expect("the file can be read")
}

/// Returns the text of one of its files.
pub fn file(path: &str) -> String {
    read(Path::new("good").join(path))
}

/// Returns its model.
pub fn model() -> Model {
    let sources = Sources::from_texts(FILES.map(|path| (format!("spec/{path}"), file(path))));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    assert!(
        faults.is_empty(),
        "{}",
        render(&faults, &sources, Format::Text, Lang::En)
    );
    model.expect("a spec without faults has a model")
}
