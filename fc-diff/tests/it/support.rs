//! The spec that the tests change, and the changes of `edits.txt`.

use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use std::path::{Path, PathBuf};

/// A change of the spec.
pub struct Edit {
    /// The title of the change.
    pub name: String,
    /// The file, relative to the directory of the spec.
    pub file: String,
    /// The lines to replace, and their replacement.
    pub texts: [String; 2],
    /// The findings from the base spec to the changed one, and those of the way back.
    pub found: [Vec<String>; 2],
}

/// Returns the path of the changes.
pub fn edits_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/edits.txt")
}

/// Returns the text above the changes, and the changes.
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

/// Additions to that spec, each with the text before it. The changes need bytes, a time in a body, a spare enum value
/// and a closed enum. They also need a second entity with numeric IDs and a second user of each coordinate system.
const MORE: [[&str; 2]; 6] = [
    [
        "picture: { type: \"base64?\", length: [1, 8],",
        " example: \"AQID\",",
    ],
    [
        "en: x coordinate }\n",
        "      moved: { type: \"timestamp_ms?\", example: 1000, zh: 移动时间, en: When it was moved }
  Corner:
    zh: 角落
    en: A corner
    coordinates: room
    fields:
      y: { type: f32, unit: m, example: 1.5, zh: y 坐标, en: y coordinate }
  Tone:
    enum: string
    closed: true
    zh: 色温
    en: Tone
    values:
      warm: { name: warm, zh: 暖, en: Warm }
      cold: { name: cold, zh: 冷, en: Cold }\n",
    ],
    [
        "zh: 损坏, en: Broken }\n",
        "      9: { name: spare, error: true, zh: 备用, en: Spare }\n",
    ],
    [
        "person: { zh: 操作者, en: Operator }\n",
        "  shade: { zh: 灯罩, en: Shade }\n",
    ],
    [
        "zh: 其他场景的 ID, en: IDs of the other scenes }\n",
        "      shade: { type: \"u32?\", refers: shade, example: 9, zh: 灯罩 ID, en: ID of the shade }
      corner: { type: \"Corner?\", zh: 角落, en: Corner }
      beam: { type: \"Spot?\", coordinates: beam, zh: 光束, en: Beam }
      tone: { type: \"Tone?\", zh: 色温, en: Tone }\n",
    ],
    [
        "lux: { type: f64, unit: \"%\", example: 0.5, zh: 光强, en: Glow }\n",
        "      hue: { type: \"u16?\", example: 20, zh: 色相, en: Hue }\n",
    ],
];

/// Returns the files of the spec, with the additions.
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

/// Builds the model of a spec. The error is the rendered list of diagnostics.
pub fn model(sources: &Sources) -> Result<Model, String> {
    let mut faults = Faults::new();
    let loaded = load(sources, &mut faults);
    loaded
        .model()
        .ok_or_else(|| render(&faults, sources, Format::Text, Lang::En))
}

/// Replaces a string that occurs once in a file.
pub fn with(sources: &Sources, file: &str, from: &str, to: &str) -> Sources {
    let path = format!("spec/{file}");
    Sources::from_texts(sources.iter().map(|(_, file)| {
        let text = if file.path == path {
            assert_eq!(file.text.matches(from).count(), 1, "{from}");
            file.text.replace(from, to)
        } else {
            file.text.clone()
        };
        (file.path.clone(), text)
    }))
}

impl Edit {
    /// Returns the spec with the change.
    pub fn apply(&self, sources: &Sources) -> Sources {
        let [from, to] = &self.texts;
        with(sources, &self.file, from, to)
    }
}
