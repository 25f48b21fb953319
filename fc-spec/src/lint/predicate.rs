//! What a rule of the project asks of a thing.
//!
//! Asked is the dump of the thing, so that there is no second list of what can be asked.

use regex_lite::Regex;
use serde_json::Value;

/// Something that holds of a thing or does not.
#[derive(Debug)]
pub(super) enum Test {
    /// Each of them holds; nothing to ask always holds.
    All(Vec<Test>),
    /// One of them holds.
    Any(Vec<Test>),
    /// It does not hold.
    Not(Box<Test>),
    /// It holds of what stands at this path.
    At(Vec<String>, Check),
}

/// Something that holds of a value or does not. Of a value that is not there nothing holds but [`Absent`](Self::Absent).
#[derive(Debug)]
pub(super) enum Check {
    Present,
    Absent,
    OneOf(Vec<Value>),
    /// As a whole.
    Matches(Regex),
    Min(f64),
    Max(f64),
    /// Characters of a text, items of a list.
    MinLength(usize),
    MaxLength(usize),
}

impl Test {
    /// Whether it holds.
    pub fn holds(&self, thing: &Value) -> bool {
        match self {
            Self::All(tests) => tests.iter().all(|test| test.holds(thing)),
            Self::Any(tests) => tests.iter().any(|test| test.holds(thing)),
            Self::Not(test) => !test.holds(thing),
            Self::At(path, check) => {
                let mut keys = path.iter();
                let value = keys.try_fold(thing, |value, key| value.get(key));
                check.holds(value.filter(|value| is_there(value)))
            }
        }
    }
}

/// The dump writes what is not said as `null`, and lists of nothing.
fn is_there(value: &Value) -> bool {
    match value {
        Value::Null => false,
        Value::Array(items) => !items.is_empty(),
        Value::Object(entries) => !entries.is_empty(),
        _ => true,
    }
}

impl Check {
    fn holds(&self, value: Option<&Value>) -> bool {
        let Some(value) = value else {
            return matches!(self, Self::Absent | Self::MaxLength(_));
        };
        match self {
            Self::Present => true,
            Self::Absent => false,
            Self::OneOf(values) => values.iter().any(|it| is_same(it, value)),
            Self::Matches(pattern) => value.as_str().is_some_and(|text| pattern.is_match(text)),
            Self::Min(min) => value.as_f64().is_some_and(|value| value >= *min),
            Self::Max(max) => value.as_f64().is_some_and(|value| value <= *max),
            Self::MinLength(min) => length(value).is_some_and(|length| length >= *min),
            Self::MaxLength(max) => length(value).is_some_and(|length| length <= *max),
        }
    }
}

/// Numbers are the same however they are written.
fn is_same(one: &Value, other: &Value) -> bool {
    match (one.as_f64(), other.as_f64()) {
        (Some(one), Some(other)) => one.total_cmp(&other).is_eq(),
        _ => one == other,
    }
}

fn length(value: &Value) -> Option<usize> {
    match value {
        Value::String(text) => Some(text.chars().count()),
        Value::Array(items) => Some(items.len()),
        _ => None,
    }
}
