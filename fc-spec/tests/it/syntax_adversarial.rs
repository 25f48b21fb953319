//! Malformed files, `adversarial/*.yaml`, and the errors of each in the `*.txt` next to it.

use crate::both_languages;
use crate::syntax_support;
use std::path::Path;

use fc_spec::diagnostic::{Faults, Format, render, summary};
use fc_spec::model::Lang;
use fc_spec::syntax::read_dir;

#[test]
fn every_fixture_has_its_faults() {
    for path in syntax_support::files(&syntax_support::fixtures(), "yaml") {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a name");
        let bytes = std::fs::read(&path).expect("the fixture can be read");
        let (sources, mut faults) = syntax_support::read(&[(name, &bytes)]);
        let trees = syntax_support::parse_all(&sources, &mut faults);
        let objections = both_languages::objections(name, &faults);
        assert!(objections.is_empty(), "{}", objections.join("\n"));
        let text = render(&faults, &sources, Format::Text, Lang::En);
        let tree = if trees.iter().any(Option::is_some) {
            "a tree"
        } else {
            "no tree"
        };
        let summary = summary(&faults, Lang::En).unwrap_or_else(|| "no fault".to_owned());
        syntax_support::golden(
            &path.with_extension("txt"),
            &format!("{text}{summary}\n{tree}\n"),
        );
    }
}

/// Wide characters shift no caret and no column in any format.
#[test]
fn columns_are_characters_in_every_format() {
    let path = syntax_support::fixtures().join("cjk.yaml");
    let bytes = std::fs::read(&path).expect("the fixture can be read");
    let (sources, mut faults) = syntax_support::read(&[("cjk.yaml", &bytes)]);
    syntax_support::parse_all(&sources, &mut faults);
    for (format, lang, extension) in [
        (Format::Colored, Lang::En, "ansi"),
        (Format::Json, Lang::En, "jsonl"),
        (Format::Sarif, Lang::En, "sarif"),
        (Format::Github, Lang::En, "github"),
        (Format::Text, Lang::Zh, "zh.txt"),
        (Format::Colored, Lang::Zh, "zh.ansi"),
        (Format::Json, Lang::Zh, "zh.jsonl"),
        (Format::Sarif, Lang::Zh, "zh.sarif"),
        (Format::Github, Lang::Zh, "zh.github"),
    ] {
        let actual =
            render(&faults, &sources, format, lang).replace(env!("CARGO_PKG_VERSION"), "VERSION");
        syntax_support::golden(&path.with_extension(extension), &actual);
    }
}

/// A spec with many broken files shows the errors of all of them in one run.
#[test]
fn all_files_in_one_run() {
    let (sources, mut faults) = syntax_support::read(&[
        ("a.yaml", b"a: [\n"),
        ("b.yaml", b"\xff"),
        ("c.yml", b"a: 1\n"),
        ("commands/d.yaml", b"a: 1\na: 2\n"),
        ("commands/e.yaml", b"a: 1\n"),
        (".hidden.yaml", b"a: ["),
    ]);
    let trees = syntax_support::parse_all(&sources, &mut faults);
    let codes = syntax_support::codes(&faults);
    assert_eq!(codes, ["FC0008", "FC0002", "FC0004", "FC0012"]);
    assert_eq!(trees.iter().filter(|tree| tree.is_some()).count(), 2);
}

#[test]
fn a_spec_that_is_not_there_is_a_fault() {
    let root = tempfile::tempdir().expect("a directory for the test");
    let mut faults = Faults::new();
    read_dir(root.path(), Path::new("spec"), &mut faults);
    assert_eq!(syntax_support::codes(&faults), ["FC0001"]);
}

#[test]
fn files_that_the_spec_does_not_look_for_are_faults() {
    let root = tempfile::tempdir().expect("a directory for the test");
    let spec = root.path().join("spec");
    for (path, text) in [
        ("a.yaml", "a: 1\n"),
        ("b.YAML", ""),
        ("c.json", "[1"),
        ("commands/d.yml", ""),
        // A directory with the name of a spec file.
        ("commands/map.yaml/x.yaml", ""),
        ("drafts/e.yaml", ""),
        ("drafts/notes.md", ""),
        (".git/f.yaml", ""),
    ] {
        let path = spec.join(path);
        std::fs::create_dir_all(path.parent().expect("a directory")).expect("its directory");
        std::fs::write(path, text).expect("a file");
    }
    let mut faults = Faults::new();
    let sources = read_dir(root.path(), Path::new("spec"), &mut faults);
    assert_eq!(syntax_support::codes(&faults), ["FC0004"; 4]);
    let whole = sources
        .iter()
        .filter(|(_, file)| file.whole)
        .map(|(_, file)| file.path.as_str());
    assert_eq!(whole.collect::<Vec<_>>(), ["spec/a.yaml"]);

    // An absolute path to the spec finds the same files.
    let mut faults = Faults::new();
    let sources = read_dir(Path::new("/nowhere"), &spec, &mut faults);
    let paths = sources.iter().map(|(_, file)| file.path.clone());
    assert_eq!(paths.count(), 5);
}

/// Only regular files are opened. A pipe could block forever, and a device may have no end.
#[cfg(unix)]
#[test]
fn links_are_followed_to_files_only() {
    let root = tempfile::tempdir().expect("a directory for the test");
    let spec = root.path().join("spec");
    std::fs::create_dir(&spec).expect("a directory");
    std::fs::write(root.path().join("outside"), "a: 1\n").expect("a file");
    for (link, target) in [
        ("a.yaml", "../outside"),
        ("b.yaml", "nowhere"),
        ("c.yaml", "/dev/zero"),
        ("loop", "."),
    ] {
        std::os::unix::fs::symlink(target, spec.join(link)).expect("a link");
    }
    let mut faults = Faults::new();
    let sources = read_dir(root.path(), Path::new("spec"), &mut faults);
    let codes = syntax_support::codes(&faults);
    assert_eq!(
        codes.iter().filter(|code| **code == "FC0001").count(),
        2,
        "{codes:?}"
    );
    assert!(
        sources
            .iter()
            .any(|(_, file)| file.path == "spec/a.yaml" && file.whole)
    );
}

/// Fixes do what they promise: applied one after another, they remove their errors.
#[test]
fn fixes_mend() {
    for (name, code) in [("tabs.yaml", "FC0009"), ("control.yaml", "FC0006")] {
        let path = syntax_support::fixtures().join(name);
        let mut text = std::fs::read_to_string(path).expect("the fixture can be read");
        for _ in 0..10 {
            let (_, _, faults) = syntax_support::parse_text(&text);
            let fixes = faults.iter().flat_map(|fault| &fault.fixes);
            let Some(fix) = fixes.last() else { break };
            text.replace_range(fix.span.start..fix.span.end, &fix.replacement);
        }
        let (_, _, faults) = syntax_support::parse_text(&text);
        assert!(
            !syntax_support::codes(&faults).contains(&code),
            "{name}: {text}"
        );
    }
}
