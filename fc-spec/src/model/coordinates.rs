//! Coordinate systems and stores, from `coordinates:` and `stores:`.

use super::{Field, Location, Model, Text};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A coordinate system for the values of structs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct CoordinateSystem {
    /// Name, such as `map`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Origin and axes; `null` if not described.
    pub about: Option<Text>,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

/// A store: a place where the robot keeps values.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Store {
    /// Name, such as `config_file`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Longer description.
    pub about: Option<Text>,
    /// `true` if its content survives a restart; `null` if unknown.
    pub survives_restart: Option<bool>,
    /// Position in the spec: file, name and line.
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
        let of_type = || {
            let ty = self.types.get(field.ty.innermost()?);
            ty.shape.structure()?.coordinates.as_deref()
        };
        own.or_else(of_type)
    }
}
