//! The content and the files of generated Python. Tests of the package itself check its format and its types, because
//! they need Python.

use crate::good_spec;
use fc_codegen::emit::python;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;
use std::collections::HashMap;
use std::fs;
use std::path::Path;

/// Returns the good spec with another file of commands.
fn with(text: &str) -> Model {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/more.yaml".to_owned(), text.to_owned());
    model(&Sources::from_texts(good.into_iter().chain([more])))
}

fn model(sources: &Sources) -> Model {
    let mut faults = Faults::new();
    let model = load(sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, sources, Format::Text, Lang::En)))
}

fn files(model: &Model) -> HashMap<String, String> {
    let files = python::emit(model, &Targets::default()).into_iter();
    let path = |path: String| path.trim_start_matches("stubs/python/").to_owned();
    files.map(|it| (path(it.path), it.contents)).collect()
}

/// Comments at the top of each fixture in `python/` list the expected text and its file: `# in src/demo/client.py: …`.
#[test]
fn fixtures_are_generated_as_expected() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let mut count = 0;
    let mut missing = Vec::new();
    for entry in fs::read_dir(folder).expect("the fixtures") {
        let path = entry.expect("an entry").path();
        let text = fs::read_to_string(&path).expect("a fixture");
        let files = files(&with(&text));
        for line in text.lines().filter_map(|line| line.strip_prefix("# in ")) {
            let (file, expected) = line.split_once(": ").expect("a file and what is in it");
            let contents = files.get(file).map_or("", String::as_str);
            if !contents.contains(expected) {
                missing.push(format!("{} in {file}: {expected}", path.display()));
            }
            count += 1;
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(count > 30, "{count}");
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let model = good_spec::model();
    let emit = || python::emit(&model, &Targets::default());
    assert_eq!(emit(), emit());
}

/// Comments state facts about behaviour that no type can express.
#[test]
fn comments_state_facts_without_a_type() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-generated/tests/meter");
    let mut faults = Faults::new();
    let sources = read_dir(&root, Path::new("spec"), &mut faults);
    let all: String = files(&model(&sources)).into_values().collect();
    for said in [
        "In the coordinate system `panel`.",
        "Kept in `memory`.",
        "Present only when `switch` is `Switch.STUCK`.",
        "Valid only when `switch` is `Switch.CLOSING` or `Switch.CLOSED`.",
        "Only for `installer_app`. Only in `firmware` until 3.",
        "Accepted only when `Switch` is `\"open\"` or `\"stuck\"`.",
        "Sent every 1000 ms.",
        "Carries `application/json`. Started by `watch_load`. Stopped by `watch_load`.",
    ] {
        assert!(all.contains(said), "{said}");
    }
}
