//! The versions of packages.

use crate::good_spec;
use fc_codegen::inspect::fingerprint;
use fc_codegen::version::{Ecosystem, Edition};
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;

#[test]
fn version_has_the_form_of_its_ecosystem() {
    let release = |number: &str| Edition::Release(number.to_owned());
    let draft = || Edition::Draft("0123456789ab".to_owned());
    for (ecosystem, edition, expected) in [
        (Ecosystem::Cargo, release("2024.09"), "0.2.0+2024.9"),
        (Ecosystem::Npm, release("2024.09"), "0.2.0+2024.9"),
        (Ecosystem::Python, release("2024.09"), "0.2.0+2024.9"),
        (Ecosystem::Maven, release("2024.09"), "0.2.0-2024.9"),
        (Ecosystem::Debian, release("2024.09"), "0.2.0+2024.9"),
        (Ecosystem::Python, release("2.00.10"), "0.2.0+2.0.10"),
        (Ecosystem::Cargo, draft(), "0.2.0-dev.x0123456789ab"),
        (Ecosystem::Npm, draft(), "0.2.0-dev.x0123456789ab"),
        (Ecosystem::Python, draft(), "0.2.0.dev0+x0123456789ab"),
        (Ecosystem::Maven, draft(), "0.2.0-alpha-x0123456789ab"),
        (Ecosystem::Debian, draft(), "0.2.0~dev.x0123456789ab"),
    ] {
        assert_eq!(edition.version(ecosystem, "0.2.0"), expected);
    }
}

/// Returns the model of the good spec after a change of its files.
fn model(change: impl Fn(String) -> String) -> Model {
    let files =
        good_spec::FILES.map(|path| (format!("spec/{path}"), change(good_spec::file(path))));
    let sources = Sources::from_texts(files);
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

#[test]
fn fingerprint_ignores_lines_but_no_text() {
    let before = fingerprint(&model(|text| text));
    assert_eq!(before.len(), 12, "{before}");
    let moved = model(|text| format!("# A comment.\n\n{text}"));
    assert_eq!(fingerprint(&moved), before);
    let worded = model(|text| text.replacen("  en: ", "  en: Other ", 1));
    assert_ne!(fingerprint(&worded), before);
}
