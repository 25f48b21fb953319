use super::*;

/// Plain Markdown, in which a fence without a language is `text`.
const COMMENT: Comment = Comment {
    open: "",
    mark: "",
    inner_mark: "",
    close: "",
    begins_at_once: false,
    prose: escape_links,
    code: |line| Cow::Borrowed(line),
    fence: |language| {
        if language.is_empty() {
            "text"
        } else {
            language
        }
    },
};

fn lines(docs: &Docs<'_>, width: usize) -> Vec<String> {
    lines_in(Languages::All, docs, width)
}

fn lines_in(languages: Languages, docs: &Docs<'_>, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    docs.lines(languages, &COMMENT, width, |line| {
        lines.push(line.to_owned());
    });
    lines
}

fn shown(text: &str, width: usize) -> String {
    let mut docs = Docs::default();
    docs.paragraph(text);
    lines(&docs, width).join("\n")
}

#[test]
fn prose_forms_no_links() {
    for (text, expected) in [
        ("a [b] <T> `[c] <T>`", r"a \[b\] \<T> `[c] <T>`"),
        ("见 https://a.example/x。完", "见 <https://a.example/x>。完"),
        ("see <https://a.example/x>.", "see <https://a.example/x>."),
        ("see (https://a.example/x).", "see (<https://a.example/x>)."),
        (r"kept \[ as \\ it is", r"kept \[ as \\ it is"),
        ("lone ` tick [x]", r"lone ` tick \[x\]"),
        ("a\u{202e}b\tc\rd", "ab cd"),
    ] {
        assert_eq!(shown(text, 80), expected, "{text:?}");
    }
}

#[test]
fn code_is_unchanged() {
    assert_eq!(shown("a\n\n```\nx[0]\n```", 80), "a\n\n```text\nx[0]\n```");
    assert_eq!(shown("```json\n{}\n", 80), "```json\n{}\n```");
    assert_eq!(shown("a\n\n      b", 80), "a\n\n   b");
}

#[test]
fn english_is_wrapped_and_chinese_is_not() {
    assert_eq!(shown("one two three", 7), "one two\nthree");
    assert_eq!(shown("one two - three", 7), "one two -\nthree");
    assert_eq!(
        shown("返回此刻回充进行到哪一步", 8),
        "返回此刻回充进行到哪一步"
    );
    assert_eq!(
        shown("- one two\n  1. three four", 8),
        "- one\n  two\n  1. three\n     four"
    );
}

#[test]
fn equal_texts_appear_once() {
    let same = Text {
        zh: "MD5".into(),
        en: "MD5".into(),
    };
    assert_eq!(lines(&Docs::titled(&same), 80), ["MD5"]);
    let both = Text {
        zh: "站点".into(),
        en: "Station".into(),
    };
    assert_eq!(lines(&Docs::titled(&both), 80), ["站点", "Station"]);
}

#[test]
fn text_of_several_lines_is_a_paragraph() {
    for (zh, en) in [
        ("站点\n编号", "Station"),
        ("站点", "1. Station"),
        ("站点", "two\nlines"),
    ] {
        let text = Text {
            zh: zh.into(),
            en: en.into(),
        };
        let lines = lines(&Docs::titled(&text), 80);
        assert!(lines.iter().any(String::is_empty), "{lines:?}");
    }
}

#[test]
fn languages_select_the_texts() {
    let mut docs = Docs::said(["站点", "Station"]);
    docs.both(["说明", "A description"]);
    docs.paragraph("Since 1.");
    docs.sentences(["原样。", "Unchanged."]);
    docs.raw_lines(["先", "First"]);
    docs.joined(["甲", "A", "甲 A"].map(str::to_owned));
    let all = "站点\nStation\n\n说明\n\nA description\n\nSince 1.\n\n原样。Unchanged.\n\n先\nFirst\n\n甲 A";
    let zh = "站点\n\n说明\n\nSince 1.\n\n原样。\n\n先\n\n甲";
    let en = "Station\n\nA description\n\nSince 1.\n\nUnchanged.\n\nFirst\n\nA";
    for (languages, expected) in [
        (Languages::All, all),
        (Languages::Only(Lang::Zh), zh),
        (Languages::Only(Lang::En), en),
    ] {
        assert_eq!(lines_in(languages, &docs, 80).join("\n"), expected);
    }
}
