//! Constraints of fields, in addition to their types: names, arguments, meaning, and the values at their edges.

use super::{Number, Pattern, Scalar, Text, Value};
use crate::text;
use crate::vocabulary::IntKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// The constraints of a field. An absent value meets every constraint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Constraints {
    /// Smallest value of a number.
    pub min: Option<Number>,
    /// Largest value of a number.
    pub max: Option<Number>,
    /// Fewest and most characters of a string, bytes of a base64, items of an array.
    pub length: Option<(u64, u64)>,
    /// Regular expression that a string must match as a whole.
    pub pattern: Option<Pattern>,
    /// Accepted values of its enum, in wire form. Empty if all values are accepted.
    pub only: Vec<Scalar>,
}

/// A constraint of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint<'f> {
    /// The smallest value of a number.
    Min(&'f Number),
    /// The largest value of a number.
    Max(&'f Number),
    /// Fewest and most characters of a string, bytes of a base64, items of an array.
    Length(u64, u64),
    /// A regular expression that a string must match as a whole.
    Pattern(&'f Pattern),
    /// The accepted values of an enum, in wire form. Every other value is refused, including values that the enum does not declare.
    Only(&'f [Scalar]),
}

/// The argument of a constraint. Its kind decides the error for a value that breaks the constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Argument<'f> {
    /// A number.
    Number(&'f Number),
    /// The least and the most of a count.
    Range(u64, u64),
    /// A regular expression.
    Pattern(&'f Pattern),
    /// Values in wire form.
    Values(&'f [Scalar]),
}

/// The part of a value that constraints judge.
#[derive(Clone, Debug, PartialEq)]
pub enum Judged<'v> {
    /// A number.
    Number(Number),
    /// A string.
    String(&'v str),
    /// The number of bytes of a base64.
    Bytes(usize),
    /// The number of items of an array.
    Items(usize),
    /// A value of an enum, in wire form.
    EnumValue(Scalar),
}

impl Constraints {
    /// A field without constraints.
    pub(super) const NONE: Self = Self {
        min: None,
        max: None,
        length: None,
        pattern: None,
        only: Vec::new(),
    };

    /// Returns the constraints, in the order of their checks.
    pub fn iter(&self) -> impl Iterator<Item = Constraint<'_>> {
        let min = self.min.as_ref().map(Constraint::Min);
        let max = self.max.as_ref().map(Constraint::Max);
        let length = self.length;
        let length = length.map(|(least, most)| Constraint::Length(least, most));
        let pattern = self.pattern.as_ref().map(Constraint::Pattern);
        let only = (!self.only.is_empty()).then_some(Constraint::Only(&self.only));
        [min, max, length, pattern, only].into_iter().flatten()
    }

    /// Returns `true` if `min` is larger than `max`, so that no number is accepted.
    #[must_use]
    pub fn is_inverted(&self) -> bool {
        let bounds = self.min.as_ref().zip(self.max.as_ref());
        bounds.is_some_and(|(min, max)| min.compare(max).is_gt())
    }

    /// Returns the accepted integer of a type that is nearest to `wanted`.
    #[must_use]
    pub fn nearest_int(&self, kind: IntKind, wanted: i128) -> i128 {
        let (least, most) = kind.range();
        let least = self.min.as_ref().map_or(least, ceil).max(least);
        let most = self.max.as_ref().map_or(most, floor).min(most);
        wanted.min(most).max(least)
    }

    /// Returns integers that a field of this type refuses, each near an accepted one, with a suffix for their names.
    #[must_use]
    pub fn refused_ints(&self, kind: IntKind) -> Vec<(&'static str, i128)> {
        let least = self.nearest_int(kind, i128::MIN);
        let most = self.nearest_int(kind, i128::MAX);
        vec![("_below", least - 1), ("_above", most + 1)]
    }

    /// Returns the accepted numbers in words, such as `1 … 5`, or `None` without constraints on numbers.
    #[must_use]
    pub fn numbers(&self) -> Option<Text> {
        let range = match (&self.min, &self.max) {
            (Some(min), Some(max)) => format!("{} … {}", show(min), show(max)),
            (Some(min), None) => format!("≥ {}", show(min)),
            (None, Some(max)) => format!("≤ {}", show(max)),
            (None, None) => return None,
        };
        Some(text!("{range}", "{range}"))
    }
}

impl<'f> Constraint<'f> {
    /// Returns the key of the constraint in the spec, which is its name in every language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Min(_) => "min",
            Self::Max(_) => "max",
            Self::Length(..) => "length",
            Self::Pattern(_) => "pattern",
            Self::Only(_) => "only",
        }
    }

    /// Returns the argument.
    #[must_use]
    pub fn argument(self) -> Argument<'f> {
        match self {
            Self::Min(number) | Self::Max(number) => Argument::Number(number),
            Self::Length(least, most) => Argument::Range(least, most),
            Self::Pattern(pattern) => Argument::Pattern(pattern),
            Self::Only(taken) => Argument::Values(taken),
        }
    }

    /// Returns the message about a value that breaks the constraint, or `None` for a value that meets it.
    #[must_use]
    pub fn broken(self, value: &Judged<'_>) -> Option<Text> {
        match (self, value) {
            (Self::Min(min), Judged::Number(number)) => number.compare(min).is_lt().then(|| {
                text!(
                    "应不小于 {min}，实际为 {found}",
                    "expected at least {min}, found {found}",
                    min = show(min),
                    found = show(number)
                )
            }),
            (Self::Max(max), Judged::Number(number)) => number.compare(max).is_gt().then(|| {
                text!(
                    "应不大于 {max}，实际为 {found}",
                    "expected at most {max}, found {found}",
                    max = show(max),
                    found = show(number)
                )
            }),
            (Self::Length(least, most), value) => wrong_length(least, most, value),
            (Self::Pattern(pattern), Judged::String(text)) => (!pattern.matches(text)).then(|| {
                text!(
                    "整段文本应与正则表达式 `{pattern}` 匹配",
                    "the whole text must match the pattern `{pattern}`"
                )
            }),
            (Self::Only(taken), Judged::EnumValue(value)) => {
                let list = || Text::listed(taken.iter().map(|it| Value::from(it).to_string()));
                (!taken.contains(value)).then(|| {
                    text!(
                        "应为以下取值之一：{taken}",
                        "expected one of {taken}",
                        taken = list()
                    )
                })
            }
            (Self::Min(_) | Self::Max(_) | Self::Pattern(_) | Self::Only(_), _) => None,
        }
    }
}

fn wrong_length(least: u64, most: u64, value: &Judged<'_>) -> Option<Text> {
    let (length, unit) = match value {
        Judged::String(text) => (text.chars().count(), text!("字符数", "characters")),
        Judged::Bytes(count) => (*count, text!("字节数", "bytes")),
        Judged::Items(count) => (*count, text!("项数", "items")),
        Judged::Number(_) | Judged::EnumValue(_) => return None,
    };
    let length = u64::try_from(length).unwrap_or(u64::MAX);
    if (least..=most).contains(&length) {
        return None;
    }
    Some(if least == most {
        text!(
            "{unit}应为 {least}，实际为 {length}",
            "expected {least} {unit}, found {length}",
            unit = unit
        )
    } else {
        text!(
            "{unit}应为 {least} 到 {most}，实际为 {length}",
            "expected {least} to {most} {unit}, found {length}",
            unit = unit
        )
    })
}

impl Number {
    /// Compares two numbers. The comparison of integers is exact. NaN is equal to every number.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        if let (Self::Int(one), Self::Int(other)) = (self, other) {
            return one.cmp(other);
        }
        let order = self.to_f64().partial_cmp(&other.to_f64());
        order.unwrap_or(Ordering::Equal)
    }
}

fn show(number: &Number) -> Value {
    Value::Number(number.clone())
}

#[allow(clippy::cast_possible_truncation)]
fn ceil(number: &Number) -> i128 {
    match number {
        Number::Int(value) => *value,
        Number::Float(value) => value.ceil() as i128,
    }
}

#[allow(clippy::cast_possible_truncation)]
fn floor(number: &Number) -> i128 {
    match number {
        Number::Int(value) => *value,
        Number::Float(value) => value.floor() as i128,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_compare_as_decoders_compare_them() {
        let (int, float) = (Number::Int, Number::Float);
        for (one, other, expected) in [
            (float(-0.0), int(0), Ordering::Equal),
            (float(0.5), int(1), Ordering::Less),
            (int(2), float(1.5), Ordering::Greater),
            (
                int(i128::from(u64::MAX)),
                int(i128::from(u64::MAX) - 1),
                Ordering::Greater,
            ),
        ] {
            assert_eq!(one.compare(&other), expected, "{one:?} and {other:?}");
        }
    }
}
