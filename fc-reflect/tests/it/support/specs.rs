//! Models of the project's spec, of the small protocol of these tests and of other protocols.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the project's root.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap().to_owned()
}

/// Returns the model of the project's own spec, to which the committed vectors belong.
pub fn model() -> Model {
    model_below(&root())
}

/// Returns the model of the spec in `root`.
pub fn model_below(root: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    loaded(&sources, faults)
}

/// The header and envelope of the small protocol.
pub const SMALL: &str = include_str!("../../small/protocol.yaml");

/// Returns the model of the small protocol.
pub fn small() -> Model {
    model_of(SMALL, include_str!("../../small/commands/lamp.yaml"))
}

/// Returns the models of protocols that have little in common with the project's spec.
pub fn others() -> [Model; 5] {
    let good = |file| fs::read_to_string(root().join("fc-spec/tests/good").join(file)).unwrap();
    let good = model_of(&good("protocol.yaml"), &good("commands/demo.yaml"));
    let below = |name| model_below(&root().join("fc-generated/tests").join(name));
    [small(), good, below("odd"), below("meter"), below("beacon")]
}

/// Returns the model of a protocol with one group.
pub fn model_of(protocol: &str, commands: &str) -> Model {
    let files = [
        ("spec/protocol.yaml", protocol),
        ("spec/commands/lamp.yaml", commands),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    loaded(&Sources::from_texts(files), Faults::new())
}

fn loaded(sources: &Sources, mut faults: Faults) -> Model {
    let model = load(sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, sources, Format::Text, Lang::En)))
}
