//! Coordinate systems and stores, from `coordinates:` and `stores:`.

use super::{Field, Location, Model, Text, TypeShape};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A coordinate system, in which structs give their values.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct CoordinateSystem {
    /// Name, such as `map`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// What it is called.
    #[serde(flatten)]
    pub title: Text,
    /// Where its origin is and how its axes lie.
    pub about: Option<Text>,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}

/// A place where things are kept.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Store {
    /// Name, such as `config_file`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// What it is called.
    #[serde(flatten)]
    pub title: Text,
    /// More about it.
    pub about: Option<Text>,
    /// Whether what is kept there is still there after a restart; `None` where nothing is known.
    pub survives_restart: Option<bool>,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Model {
    /// Returns the coordinate system with this name, if there is one.
    #[must_use]
    pub fn coordinate_system(&self, name: &str) -> Option<&CoordinateSystem> {
        self.coordinates.iter().find(|system| system.name == name)
    }

    /// Returns the store with this name, if there is one.
    #[must_use]
    pub fn store(&self, name: &str) -> Option<&Store> {
        self.stores.iter().find(|store| store.name == name)
    }

    /// Returns the name of the coordinate system of the objects in a field. The field overrides the struct.
    #[must_use]
    pub fn coordinates_of<'m>(&'m self, field: &'m Field) -> Option<&'m str> {
        let own = field.details().coordinates.as_deref();
        let of_type = || match &self.types.get(field.ty.innermost()?).shape {
            TypeShape::Struct(shape) => shape.coordinates.as_deref(),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        };
        own.or_else(of_type)
    }
}
