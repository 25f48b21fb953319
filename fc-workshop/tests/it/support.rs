//! The small spec of `fc-reflect`.

use fc_spec::diagnostic::Faults;
use fc_spec::load::load;
use fc_spec::model::Model;
use fc_spec::source::Sources;

const FILES: [(&str, &str); 2] = [
    (
        "spec/protocol.yaml",
        include_str!("../../../fc-reflect/tests/small/protocol.yaml"),
    ),
    (
        "spec/commands/lamp.yaml",
        include_str!("../../../fc-reflect/tests/small/commands/lamp.yaml"),
    ),
];

/// Returns the model of the small spec, with further text in the file of its commands.
pub fn model(change: impl Fn(String) -> String) -> Model {
    let files = FILES.map(|(path, text)| (path, change(text.to_owned())));
    let mut faults = Faults::new();
    let model = load(&Sources::from_texts(files), &mut faults).model();
    model.unwrap_or_else(|| panic!("{faults:?}"))
}

/// Returns the model of the small spec.
pub fn small() -> Model {
    model(|text| text)
}
