//! Validates against JSON Schema, as far as the schemas of this project use it. It is for tests only, because a
//! complete implementation would add fifty crates.

use regex_lite::Regex;
use serde_json::{Map, Value};

/// A validator for only the keywords that our schemas use.
pub struct Validator<'s> {
    /// The whole schema, in which references are resolved.
    pub root: &'s Value,
}

/// The place in a value that does not fit, and the keyword of the schema. If no alternative fits, it is the keyword
/// that lists the alternatives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit {
    /// The keys that lead to the place, joined by dots.
    pub at: String,
    /// The keyword, followed by the name of the key that is missing or unknown.
    pub keyword: String,
}

impl Validator<'_> {
    /// Returns `true` if a value fits a part of the schema.
    ///
    /// # Panics
    /// If the schema has a keyword that this validator does not know. Ignoring it would skip a check.
    pub fn accepts(&self, schema: &Value, value: &Value) -> bool {
        self.misfit(schema, value, "").is_none()
    }

    /// Returns the first part of the value at `at` that does not fit.
    ///
    /// # Panics
    /// As [`accepts`](Self::accepts).
    pub fn misfit(&self, schema: &Value, value: &Value, at: &str) -> Option<Misfit> {
        let Some(keywords) = schema.as_object() else {
            return (schema == &Value::Bool(false)).then(|| misfit(at, "false"));
        };
        keywords
            .iter()
            .find_map(|(keyword, argument)| self.broken(keywords, keyword, argument, value, at))
    }

    fn broken(
        &self,
        keywords: &Map<String, Value>,
        keyword: &str,
        argument: &Value,
        value: &Value,
        at: &str,
    ) -> Option<Misfit> {
        let below = |key: &str| {
            if at.is_empty() {
                key.to_owned()
            } else {
                format!("{at}.{key}")
            }
        };
        match keyword {
            "$ref" => {
                let path = argument.as_str().and_then(|path| path.strip_prefix('#'));
                let target = path.and_then(|path| self.root.pointer(path));
                self.misfit(target.expect("a definition"), value, at)
            }
            "allOf" => list(argument).find_map(|schema| self.misfit(schema, value, at)),
            "if" => {
                let fits = self.accepts(argument, value);
                let branch = keywords.get(if fits { "then" } else { "else" })?;
                self.misfit(branch, value, at)
            }
            "items" => value
                .as_array()?
                .iter()
                .enumerate()
                .find_map(|(index, item)| self.misfit(argument, item, &below(&index.to_string()))),
            "prefixItems" => {
                let pairs = list(argument).zip(value.as_array()?).enumerate();
                pairs.into_iter().find_map(|(index, (schema, item))| {
                    self.misfit(schema, item, &below(&index.to_string()))
                })
            }
            "required" => {
                let entries = value.as_object()?;
                let mut names = list(argument).filter_map(Value::as_str);
                let name = names.find(|name| !entries.contains_key(*name))?;
                Some(misfit(at, &format!("required {name}")))
            }
            "properties" => {
                let entries = value.as_object()?;
                let properties = argument.as_object().expect("an object");
                properties.iter().find_map(|(name, schema)| {
                    self.misfit(schema, entries.get(name)?, &below(name))
                })
            }
            "additionalProperties" => {
                let known = keywords.get("properties").and_then(Value::as_object);
                let is_known = |name: &str| known.is_some_and(|known| known.contains_key(name));
                let entries = value.as_object()?.iter();
                entries
                    .filter(|(name, _)| !is_known(name))
                    .find_map(|(name, value)| {
                        if argument == &Value::Bool(false) {
                            return Some(misfit(at, &format!("additionalProperties {name}")));
                        }
                        self.misfit(argument, value, &below(name))
                    })
            }
            "propertyNames" => value.as_object()?.keys().find_map(|name| {
                let fits = self.accepts(argument, &Value::String(name.clone()));
                (!fits).then(|| misfit(at, &format!("propertyNames {name}")))
            }),
            _ => (!self.holds(keyword, argument, value)).then(|| misfit(at, keyword)),
        }
    }

    /// Returns `true` if the value fits a keyword whose misfit lies at the value itself.
    fn holds(&self, keyword: &str, argument: &Value, value: &Value) -> bool {
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
            | "examples"
            | "then"
            | "else" => true,
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
            "not" => !self.accepts(argument, value),
            "anyOf" => list(argument).any(|schema| self.accepts(schema, value)),
            "oneOf" => {
                let fitting = list(argument).filter(|schema| self.accepts(schema, value));
                fitting.count() == 1
            }
            "minItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) >= count),
            "maxItems" => value
                .as_array()
                .is_none_or(|items| Some(items.len()) <= count),
            "minProperties" => value
                .as_object()
                .is_none_or(|entries| Some(entries.len()) >= count),
            other => panic!("the keyword {other} is new here"),
        }
    }
}

fn misfit(at: &str, keyword: &str) -> Misfit {
    Misfit {
        at: at.to_owned(),
        keyword: keyword.to_owned(),
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
