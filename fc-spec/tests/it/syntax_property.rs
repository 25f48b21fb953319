//! Property tests of the parser. No input causes a panic, and every span lies inside the file and inside its parent.

use crate::syntax_support;
use std::path::Path;
use std::sync::LazyLock;

use fc_spec::diagnostic::{Format, render, summary};
use fc_spec::model::Lang;
use fc_spec::source::{Sources, Span};
use fc_spec::syntax::{Node, NodeKind, Style};
use proptest::prelude::*;

/// The spec's own files and the fixtures.
static SEEDS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../spec");
    [
        spec.clone(),
        spec.join("commands"),
        syntax_support::fixtures(),
    ]
    .iter()
    .flat_map(|directory| syntax_support::files(directory, "yaml"))
    .map(|path| std::fs::read(path).expect("a seed"))
    .collect()
});

/// Tokens that matter to a YAML parser.
const TOKENS: &[&str] = &[
    ":",
    ": ",
    "- ",
    "? ",
    "[",
    "]",
    "{",
    "}",
    ",",
    "\n",
    "\n  ",
    "\n    ",
    "\r\n",
    "\t",
    " ",
    "#",
    " #",
    "'",
    "\"",
    "\\",
    "|",
    ">",
    "|-\n",
    ">+\n",
    "&a ",
    "*a",
    "!t ",
    "<<: ",
    "---\n",
    "...\n",
    "%YAML 1.2\n",
    "~",
    "null",
    "\u{feff}",
    "\u{202e}",
    "回充",
    "a",
    "a: 1\n",
    "0x0A01",
    "\0",
];

fn mutated() -> impl Strategy<Value = Vec<u8>> {
    let edit = (
        any::<prop::sample::Index>(),
        0..40usize,
        any::<prop::sample::Index>(),
    );
    (
        any::<prop::sample::Index>(),
        prop::collection::vec(edit, 1..6),
    )
        .prop_map(|(seed, edits)| {
            let mut bytes = seed.get(&SEEDS).clone();
            for (at, delete, token) in edits {
                let start = at.index(bytes.len() + 1);
                let end = (start + delete).min(bytes.len());
                bytes.splice(start..end, token.get(TOKENS).bytes());
            }
            bytes
        })
}

fn tokens() -> impl Strategy<Value = String> {
    prop::collection::vec(prop::sample::select(TOKENS), 0..60).prop_map(|words| words.concat())
}

fn check(bytes: &[u8]) {
    let (sources, mut faults) = syntax_support::read(&[("a.yaml", bytes)]);
    let trees = syntax_support::parse_all(&sources, &mut faults);
    for tree in trees.iter().flatten() {
        check_node(tree.root(), &sources);
    }
    for fault in &faults {
        let labels = fault.secondary.iter().map(|label| label.span);
        let fixes = fault.fixes.iter().map(|fix| fix.span);
        for span in labels.chain(fixes).chain([fault.primary.span]) {
            check_span(span, &sources);
        }
    }
    assert_eq!(summary(&faults, Lang::En).is_none(), faults.is_empty());
    for format in [
        Format::Colored,
        Format::Text,
        Format::Json,
        Format::Sarif,
        Format::Github,
    ] {
        let shown = render(&faults, &sources, format, Lang::En);
        assert!(faults.is_empty() || shown.contains("a.yaml"));
    }
}

fn check_span(span: Span, sources: &Sources) {
    let text = &sources.get(span.file).expect("a file").text;
    assert!(text.get(span.start..span.end).is_some(), "{span:?}");
}

fn check_node(node: Node<'_>, sources: &Sources) {
    check_span(node.span(), sources);
    match node.kind() {
        NodeKind::Null => {}
        NodeKind::Scalar(scalar) => {
            let spelled = sources.slice(node.span());
            if scalar.style == Style::Plain && !spelled.contains(['\n', '\r']) {
                assert_eq!(spelled, scalar.text);
            }
        }
        NodeKind::Sequence(items) => {
            for item in items {
                assert!(
                    within(item.span(), node.span()),
                    "{item:?} in {:?}",
                    node.span()
                );
                check_node(item, sources);
            }
        }
        NodeKind::Mapping(entries) => {
            for entry in entries {
                assert!(
                    within(entry.span(), node.span()),
                    "{entry:?} in {:?}",
                    node.span()
                );
                assert!(entry.key.span().end <= entry.value.span().start);
                check_node(entry.key, sources);
                check_node(entry.value, sources);
            }
        }
    }
}

fn within(inner: Span, outer: Span) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        check(&bytes);
    }

    #[test]
    fn arbitrary_text(text in "\\PC{0,80}") {
        check(text.as_bytes());
    }

    #[test]
    fn arbitrary_tokens(text in tokens()) {
        check(text.as_bytes());
    }

    #[test]
    fn mutated_specs(bytes in mutated()) {
        check(&bytes);
    }
}
