//! Conditions of fields on the values of other fields in the same object.

use super::{Scalar, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Condition of a field on other fields of the same object. An optional field is present only if the condition
/// holds. A required field is always present and is valid only if the condition holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// Holds if every listed field has one of its values.
    When(Vec<Asked>),
    /// Holds unless every listed field has one of its values.
    Unless(Vec<Asked>),
}

/// A field in a condition, with the values that match.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Asked {
    /// Wire key of the field, which is a required field of the same object.
    #[serde(rename = "path")]
    pub wire: String,
    /// Values in wire form; each of them matches.
    pub values: Vec<Scalar>,
}

impl Condition {
    /// Returns the fields and values in the condition, for both variants.
    #[must_use]
    pub fn asked(&self) -> &[Asked] {
        match self {
            Self::When(asked) | Self::Unless(asked) => asked,
        }
    }

    /// Returns `true` if an object in wire form meets the condition.
    #[must_use]
    pub fn holds(&self, object: &Value) -> bool {
        let all = |asked: &[Asked]| asked.iter().all(|asked| asked.holds(object));
        match self {
            Self::When(asked) => all(asked),
            Self::Unless(asked) => !all(asked),
        }
    }
}

impl Asked {
    fn holds(&self, object: &Value) -> bool {
        let found = object.get(&self.wire);
        found.is_some_and(|found| self.values.iter().any(|value| Value::from(value) == *found))
    }
}
