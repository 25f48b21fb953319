//! The tree of every spec file equals the value that another YAML reader gives.

use crate::syntax_support;
use std::path::Path;

use fc_spec::syntax::{Node, NodeKind, Style};
use serde_yaml::Value;

/// Resolves plain scalars by the YAML core schema. The tree keeps them as spelled.
fn value(node: Node<'_>) -> Value {
    match node.kind() {
        NodeKind::Null => Value::Null,
        NodeKind::Scalar(scalar) if scalar.style == Style::Plain => {
            serde_yaml::from_str(scalar.text).expect("a plain scalar")
        }
        NodeKind::Scalar(scalar) => Value::String(scalar.text.to_owned()),
        NodeKind::Sequence(items) => Value::Sequence(items.map(value).collect()),
        NodeKind::Mapping(entries) => Value::Mapping(
            entries
                .map(|entry| (value(entry.key), value(entry.value)))
                .collect(),
        ),
    }
}

#[test]
fn every_spec_file_reads_the_same() {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../spec");
    let mut paths = syntax_support::files(&spec, "yaml");
    paths.extend(syntax_support::files(&spec.join("commands"), "yaml"));
    assert!(!paths.is_empty());
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a spec file");
        let (_, tree, faults) = syntax_support::parse_text(&text);
        assert!(faults.is_empty(), "{}: {faults:?}", path.display());
        let tree = tree.expect("a tree");
        let expected: Value = serde_yaml::from_str(&text).expect("YAML");
        assert_eq!(value(tree.root()), expected, "{}", path.display());
    }
}

#[test]
fn every_form_of_scalar_reads_the_same() {
    for text in [
        "a: |\n  x\n   y\n\n  z\nb: 1\n",
        "a: |+\n  x\n\n\nb: 1\n",
        "a: >-\n  x\n  y\n\n  z\n",
        "a: |2\n    x\n",
        "a: 'it''s'\nb: \"\\u56de\\n\\x41\\\n  c\"\n",
        "a: x\n  y\n  z\n",
        "a:\n- 1\n-\n- - 2\n  - 3\nb:\n",
        "{a: [1, {b: }, ], \"c\":d, e}",
        "[a: 1, b]",
        "---\na: ~\nb: null\nc: \"\"\nd: ''\n",
        "? a\n: b\n? c\n",
        "a: 0x0A01\nb: -1.5e3\nc: true\nd: .inf\ne: 0o17\nf: 2024-01\n",
        "a: x#y\nb: x #y\nc: '#'\n",
        "a: |\r\n  x\r\n  y\r\nb: \"x\r\n  y\"\r\n",
    ] {
        let (_, tree, faults) = syntax_support::parse_text(text);
        assert!(faults.is_empty(), "{text:?}: {faults:?}");
        let expected: Value = serde_yaml::from_str(text).expect("YAML");
        assert_eq!(value(tree.expect("a tree").root()), expected, "{text:?}");
    }
}
