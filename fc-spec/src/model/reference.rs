//! References to the named types of a model.

use super::schema::fixed_schema;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};
use std::fmt;
use std::ops::Deref;

/// The id of a type: its index in [`Types`](super::Types).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeId(pub(super) u32);

impl TypeId {
    /// The id of a reference that is not linked yet.
    const NONE: Self = Self(u32::MAX);

    /// Returns the index of the type in [`Types`](super::Types).
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A reference to a struct, enum or one-of. In a dump it is the name of the type.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeRef {
    pub(super) id: TypeId,
    pub(super) name: String,
}

/// A reference to a struct. In a dump it is its name.
#[derive(
    Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(transparent)]
pub struct StructRef(pub(super) TypeRef);

impl TypeRef {
    /// Returns a reference by name. [`Model::link`](super::Model::link) sets its id.
    pub(crate) fn named(name: impl Into<String>) -> Self {
        Self {
            id: TypeId::NONE,
            name: name.into(),
        }
    }

    /// Returns the name of the type.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the id of the type.
    #[must_use]
    pub fn id(&self) -> TypeId {
        self.id
    }
}

impl StructRef {
    /// Returns a reference by name. [`Model::link`](super::Model::link) sets its id.
    pub(crate) fn named(name: impl Into<String>) -> Self {
        Self(TypeRef::named(name))
    }
}

impl Deref for StructRef {
    type Target = TypeRef;

    fn deref(&self) -> &TypeRef {
        &self.0
    }
}

impl fmt::Display for TypeRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

impl fmt::Display for StructRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Serialize for TypeRef {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.name.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for TypeRef {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(Self::named)
    }
}

fixed_schema!(TypeRef, { "type": "string" });
