//! Files that exceed a limit. Each gives an error, within bounded time and memory.

use crate::syntax_support;
use std::fmt::Write as _;

use fc_spec::model::Lang;
use fc_spec::syntax::limits;

fn codes(text: &str) -> Vec<&'static str> {
    syntax_support::codes(&syntax_support::parse_text(text).2)
}

#[test]
fn deep_nesting() {
    for opening in ["[", "{a: ", "- ", "? ", "[{", "[ [\n"] {
        assert_eq!(codes(&opening.repeat(20_000)), ["FC0020"], "{opening:?}");
    }
    let mut text = String::new();
    for depth in 0..20_000 {
        let _ = writeln!(text, "{:1$}a:", "", depth.min(200));
    }
    assert_eq!(codes(&text), ["FC0020"]);
}

#[test]
fn nesting_up_to_the_limit() {
    let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(codes(&nested(limits::DEPTH)).is_empty());
    assert_eq!(codes(&nested(limits::DEPTH + 1)), ["FC0020"]);
}

#[test]
fn alias_bomb() {
    let mut text = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n".to_owned();
    for level in 1..10 {
        let aliases = vec![format!("*a{}", level - 1); 9].join(", ");
        let _ = writeln!(text, "a{level}: &a{level} [{aliases}]");
    }
    let (_, tree, faults) = syntax_support::parse_text(&text);
    assert!(tree.is_none());
    assert_eq!(faults.len(), 10 + 9 * 9);
    assert!(
        faults
            .iter()
            .all(|fault| matches!(fault.code.as_str(), "FC0014" | "FC0015"))
    );
}

#[test]
fn long_scalar() {
    for (open, close) in [("", ""), ("'", "'"), ("\"", "\""), ("|\n  ", "")] {
        let text = |length| format!("a: {open}{}{close}\nb: 1\nb: 2\n", "x".repeat(length));
        assert_eq!(
            codes(&text(limits::SCALAR_BYTES + 1)),
            ["FC0021", "FC0012"],
            "{open:?}"
        );
        assert_eq!(
            codes(&text(limits::SCALAR_BYTES - 1)),
            ["FC0012"],
            "{open:?}"
        );
    }
}

#[test]
fn many_nodes() {
    let text = format!("[{}]", "0,".repeat(limits::NODES + 1));
    assert_eq!(codes(&text), ["FC0022"]);
}

#[test]
fn many_faults_are_counted_not_kept() {
    let text = "a: 1\n".repeat(300_000);
    let (sources, tree, faults) = syntax_support::parse_text(&text);
    assert_eq!(tree.map(|tree| tree.root().entries().count()), Some(1));
    assert_eq!(faults.errors(), 299_999);
    assert!(faults.len() < 2000);
    assert_eq!(faults.len() + faults.omitted(), faults.errors());
    let summary = fc_spec::diagnostic::summary(&faults, Lang::En).unwrap_or_default();
    assert!(summary.starts_with("error: 299999 errors in 1 file, the first 1000 of them shown"));
    drop(sources);
}

/// One line of eight megabytes. No format prints it, and none takes minutes for it.
#[test]
fn long_line() {
    let text = format!("{{{}}}", "a: 1, ".repeat(limits::FILE_BYTES / 6 - 1));
    let (sources, _, faults) = syntax_support::parse_text(&text);
    for format in [
        fc_spec::diagnostic::Format::Text,
        fc_spec::diagnostic::Format::Json,
        fc_spec::diagnostic::Format::Sarif,
        fc_spec::diagnostic::Format::Github,
    ] {
        let shown = fc_spec::diagnostic::render(&faults, &sources, format, Lang::En);
        assert!(shown.len() < 2 << 20, "{format:?}");
    }
}

#[test]
fn long_text_given_directly() {
    let text = "x".repeat(limits::FILE_BYTES + 1);
    assert_eq!(codes(&text), ["FC0003"]);
}

#[test]
fn many_files() {
    let names: Vec<_> = (0..limits::FILES + 2)
        .map(|index| format!("f{index:05}.yaml"))
        .collect();
    let files: Vec<_> = names
        .iter()
        .map(|name| (name.as_str(), b"a: 1\n".as_slice()))
        .collect();
    let (sources, mut faults) = syntax_support::read(&files);
    let trees = syntax_support::parse_all(&sources, &mut faults);
    assert_eq!(trees.len(), limits::FILES);
    assert_eq!(syntax_support::codes(&faults), ["FC0003"]);
}

#[test]
fn many_bytes_in_many_files() {
    let comment = vec![b'#'; limits::FILE_BYTES];
    let root = tempfile::tempdir().expect("a directory for the test");
    let spec = root.path().join("spec");
    std::fs::create_dir(&spec).expect("the spec's directory");
    for index in 0..=limits::SPEC_BYTES / limits::FILE_BYTES {
        std::fs::write(spec.join(format!("f{index}.yaml")), &comment).expect("a file of the spec");
    }
    let mut faults = fc_spec::diagnostic::Faults::new();
    fc_spec::syntax::read_dir(root.path(), "spec".as_ref(), &mut faults);
    assert_eq!(syntax_support::codes(&faults), ["FC0003"]);
}
