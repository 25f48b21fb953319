//! Models and bytes for the tests.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap().to_owned()
}

/// The model of the spec in a directory.
pub fn model_in(root: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    loaded(&sources, faults)
}

/// A small protocol with another byte order, header and envelope than that of the repository.
pub fn small() -> Model {
    small_with(str::to_owned)
}

/// The small protocol, with changed files.
pub fn small_with(change: impl Fn(&str) -> String) -> Model {
    let files = [
        (
            "spec/protocol.yaml",
            include_str!("../../../../fc-reflect/tests/small/protocol.yaml"),
        ),
        (
            "spec/commands/lamp.yaml",
            include_str!("../../../../fc-reflect/tests/small/commands/lamp.yaml"),
        ),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), change(text)));
    loaded(&Sources::from_texts(files), Faults::new())
}

/// The model of a spec without errors.
pub fn loaded(sources: &Sources, mut faults: Faults) -> Model {
    let model = load(sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, sources, Format::Text, Lang::En)))
}

pub fn unhex(text: &str) -> Vec<u8> {
    let digit = |at: usize| u8::from_str_radix(&text[at..at + 2], 16).unwrap();
    (0..text.len()).step_by(2).map(digit).collect()
}

/// Random numbers (`SplitMix64`), the same in each run.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.next() % (end as u64)).unwrap()
    }
}
