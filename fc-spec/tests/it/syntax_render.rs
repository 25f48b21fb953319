//! Tests the renderers with unusual places and texts.

use fc_spec::diagnostic::{Diagnostic, FaultCode, Faults, Format, nearest, render, summary};
use fc_spec::model::Lang;
use fc_spec::source::{FileId, Sources, Span};
use fc_spec::text;

const FILE: FileId = FileId(0);

fn text(source: &str, fault: Diagnostic) -> String {
    shown(source, fault, Lang::En)
}

fn shown(source: &str, fault: Diagnostic, lang: Lang) -> String {
    let sources = Sources::from_texts([("spec/a.yaml", source), ("spec/b.yaml", "b: 乙\n")]);
    let mut faults = Faults::new();
    faults.push(fault);
    render(&faults, &sources, Format::Text, lang)
}

#[test]
fn of_several_lines_the_first_is_marked() {
    let fault = Diagnostic::error(
        FaultCode::BadYaml,
        Span::new(FILE, 0, 12),
        text!("不对", "wrong"),
    )
    .label(text!("这里", "this"));
    let expected = "\
error[FC0007]: wrong
 --> spec/a.yaml:1:1
  |
1 | 甲:
  | ^^^ this

";
    assert_eq!(text("甲:\n  b: 1\nc: 2\n", fault), expected);
}

#[test]
fn places_in_two_files() {
    let fault = Diagnostic::error(
        FaultCode::DuplicateKey,
        Span::new(FILE, 5, 8),
        text!("不对", "wrong"),
    )
    .label(text!("这里", "here"))
    .also(Span::new(FileId(1), 3, 6), text!("还有那里", "and there"));
    let expected = "\
error[FC0012]: wrong
 --> spec/a.yaml:1:4
  |
1 | 甲: 丙
  |     ^^ here
  |
 ::: spec/b.yaml:1:4
  |
1 | b: 乙
  |    -- and there

";
    assert_eq!(text("甲: 丙\n", fault), expected);
}

#[test]
fn a_fix_is_shown_as_a_change() {
    let fault = Diagnostic::warning(
        FaultCode::BadYaml,
        Span::new(FILE, 3, 6),
        text!("未知的 `ind`", "unknown `ind`"),
    )
    .fix(
        Span::new(FILE, 3, 6),
        "int",
        text!("有名称相近的类型", "a type with a similar name exists"),
    );
    let expected = "\
warning[FC0007]: unknown `ind`
 --> spec/a.yaml:1:4
  |
1 | a: ind
  |    ^^^
  |
help: a type with a similar name exists
  |
1 - a: ind
1 + a: int
  |

";
    assert_eq!(text("a: ind\n", fault), expected);
}

/// The renderer's labels are Chinese too, and carets are as wide as Chinese characters.
#[test]
fn a_fault_in_chinese() {
    let span = Span::new(FILE, 5, 11);
    let fault = Diagnostic::warning(FaultCode::BadYaml, span, text!("不对", "wrong"))
        .label(text!("这里", "here"))
        .note(text!("请注意", "note this"))
        .fix(span, "丁", text!("改一下", "change it"));
    let expected = "\
警告[FC0007]: 不对
 --> spec/a.yaml:1:4
  |
1 | 甲: 丙丙
  |     ^^^^ 这里
  |
  = 说明: 请注意
建议: 改一下
  |
1 - 甲: 丙丙
1 + 甲: 丁
  |

";
    assert_eq!(shown("甲: 丙丙\n", fault, Lang::Zh), expected);
}

#[test]
fn long_line_shows_its_place_only() {
    let source = format!("甲: {}\n", "x".repeat(5000));
    let span = Span::new(FILE, 5, 5005);
    let fault = Diagnostic::error(FaultCode::BadYaml, span, text!("不对", "wrong"))
        .label(text!("这里", "here"))
        .fix(span, "y", text!("缩短它", "shorten it"));
    let shown = text(&source, fault);
    assert!(shown.len() < 200, "{shown}");
    assert!(shown.contains("--> spec/a.yaml:1:4\n"), "{shown}");
    assert!(
        shown.contains("here") && shown.contains("help: shorten it"),
        "{shown}"
    );
}

#[test]
fn places_beyond_the_text_do_no_harm() {
    let sources = Sources::from_texts([("spec/a.yaml", "甲")]);
    for span in [
        Span::new(FILE, 1, 2),
        Span::new(FILE, 3, 3),
        Span::new(FILE, 90, 100),
        Span::new(FILE, 3, 1),
        Span::new(FileId(7), 0, 1),
    ] {
        let mut faults = Faults::new();
        faults.push(
            Diagnostic::error(FaultCode::BadYaml, span, text!("不对", "wrong")).fix(
                span,
                "x",
                text!("修正", "mend"),
            ),
        );
        for format in [
            Format::Colored,
            Format::Text,
            Format::Json,
            Format::Sarif,
            Format::Github,
        ] {
            assert!(
                render(&faults, &sources, format, Lang::En).contains("wrong"),
                "{span:?} {format:?}"
            );
        }
    }
}

/// Text from the spec cannot inject an annotation or an escape sequence into the output.
#[test]
fn text_from_the_spec_stays_text() {
    let sources = Sources::from_texts([("spec/a,b:c%.yaml", "a: \u{1b}[31mred\n")]);
    let mut faults = Faults::new();
    let message = text!(
        "100%\n::error::forged\r\n\u{1b}[31m",
        "100%\n::error::forged\r\n\u{1b}[31m"
    );
    faults.push(Diagnostic::error(
        FaultCode::BadYaml,
        Span::new(FILE, 0, 1),
        message,
    ));
    let github = render(&faults, &sources, Format::Github, Lang::En);
    assert_eq!(github.lines().count(), 1, "{github}");
    assert!(
        github.starts_with("::error file=spec/a%2Cb%3Ac%25.yaml,line=1,"),
        "{github}"
    );
    assert!(
        github.contains("::100%25%0A::error::forged%0D%0A"),
        "{github}"
    );
    let sarif = render(&faults, &sources, Format::Sarif, Lang::En);
    assert!(sarif.contains("\"spec/a%2Cb%3Ac%25.yaml\""), "{sarif}");
    assert!(!render(&faults, &sources, Format::Text, Lang::En).contains('\u{1b}'));
    assert_eq!(
        render(&faults, &sources, Format::Json, Lang::En)
            .lines()
            .count(),
        1
    );
}

#[test]
fn the_summary_counts() {
    let mut faults = Faults::new();
    assert_eq!(summary(&faults, Lang::En), None);
    faults.push(Diagnostic::warning(
        FaultCode::Tab,
        Span::point(FILE, 0),
        text!("警", "w"),
    ));
    assert_eq!(
        summary(&faults, Lang::En).as_deref(),
        Some(
            "warning: 1 warning in 1 file; run `fcproto explain FC0009` to read more about the first"
        ),
    );
    assert_eq!(
        summary(&faults, Lang::Zh).as_deref(),
        Some("警告：1 个文件中有 1 个警告；运行 `fcproto explain FC0009` 查看第一个的详细说明"),
    );
    assert!(!faults.has_errors());
    faults.push(Diagnostic::error(
        FaultCode::Tag,
        Span::point(FILE, 9),
        text!("错", "e"),
    ));
    faults.push(Diagnostic::error(
        FaultCode::Alias,
        Span::point(FileId(1), 0),
        text!("错", "e"),
    ));
    assert_eq!(
        summary(&faults, Lang::En).as_deref(),
        Some(
            "error: 2 errors and 1 warning in 2 files; run `fcproto explain FC0017` to read more about \
             the first"
        ),
    );
    assert_eq!(
        summary(&faults, Lang::Zh).as_deref(),
        Some(
            "错误：2 个文件中有 2 个错误、1 个警告；运行 `fcproto explain FC0017` 查看第一个的详细说明"
        ),
    );
}

#[test]
fn did_you_mean() {
    let words = ["navigation_mode", "station", "Station", "zh"];
    assert_eq!(nearest("navgation_mode", words), Some("navigation_mode"));
    assert_eq!(nearest("STATION", words), Some("station"));
    assert_eq!(nearest("hz", words), Some("zh"));
    assert_eq!(nearest("zh", words), None);
    assert_eq!(nearest("completely", words), None);
    assert_eq!(nearest("", words), None);
}
