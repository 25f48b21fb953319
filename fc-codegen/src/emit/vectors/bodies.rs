//! `bodies.json`: rules of JSON that hold for every message.

use super::file::contents;
use super::json_cases::{JsonCase, json_cases};
use crate::emit::json::{hex, object, text};
use fc_spec::model::Value;

pub(super) fn file() -> Value {
    let (mut accepted, mut rejected) = (Vec::new(), Vec::new());
    for case in json_cases() {
        let list = match case.outcome {
            Ok(_) => &mut accepted,
            Err(_) => &mut rejected,
        };
        list.push(entry(&case));
    }
    contents(None, None, accepted, rejected)
}

fn entry(case: &JsonCase) -> Value {
    let (key, outcome) = match &case.outcome {
        Ok(written) => ("written", written.as_str()),
        Err(error) => ("error", *error),
    };
    object([
        ("name", text(&format!("{}_{}", case.rule.name(), case.name))),
        ("type", text(case.ty)),
        ("bytes", text(&hex(&case.body))),
        // For people. Some bodies are not text.
        ("text", text(&String::from_utf8_lossy(&case.body))),
        (key, text(outcome)),
    ])
}
