//! The spec that the tests change, and the changes.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::syntax::{Sources, read_dir};
use std::path::{Path, PathBuf};

/// A change of the spec.
pub struct Edit {
    /// What it is.
    pub name: String,
    /// The file, below the spec's directory.
    pub file: String,
    /// What stands there, and what is to stand there.
    pub texts: [String; 2],
    /// What is found from the spec as it is to the changed one, and back.
    pub found: [Vec<String>; 2],
}

/// Where the changes are.
pub fn edits_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/edits.txt")
}

/// The changes, and the text above them.
pub fn edits() -> (String, Vec<Edit>) {
    let text = std::fs::read_to_string(edits_path()).expect("the changes");
    let (head, rest) = text.split_once("== ").expect("a first change");
    let edits = rest.split("\n== ").map(|text| {
        let (name, lines) = text.split_once('\n').expect("lines below the name");
        let with = |sign: &str| -> Vec<String> {
            let lines = lines.lines().filter_map(|line| line.strip_prefix(sign));
            lines.map(str::to_owned).collect()
        };
        Edit {
            name: name.to_owned(),
            file: with("@ ").concat(),
            texts: ["-", "+"].map(|sign| with(sign).join("\n")),
            found: ["> ", "< "].map(with),
        }
    });
    (head.to_owned(), edits.collect())
}

/// What that spec lacks and a change needs: bytes that are sent, a time in a body, and a value of an enum that nothing
/// names.
const MORE: [[&str; 2]; 3] = [
    [
        "picture: { type: \"base64?\", length: [1, 8],",
        " example: \"AQID\",",
    ],
    [
        "en: x coordinate }\n",
        "      moved: { type: \"timestamp_ms?\", example: 1000, zh: 移动时间, en: When it was moved }\n",
    ],
    [
        "zh: 损坏, en: Broken }\n",
        "      9: { name: spare, error: true, zh: 备用, en: Spare }\n",
    ],
];

/// The files of the spec.
pub fn base() -> Sources {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-codegen/tests/docs");
    let mut faults = Faults::new();
    let sources = read_dir(&docs, Path::new("spec"), &mut faults);
    assert!(faults.is_empty(), "{faults:#?}");
    Sources::from_texts(sources.iter().map(|(_, file)| {
        let mut text = file.text.clone();
        for [above, more] in MORE {
            text = text.replace(above, &format!("{above}{more}"));
        }
        (file.path.clone(), text)
    }))
}

/// What a spec says.
pub fn model(sources: &Sources) -> Result<Model, String> {
    let mut faults = Faults::new();
    let loaded = load(sources, &mut faults);
    loaded
        .model()
        .ok_or_else(|| render(&faults, sources, Format::Text, Lang::En))
}

impl Edit {
    /// The spec with the change.
    pub fn apply(&self, sources: &Sources) -> Sources {
        let [from, to] = &self.texts;
        let path = format!("spec/{}", self.file);
        Sources::from_texts(sources.iter().map(|(_, file)| {
            let text = if file.path == path {
                assert_eq!(file.text.matches(from).count(), 1, "{}: {from}", self.name);
                file.text.replace(from, to)
            } else {
                file.text.clone()
            };
            (file.path.clone(), text)
        }))
    }
}
