//! The tree keeps all comments, each with the node that it describes.

use fc_spec::diagnostic::Faults;
use fc_spec::source::{FileId, Span};
use fc_spec::syntax::{Node, parse};

const TEXT: &str = "\
# Of the file as a whole.

# Above the first key,
# on two lines.
commands: # behind it
  first: # 一
    code: 0x0A01 # sixteen bits
    text: \"no # comment\"
  # Above the second.
  second: { a: 1, b: 2 } # of the second

  # Far from anything.

  third:
    # Above an item.
    - one # behind an item
    - two
    - long: |
        # a text
      # behind a text
      short: 1
# At the end.
";

fn about<'t>(node: Node<'_>) -> Vec<&'t str> {
    node.comments().map(text).collect()
}

fn text(span: Span) -> &'static str {
    TEXT.get(span.start..span.end).expect("a comment")
}

#[test]
fn comments_belong_to_the_next_or_same_line() {
    let mut faults = Faults::new();
    let tree = parse(FileId(0), TEXT, &mut faults).expect("a tree");
    assert_eq!(faults.len(), 0);
    assert_eq!(
        tree.comments().map(text).collect::<Vec<_>>(),
        [
            "# Of the file as a whole.",
            "# Above the first key,",
            "# on two lines.",
            "# behind it",
            "# 一",
            "# sixteen bits",
            "# Above the second.",
            "# of the second",
            "# Far from anything.",
            "# Above an item.",
            "# behind an item",
            "# behind a text",
            "# At the end.",
        ]
    );
    let commands = tree.root().entry("commands").expect("commands");
    let key = |name: &str| commands.value.entry(name).expect(name).key;
    let first = commands.value.get("first").expect("first");
    let third = commands.value.get("third").expect("third");
    let second = commands.value.get("second").expect("second");
    let items: Vec<_> = third.items().collect();
    let long = items.last().expect("an item").entry("long").expect("long");
    let short = items
        .last()
        .expect("an item")
        .entry("short")
        .expect("short");
    for (node, comments) in [
        (
            commands.key,
            vec!["# Above the first key,", "# on two lines.", "# behind it"],
        ),
        (key("first"), vec!["# 一"]),
        (
            first.entry("code").expect("code").key,
            vec!["# sixteen bits"],
        ),
        (first.get("code").expect("code"), vec![]),
        (first.entry("text").expect("text").key, vec![]),
        (
            key("second"),
            vec!["# Above the second.", "# of the second"],
        ),
        (second.entry("a").expect("a").key, vec![]),
        (key("third"), vec![]),
        (items[0], vec!["# Above an item.", "# behind an item"]),
        (items[1], vec![]),
        (long.key, vec![]),
        (short.key, vec!["# behind a text"]),
    ] {
        assert_eq!(about(node), comments, "{node:?}");
    }
}
