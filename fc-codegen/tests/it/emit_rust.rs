//! Generated Rust parses and has the format of rustfmt, for the real spec and for an unusual one.

use fc_codegen::emit::rust;
use fc_codegen::product::Artifact;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::syntax::read_dir;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns folders that contain a `spec`.
fn projects() -> [PathBuf; 2] {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    [root.to_owned(), root.join("fc-generated/tests/odd")]
}

fn model(project: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(project, Path::new("spec"), &mut faults);
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

#[test]
fn every_file_parses() {
    for project in projects() {
        for Artifact { path, contents, .. } in rust::emit(&model(&project), &Targets::default()) {
            if let Err(error) = syn::parse_file(&contents) {
                panic!("{path}: {error}");
            }
        }
    }
}

#[test]
fn rustfmt_has_nothing_to_change() {
    for project in projects() {
        let folder = tempfile::tempdir().unwrap();
        for Artifact { path, contents, .. } in rust::emit(&model(&project), &Targets::default()) {
            // Removes the line that prevents rustfmt from formatting the committed files.
            let (head, rest) = contents
                .split_once("#![cfg_attr(rustfmt, rustfmt_skip)]\n\n")
                .unwrap();
            let place = folder.path().join(path);
            fs::create_dir_all(place.parent().unwrap()).unwrap();
            fs::write(place, format!("{head}{rest}")).unwrap();
        }
        let output = Command::new("rustfmt")
            .args(["--check", "--edition", "2024", "--color", "never"])
            .arg(folder.path().join("fc-generated/src/lib.rs"))
            .output()
            .expect("rustfmt is installed: `rustup component add rustfmt`");
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success(),
            "{text}\n{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    for project in projects() {
        let model = model(&project);
        assert_eq!(
            rust::emit(&model, &Targets::default()),
            rust::emit(&model, &Targets::default())
        );
    }
}

/// Comments state facts about behaviour that no type can express.
#[test]
fn comments_state_facts_without_a_type() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let files = rust::emit(
        &model(&root.join("fc-generated/tests/meter")),
        &Targets::default(),
    );
    let all: String = files.into_iter().map(|it| it.contents).collect();
    for said in [
        "In the coordinate system `panel`.",
        "Kept in `memory`.",
        "Present only when `switch` is `Switch::Stuck`.",
        "Valid only when `switch` is `Switch::Closing` or `Switch::Closed`.",
        "Only for `installer_app`. Only in `firmware` until 3.",
        "Accepted only when `Switch` is `\"open\"` or `\"stuck\"`.",
        "Sent every 1000 ms.",
        "Carries `application/json`. Started by `watch_load`. Stopped by `watch_load`.",
    ] {
        assert!(all.contains(said), "{said}");
    }
}
