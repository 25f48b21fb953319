//! Three-way merges of a file, with the examples in `merge/cases.txt`.

use fc_spec::merge::merge;

/// Returns the text after the heading that begins with these words, up to the next heading.
fn part<'t>(case: &'t str, heading: &str) -> Option<&'t str> {
    let (_, behind) = case.split_once(&format!("\n===== {heading}"))?;
    let (title, text) = behind.split_once('\n')?;
    let end = text.find("\n=====").map_or(text.len(), |end| end + 1);
    let text = text.get(..end)?;
    let is_cut = title.ends_with("without a line end");
    Some(if is_cut { text.trim_end() } else { text })
}

#[test]
fn cases() {
    let cases = include_str!("../merge/cases.txt");
    let mut count = 0;
    for case in cases.split("\n##### ").skip(1) {
        let title = case.lines().next().unwrap_or_default();
        let part = |heading| part(case, heading);
        let must = |heading| part(heading).expect(title);
        let (base, ours, theirs) = (must("base"), must("ours"), must("theirs"));
        let wanted = must("merged");
        let other = part("the other way").unwrap_or(wanted);
        for (way, first, second, wanted) in [
            ("as written", ours, theirs, wanted),
            ("the other way", theirs, ours, other),
        ] {
            let merged = merge(base, first, second);
            let merged = merged.as_deref().unwrap_or("refused\n");
            assert_eq!(merged, wanted, "{title}, {way}");
            let crlf = |text: &str| text.replace('\n', "\r\n");
            let merged = merge(base, &crlf(first), second).unwrap_or_else(|| crlf("refused\n"));
            assert_eq!(merged, crlf(wanted), "{title}, {way}, with CRLF");
        }
        count += 1;
    }
    assert!(count > 15, "the cases were not found");
}

#[test]
fn one_side_alone_has_its_way() {
    let (old, new) = ("types:\n  A: { zh: a }\n", "types:\n  A: { zh: b }\n");
    assert_eq!(merge(old, old, new).as_deref(), Some(new));
    assert_eq!(merge(old, new, old).as_deref(), Some(new));
    assert_eq!(merge(old, new, new).as_deref(), Some(new));
}
