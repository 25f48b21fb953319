use super::*;

fn check(slot: Slot<'_>, cases: &[(&str, &str)]) {
    for (source, expected) in cases {
        assert_eq!(write(source, slot), *expected, "{source} in {slot:?}");
    }
}

#[test]
fn texts_stay_in_their_place() {
    check(
        Slot::Line,
        &[
            ("a <b> c", "a &lt;b> c"),
            ("`a <b>` c", "`a <b>` c"),
            ("{x} {{ y }}", "\\{x} \\{<!-- -->\\{ y }}"),
            ("\\{x}", "\\{x}"),
            ("{\\{ y }}", "\\{<!-- -->\\{ y }}"),
            (
                "&#123;&#123; y }} R&D &",
                "&amp;#123;&amp;#123; y }} R&amp;D &",
            ),
            ("`{{ y }}`", "`{`<!-- -->`{ y }}`"),
            ("`{{{`", "`{`<!-- -->`{`<!-- -->`{`"),
            ("a ` b <c>", "a \\` b &lt;c>"),
            ("\\`<c>`", "\\`&lt;c>\\`"),
            ("``a ` b``", "``a ` b``"),
            ("one\n  two\n", "one two"),
            ("\\<c>", "&lt;c>"),
            ("![a](../../secret.txt)", "\\![a](../../secret.txt)"),
            ("Say <!--@include: x-->", "Say &lt;!--@include: x-->"),
            ("`<!--@include: x-->`", "`<`<!-- -->`!--@include: x-->`"),
        ],
    );
}

#[test]
fn a_backslash_at_the_end_is_text() {
    check(
        Slot::Line,
        &[
            ("a\\", "a\\\\"),
            ("a\\\\", "a\\\\"),
            ("`a\\`", "`a\\`"),
            ("\\d", "\\d"),
        ],
    );
    check(Slot::Cell, &[("a\\\nb\\", "a\\\\<br>b\\\\")]);
    check(
        Slot::Label,
        &[("a\\", "a\\\\"), ("a [b] `[c]` \\]", "a \\[b\\] `[c]` \\]")],
    );
}

#[test]
fn lines_begin_no_other_block() {
    check(
        Slot::Line,
        &[
            ("# a #", "\\# a \\#"),
            ("C#", "C#"),
            ("- a", "\\- a"),
            ("-1 to 1", "-1 to 1"),
            ("1. a", "1\\. a"),
            ("1.5 a", "1.5 a"),
            ("> a", "\\> a"),
            ("::: tip", "\\::: tip"),
            ("[[toc]]", "\\[[toc]]"),
            ("", ""),
        ],
    );
    check(
        Slot::Prose,
        &[
            ("a\n---\n# b\n- c", "a\n\\---\n\\# b\n- c"),
            ("a ` b\n\n` <c>", "a \\` b\n\n\\` &lt;c>"),
            ("::: tip\n[a]: x", "\\::: tip\n\\[a]: x"),
        ],
    );
}

#[test]
fn cells_hold_one_line_and_no_bar() {
    check(Slot::Cell, &[("a|b\n`c|d`", "a\\|b<br>`c\\|d`")]);
    check(Slot::CodeCell, &[("a|b", "`a\\|b`")]);
}

#[test]
fn code_spans_outlast_their_backticks() {
    check(
        Slot::Code,
        &[
            ("a", "`a`"),
            ("a`b", "``a`b``"),
            ("`", "`` ` ``"),
            (" ", ""),
        ],
    );
    check(Slot::Fence("text"), &[("```", "````text\n```\n````")]);
}

#[test]
fn prose_keeps_its_fences() {
    check(
        Slot::Prose,
        &[
            (
                "a {b}\n\n```text\n{{ c }} <d>\n```\n\n<e>\n",
                "a \\{b}\n\n```text\n{{ c }} <d>\n```\n\n&lt;e>",
            ),
            ("```\n<a>", "```\n<a>\n```"),
            ("~~~\n```x\n~~~\n<a>", "~~~\n```x\n~~~\n&lt;a>"),
            (
                "```\n<!-- @include: x -->\n```",
                "<pre v-pre><code>&lt;!-- @include: x --&gt;</code></pre>",
            ),
        ],
    );
}

#[test]
fn vitepress_obeys_no_comment() {
    let text = "Say <!--@include: ../secret.txt-->";
    check(
        Slot::Fence("json"),
        &[(
            text,
            "<pre v-pre><code>Say &lt;!--@include: ../secret.txt--&gt;</code></pre>",
        )],
    );
    check(
        Slot::FrontMatter,
        &[(text, "\"Say ＜!--@include: ../secret.txt-->\"")],
    );
    check(Slot::Attribute, &[("a\"<b\nc", "a&quot;&lt;b c")]);
}

#[test]
fn a_title_ends_no_script() {
    check(
        Slot::FrontMatter,
        &[
            ("a </script> < 3", "\"a ＜/script> < 3\""),
            ("a\"b\\", "\"a\\\"b\\\\\""),
        ],
    );
}

#[test]
fn invisible_characters_are_spelled() {
    let hostile = "a\u{202e}b\0c\u{1b}d\u{2028}e\u{fdd0}f\u{e0001}";
    let shown = "a\\u202eb\\u0000c\\u001bd\\u2028e\\ufdd0f\\udb40\\udc01";
    for slot in [
        Slot::Line,
        Slot::Cell,
        Slot::Label,
        Slot::Prose,
        Slot::Diagram,
        Slot::Data,
    ] {
        assert_eq!(write(hostile, slot), shown, "{slot:?}");
    }
    assert_eq!(write(hostile, Slot::Code), format!("`{shown}`"));
    // YAML decodes the spelling instead of the character.
    let spelled = shown.replace('\\', "\\\\");
    assert_eq!(write(hostile, Slot::FrontMatter), format!("\"{spelled}\""));
}

#[test]
fn targets_cannot_end_a_link() {
    check(
        Slot::Target,
        &[
            ("../a b(1).yaml#x-序.2E.", "../a%20b%281%29.yaml#x-序.2E."),
            ("a\\<b>", "a%5C%3Cb%3E"),
        ],
    );
}
