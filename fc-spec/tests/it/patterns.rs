//! Tests patterns with the table that all languages share, `conformance/patterns.json`.

use fc_spec::model::Pattern;
use regex_lite::Regex;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    pattern: String,
    portable: Option<String>,
    #[serde(default)]
    matches: Vec<String>,
    #[serde(default)]
    refuses: Vec<String>,
    #[serde(default)]
    refused: bool,
}

fn cases() -> Vec<Case> {
    let table = include_str!("../../../conformance/patterns.json");
    serde_json::from_str(table).expect("the table")
}

#[test]
fn patterns_are_translated_or_refused() {
    for case in cases() {
        let pattern = Pattern::new(&*case.pattern);
        assert_eq!(pattern.is_err(), case.refused, "{}", case.pattern);
        let portable = pattern.as_ref().ok().map(Pattern::portable);
        assert_eq!(portable, case.portable.as_deref(), "{}", case.pattern);
    }
}

#[test]
fn translated_patterns_match_the_same_texts() {
    for case in cases().into_iter().filter(|case| !case.refused) {
        let source = Regex::new(&format!("^(?:{})$", case.pattern)).expect("a regular expression");
        let pattern = Pattern::new(&*case.pattern).expect("a pattern");
        let texts = case.matches.iter().map(|text| (text, true));
        for (text, fits) in texts.chain(case.refuses.iter().map(|text| (text, false))) {
            assert_eq!(pattern.matches(text), fits, "{} on {text:?}", case.pattern);
            assert_eq!(source.is_match(text), fits, "{} on {text:?}", case.pattern);
        }
    }
}

#[test]
fn translation_is_stable() {
    for case in cases() {
        if let Some(portable) = case.portable {
            let again = Pattern::new(&*portable).expect("a pattern");
            assert_eq!(again.portable(), portable);
        }
    }
}
