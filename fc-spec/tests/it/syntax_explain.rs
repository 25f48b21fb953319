//! Every error code has an explanation in both languages, and the examples of the syntax codes are correct.

use crate::syntax_support;
use fc_spec::diagnostic::FaultCode;
use fc_spec::model::Lang;

/// Returns the fenced blocks of an explanation: the text after the fence, and the lines inside.
fn blocks(text: &str) -> Vec<(&str, String)> {
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(info) = line.strip_prefix("```").filter(|info| !info.is_empty()) {
            let body: Vec<_> = lines.by_ref().take_while(|line| *line != "```").collect();
            blocks.push((info, body.join("\n") + "\n"));
        }
    }
    blocks
}

#[test]
fn every_code_has_a_bad_and_a_good_example() {
    for code in FaultCode::ALL {
        for lang in Lang::ALL {
            let text = code.explain(lang);
            let kinds: Vec<_> = blocks(text)
                .iter()
                .filter_map(|(info, _)| info.split_once(' ').map(|(_, kind)| kind))
                .collect();
            assert!(
                kinds.contains(&"bad") && kinds.contains(&"good"),
                "{code}: {kinds:?}"
            );
            let first = text.lines().next().unwrap_or_default();
            assert!(
                first.ends_with(['.', '?', '。', '？'])
                    && !first.starts_with("```")
                    && !first.starts_with('#'),
                "{code}: starts with a paragraph"
            );
        }
    }
}

/// Both languages have the same examples, so neither explains more than the other.
#[test]
fn every_code_is_explained_in_both_languages() {
    let is_chinese = |text: &str| text.contains(|c| matches!(c, '\u{4E00}'..='\u{9FFF}'));
    for code in FaultCode::ALL {
        let [zh, en] = Lang::ALL.map(|lang| code.explain(lang));
        let first = zh.lines().next().unwrap_or_default();
        assert!(is_chinese(first), "{code}: {first}");
        assert!(is_chinese(code.title(Lang::Zh)), "{code}");
        assert!(!is_chinese(code.title(Lang::En)), "{code}");
        assert_eq!(blocks(zh), blocks(en), "{code}");
    }
}

#[test]
fn codes_are_numbered_in_order() {
    let numbers: Vec<_> = FaultCode::ALL.iter().map(|code| code.as_str()).collect();
    assert!(numbers.is_sorted(), "{numbers:?}");
    for code in FaultCode::ALL {
        assert_eq!(FaultCode::parse(&code.as_str().to_lowercase()), Some(*code));
        assert_eq!(FaultCode::parse(&code.as_str()["FC".len()..]), Some(*code));
    }
    assert_eq!(FaultCode::parse("12"), Some(FaultCode::DuplicateKey));
    for unknown in ["FC9999", "", "FC", "FC00012", "twelve"] {
        assert_eq!(FaultCode::parse(unknown), None, "{unknown}");
    }
}

#[test]
fn examples_of_the_syntax_codes_tell_the_truth() {
    for code in FaultCode::ALL
        .iter()
        .filter(|code| code.as_str().starts_with("FC00"))
    {
        for (info, text) in blocks(code.explain(Lang::En)) {
            let (_, _, faults) = syntax_support::parse_text(&text);
            match info {
                "yaml bad" => assert!(
                    faults.iter().any(|fault| fault.code == *code),
                    "{code}: {:?}",
                    syntax_support::codes(&faults),
                ),
                "yaml good" => assert!(faults.is_empty(), "{code}: {faults:?}"),
                _ => {}
            }
        }
    }
}
