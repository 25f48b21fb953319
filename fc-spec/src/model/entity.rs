//! Entities, from `entities:`.

use super::{Location, Model, Text, Type};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A kind of thing that has ids, to which fields refer.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Entity {
    /// Name, such as `station`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Model {
    /// Returns the type of the ids of an entity, which is the type of every field that refers to it. A checked model has exactly one.
    #[must_use]
    pub fn id_type(&self, entity: &Entity) -> Option<&Type> {
        let structs = self.types.iter().filter_map(|ty| ty.shape.structure());
        let mut fields = structs.flat_map(|shape| &shape.fields);
        let field = fields.find(|field| field.details().refers.as_ref() == Some(&entity.name))?;
        Some(field.ty.item())
    }
}
