//! `conformance/patterns.json`: patterns match the same texts in all languages.

use super::script::folder;
use crate::tally::Tally;
use fc_runtime::json::{Pattern, matches};
use serde::Deserialize;
use std::fs;

#[derive(Deserialize)]
struct Case {
    portable: Option<String>,
    #[serde(default)]
    matches: Vec<String>,
    #[serde(default)]
    refuses: Vec<String>,
}

#[fc_test::test]
fn texts_match_or_are_refused() {
    let table = fs::read_to_string(folder().join("patterns.json")).unwrap();
    let cases: Vec<Case> = serde_json::from_str(&table).unwrap();
    let mut tally = Tally::of("patterns");
    for case in cases {
        let Some(portable) = case.portable else {
            continue;
        };
        let pattern = Pattern::new(portable.leak());
        let texts = case.matches.into_iter().map(|text| (text, true));
        let texts = texts.chain(case.refuses.into_iter().map(|text| (text, false)));
        for (text, fits) in texts {
            let found = matches("text", &text, &pattern).is_ok();
            assert_eq!(found, fits, "{pattern:?} on {text:?}");
            tally.held(1);
        }
    }
}
