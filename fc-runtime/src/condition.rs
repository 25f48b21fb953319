//! Fields that are present only under conditions on other fields.
//!
//! Reading and writing ignore conditions: a received message is accepted unchanged. `checked` verifies them before a
//! message is sent. `#[derive(Message)]` writes it for each message with such a field.

use crate::json::Chosen;
use std::fmt;

/// The condition under which a field is present.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Present exactly if all of these fields have one of their values.
    When(&'static [Asked]),
    /// Present in all other cases.
    Unless(&'static [Asked]),
}

/// A field in a condition, and its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Wire key.
    pub key: &'static str,
    /// The values in readable form; any of them satisfies the condition.
    pub values: &'static [&'static str],
}

/// The kind of a contradiction between a field and its condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConditionErrorKind {
    /// The field is absent although its condition is satisfied.
    Missing,
    /// The field is present although its condition is not satisfied.
    Unasked,
}

/// A field of a message contradicts its condition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConditionError {
    key: &'static str,
    kind: ConditionErrorKind,
    condition: Condition,
}

impl ConditionError {
    /// Returns the wire key of the field.
    #[must_use]
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Returns the kind of the contradiction.
    #[must_use]
    pub fn kind(&self) -> ConditionErrorKind {
        self.kind
    }

    /// Returns the condition.
    #[must_use]
    pub fn condition(&self) -> Condition {
        self.condition
    }
}

impl fmt::Display for ConditionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            key,
            kind,
            condition,
        } = self;
        match kind {
            ConditionErrorKind::Missing => write!(f, "`{key}` is missing: it is sent {condition}"),
            ConditionErrorKind::Unasked => {
                let only = match condition {
                    Condition::When(_) => "only ",
                    Condition::Unless(_) => "",
                };
                write!(f, "`{key}` is not asked for: it is sent {only}{condition}")
            }
        }
    }
}

impl std::error::Error for ConditionError {}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, asked) = match self {
            Self::When(asked) => ("when", asked),
            Self::Unless(asked) => ("unless", asked),
        };
        f.write_str(word)?;
        for (index, Asked { key, values }) in asked.iter().enumerate() {
            let and = if index > 0 { " and" } else { "" };
            write!(f, "{and} `{key}` is {}", values.join(" or "))?;
        }
        Ok(())
    }
}

/// Values that a condition can compare: integers, bools, strings and enums.
pub trait Comparable {
    /// Type of the values it is compared with.
    type Wire: Copy + 'static;

    /// Returns `true` if the value is one of these.
    fn is_among(&self, values: &[Self::Wire]) -> bool;
}

macro_rules! comparable {
    ($($Plain:ty)*) => {$(
        impl Comparable for $Plain {
            type Wire = Self;

            fn is_among(&self, values: &[Self]) -> bool {
                values.contains(self)
            }
        }
    )*};
}

comparable!(bool i8 i16 i32 i64 u8 u16 u32 u64);

impl Comparable for String {
    type Wire = &'static str;

    fn is_among(&self, values: &[&'static str]) -> bool {
        values.contains(&self.as_str())
    }
}

#[diagnostic::do_not_recommend]
impl<T: Chosen> Comparable for T {
    type Wire = T::Wire;

    fn is_among(&self, values: &[T::Wire]) -> bool {
        self.all_among(values)
    }
}

/// Checks that a field is present exactly if its condition is satisfied. `asked` is `true` if all fields in the
/// condition have one of their values.
///
/// # Errors
/// The contradiction.
#[inline]
pub fn check<T>(
    key: &'static str,
    value: &Option<T>,
    condition: Condition,
    asked: bool,
) -> Result<(), ConditionError> {
    let holds = match condition {
        Condition::When(_) => asked,
        Condition::Unless(_) => !asked,
    };
    let kind = match (holds, value) {
        (true, Some(_)) | (false, None) => return Ok(()),
        (true, None) => ConditionErrorKind::Missing,
        (false, Some(_)) => ConditionErrorKind::Unasked,
    };
    Err(ConditionError {
        key,
        kind,
        condition,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHEN: Condition = Condition::When(&[
        Asked {
            key: "mode",
            values: &["4", "5"],
        },
        Asked {
            key: "on",
            values: &["true"],
        },
    ]);
    const UNLESS: Condition = Condition::Unless(&[Asked {
        key: "place",
        values: &["\"out\""],
    }]);

    #[fc_test::test]
    fn a_field_exists_exactly_if_its_condition_holds() {
        for (value, condition, asked, kind) in [
            (Some(1), WHEN, true, None),
            (None, WHEN, true, Some(ConditionErrorKind::Missing)),
            (Some(1), WHEN, false, Some(ConditionErrorKind::Unasked)),
            (None, WHEN, false, None),
            (Some(1), UNLESS, true, Some(ConditionErrorKind::Unasked)),
            (None, UNLESS, true, None),
            (Some(1), UNLESS, false, None),
            (None, UNLESS, false, Some(ConditionErrorKind::Missing)),
        ] {
            let found = check("speed", &value, condition, asked);
            let found = found.err().map(|error| error.kind());
            assert_eq!(found, kind, "{value:?} {condition} {asked}");
        }
    }

    #[fc_test::test]
    fn error_states_the_condition() {
        let missing = check::<u8>("speed", &None, WHEN, true).map_err(|error| error.to_string());
        let expected = "`speed` is missing: it is sent when `mode` is 4 or 5 and `on` is true";
        assert_eq!(missing, Err(expected.to_owned()));
        let unasked = check("speed", &Some(1), UNLESS, true).map_err(|error| error.to_string());
        let expected = "`speed` is not asked for: it is sent unless `place` is \"out\"";
        assert_eq!(unasked, Err(expected.to_owned()));
    }

    #[fc_test::test]
    fn values_are_compared_by_their_type() {
        assert!(3_u8.is_among(&[1, 3]) && !(-3_i64).is_among(&[3]));
        assert!(true.is_among(&[true]) && !true.is_among(&[]));
        assert!("a".to_owned().is_among(&["b", "a"]) && !String::new().is_among(&["a"]));
    }
}
