//! Conditions of fields on the values of other fields in the same object.

use super::{Scalar, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Under which values of the fields beside it an optional field is there, and a required one, which is always there,
/// is valid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// Exactly where all of these fields have one of their values.
    When(Vec<Asked>),
    /// Everywhere else.
    Unless(Vec<Asked>),
}

/// A field that a condition asks, and the values that it asks for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Asked {
    /// Its wire key. It stands in the same object and is required.
    #[serde(rename = "path")]
    pub wire: String,
    /// The values, in wire form: any of them.
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
