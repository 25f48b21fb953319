//! Loads arbitrary specs and generates all products from the valid ones.
//!
//! Input: files. Each file starts with a line of [`SEPARATOR`](crate::SEPARATOR) and its path. Text before the first
//! such line is `spec/protocol.yaml`.

use fc_codegen::emit::generate;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::source::Sources;

/// Checks that loading returns either a model or errors, and never panics.
///
/// The diagnostics can be rendered in every format. Every product can be generated from a model.
pub fn spec(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let mut files: Vec<(String, String)> = vec![("spec/protocol.yaml".into(), String::new())];
    for line in text.split_inclusive('\n') {
        if let Some(path) = line.strip_prefix(crate::SEPARATOR) {
            files.push((path.trim_end().to_owned(), String::new()));
        } else if let Some((_, text)) = files.last_mut() {
            text.push_str(line);
        }
    }
    if files.first().is_some_and(|(_, text)| text.is_empty()) && files.len() > 1 {
        files.remove(0);
    }
    let sources = Sources::from_texts(files);
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    faults.sort();
    for format in [Format::Text, Format::Json, Format::Sarif, Format::Github] {
        let _ = render(&faults, &sources, format, Lang::En);
    }
    assert_eq!(
        model.is_none(),
        faults.has_errors(),
        "a model and errors, or neither"
    );
    if let Some(model) = model {
        let made = generate(&model, &Targets::default()).expect("no audience is named");
        assert!(!made.is_empty());
    }
}
