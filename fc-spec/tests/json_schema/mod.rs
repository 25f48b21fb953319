//! JSON Schema as far as the schemas of this project go. For tests alone: a whole implementation would bring fifty crates
//! along.

#![allow(
    clippy::expect_used,
    clippy::missing_panics_doc,
    clippy::panic,
    reason = "for tests"
)]

use regex_lite::Regex;
use serde_json::{Map, Value};

/// A validator for the keywords that our schemas use, and no others.
pub struct Validator<'s> {
    /// The whole schema, in which references are looked up.
    pub root: &'s Value,
}

impl Validator<'_> {
    /// Whether a value fits a part of the schema.
    ///
    /// # Panics
    /// If that has a keyword that is not known here: to pass it over would mean to check nothing.
    pub fn accepts(&self, schema: &Value, value: &Value) -> bool {
        let Some(keywords) = schema.as_object() else {
            return schema != &Value::Bool(false);
        };
        keywords
            .iter()
            .all(|(keyword, argument)| self.holds(keywords, keyword, argument, value))
    }

    fn holds(
        &self,
        keywords: &Map<String, Value>,
        keyword: &str,
        argument: &Value,
        value: &Value,
    ) -> bool {
        let number = |value: &Value| value.as_f64();
        let count = argument
            .as_u64()
            .and_then(|count| usize::try_from(count).ok());
        match keyword {
            "$schema"
            | "$defs"
            | "title"
            | "description"
            | "markdownEnumDescriptions"
            | "format"
            | "default"
            | "then"
            | "else" => true,
            "$ref" => {
                let path = argument.as_str().and_then(|path| path.strip_prefix('#'));
                let target = path
                    .and_then(|path| self.root.pointer(path))
                    .expect("a definition");
                self.accepts(target, value)
            }
            "type" => match argument {
                Value::Array(types) => types.iter().any(|ty| is_type(ty, value)),
                ty => is_type(ty, value),
            },
            "enum" => argument
                .as_array()
                .is_some_and(|values| values.contains(value)),
            "minimum" => {
                number(value).is_none_or(|value| number(argument).is_some_and(|min| value >= min))
            }
            "maximum" => {
                number(value).is_none_or(|value| number(argument).is_some_and(|max| value <= max))
            }
            "pattern" => {
                let regex = Regex::new(argument.as_str().expect("a pattern"))
                    .expect("a regular expression");
                value.as_str().is_none_or(|text| regex.is_match(text))
            }
            "const" => argument == value,
            "anyOf" => list(argument).any(|schema| self.accepts(schema, value)),
            "allOf" => list(argument).all(|schema| self.accepts(schema, value)),
            "oneOf" => {
                let fitting = list(argument).filter(|schema| self.accepts(schema, value));
                fitting.count() == 1
            }
            "if" => {
                let branch = if self.accepts(argument, value) {
                    "then"
                } else {
                    "else"
                };
                keywords
                    .get(branch)
                    .is_none_or(|schema| self.accepts(schema, value))
            }
            "items" => value
                .as_array()
                .is_none_or(|items| items.iter().all(|item| self.accepts(argument, item))),
            "prefixItems" => value.as_array().is_none_or(|items| {
                let mut pairs = list(argument).zip(items);
                pairs.all(|(schema, item)| self.accepts(schema, item))
            }),
            "minItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) >= count),
            "maxItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) <= count),
            "minProperties" => value
                .as_object()
                .is_none_or(|entries| Some(entries.len()) >= count),
            "required" => value.as_object().is_none_or(|entries| {
                let mut names = list(argument).filter_map(Value::as_str);
                names.all(|name| entries.contains_key(name))
            }),
            "properties" => value.as_object().is_none_or(|entries| {
                let properties = argument.as_object().expect("an object");
                properties
                    .iter()
                    .filter_map(|(name, schema)| Some((schema, entries.get(name)?)))
                    .all(|(schema, value)| self.accepts(schema, value))
            }),
            "additionalProperties" => value.as_object().is_none_or(|entries| {
                let known = keywords.get("properties").and_then(Value::as_object);
                entries
                    .iter()
                    .filter(|(name, _)| known.is_none_or(|known| !known.contains_key(*name)))
                    .all(|(_, value)| self.accepts(argument, value))
            }),
            "propertyNames" => value.as_object().is_none_or(|entries| {
                entries
                    .keys()
                    .all(|name| self.accepts(argument, &Value::String(name.clone())))
            }),
            other => panic!("the keyword {other} is new here"),
        }
    }
}

fn list(argument: &Value) -> impl Iterator<Item = &Value> {
    argument.as_array().expect("a list").iter()
}

fn is_type(ty: &Value, value: &Value) -> bool {
    match ty.as_str() {
        Some("string") => value.is_string(),
        Some("null") => value.is_null(),
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_i64() || value.is_u64(),
        Some("number") => value.is_number(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        other => panic!("the type {other:?} is new here"),
    }
}
