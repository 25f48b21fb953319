//! The tests in a rule of the project.
//!
//! A test reads the dump of a thing, so every key of the dump can be tested.

use regex_lite::Regex;
use serde_json::Value;

/// A test of a thing.
#[derive(Debug)]
pub(super) enum Test {
    /// Every test passes. An empty list passes.
    All(Vec<Test>),
    /// At least one test passes.
    Any(Vec<Test>),
    /// The test fails.
    Not(Box<Test>),
    /// The check passes for the value at this path.
    At(Vec<String>, Check),
}

/// A check of a value.
///
/// A missing value passes only [`Absent`](Self::Absent) and [`MaxLength`](Self::MaxLength).
#[derive(Debug)]
pub(super) enum Check {
    Present,
    Absent,
    OneOf(Vec<Value>),
    /// The pattern matches the whole string.
    Matches(Regex),
    Min(f64),
    Max(f64),
    /// The number of characters in a string, or of items in a list.
    MinLength(usize),
    MaxLength(usize),
}

impl Test {
    /// Returns `true` if the thing passes.
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

/// Returns `false` for `null` and for empty lists and objects, which the dump writes for a missing value.
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

/// Compares two values. Numbers are equal if their values are equal, in any notation.
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
