//! The paths in the dump of a thing, from the JSON Schema of the dump.

use super::project_rules::GROUPS;
use crate::language::grammar as language;
use crate::model::{EnumValue, Field, Group, Operation, TypeDef, Variant};
use schemars::{Schema, schema_for};
use serde_json::Value;
use std::collections::BTreeMap;

/// The maximum number of references followed from one place. The schema has no chain of this length.
const DEPTH: u8 = 16;

/// The schema of the output of `fcproto inspect` for one kind of thing.
pub(super) struct Shape(Schema);

impl Shape {
    /// Returns the schema of a kind of thing.
    pub fn of(kind: &str) -> Self {
        let [operations, types] = GROUPS.map(|(_, kinds)| kinds.contains(&kind));
        Self(match kind {
            _ if operations => schema_for!(Operation),
            _ if types => schema_for!(TypeDef),
            _ if kind == language::Group::TABLE.name => schema_for!(Group),
            _ if kind == language::Field::TABLE.name => schema_for!(Field),
            _ if kind == language::EnumValue::TABLE.name => schema_for!(EnumValue),
            _ => schema_for!(Variant),
        })
    }

    /// Returns the start of every path.
    pub fn root(&self) -> At<'_> {
        At {
            shape: self,
            nodes: self.flat(self.0.as_value(), DEPTH),
        }
    }

    /// Returns the schemas that a place can have, with references and alternatives resolved.
    fn flat<'s>(&'s self, node: &'s Value, depth: u8) -> Vec<&'s Value> {
        let Some(depth) = depth.checked_sub(1) else {
            return Vec::new();
        };
        let mut nodes = vec![node];
        if let Some(reference) = node.get("$ref").and_then(Value::as_str) {
            let pointer = reference.trim_start_matches('#');
            let target = self.0.as_value().pointer(pointer).into_iter();
            nodes.extend(target.flat_map(|target| self.flat(target, depth)));
        }
        for key in ["allOf", "anyOf", "oneOf"] {
            let each = node.get(key).and_then(Value::as_array).into_iter();
            nodes.extend(each.flatten().flat_map(|node| self.flat(node, depth)));
        }
        nodes
    }
}

/// A place in a dump.
pub(super) struct At<'s> {
    shape: &'s Shape,
    nodes: Vec<&'s Value>,
}

impl<'s> At<'s> {
    /// Returns the keys at this place, each with the place below it.
    pub fn keys(&self) -> BTreeMap<&'s str, Self> {
        let mut keys: BTreeMap<&str, Self> = BTreeMap::new();
        for node in &self.nodes {
            let properties = node.get("properties").and_then(Value::as_object);
            for (key, node) in properties.into_iter().flatten() {
                let at = keys.entry(key).or_insert(At {
                    shape: self.shape,
                    nodes: Vec::new(),
                });
                at.nodes.extend(self.shape.flat(node, DEPTH));
            }
        }
        keys
    }

    /// Returns `true` if the value can be a list.
    pub fn is_list(&self) -> bool {
        let is = |ty: &Value| ty.as_str() == Some("array");
        self.nodes.iter().any(|node| {
            let ty = node.get("type");
            ty.is_some_and(|ty| is(ty) || ty.as_array().is_some_and(|all| all.iter().any(is)))
        })
    }

    /// Returns the words that the value can be. The list is empty if it can also be another value.
    pub fn words(&self) -> Vec<&'s str> {
        let mut words = Vec::new();
        for node in &self.nodes {
            if let Some(word) = node.get("const").and_then(Value::as_str) {
                words.push(word);
            } else if let Some(each) = node.get("enum").and_then(Value::as_array) {
                words.extend(each.iter().filter_map(Value::as_str));
            } else if node.get("type").is_some_and(|ty| *ty != "null") {
                return Vec::new();
            }
        }
        words
    }
}
