//! The named types of a model, and the references to them.
//!
//! **Architecture invariant.** A model has no name that is looked up: what refers to a type holds its id, and
//! [`Types`] answers without a case in which nothing is found. Only [`Model::link`] gives ids out, and it
//! refuses a model in which a name stands for nothing.

use super::{Envelope, Messages, Model, Operation, StructType, Table, Type, TypeDef, TypeShape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::HashMap;
use std::fmt;
use std::ops::Deref;

/// Which of a model's types it is: its index in [`Types`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeId(u32);

impl TypeId {
    /// Of a reference that is not linked yet.
    const NONE: Self = Self(u32::MAX);

    /// Where the type is in [`Types`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A reference to a struct, enum or one-of. In a dump it is its name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeRef {
    id: TypeId,
    name: String,
}

/// A reference to a struct. In a dump it is its name.
#[derive(
    Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(transparent)]
pub struct StructRef(TypeRef);

impl TypeRef {
    /// A reference by name, which [`Model::link`] has to complete.
    pub(crate) fn named(name: impl Into<String>) -> Self {
        Self {
            id: TypeId::NONE,
            name: name.into(),
        }
    }

    /// Name of the type.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Which type it is.
    #[must_use]
    pub fn id(&self) -> TypeId {
        self.id
    }
}

impl StructRef {
    /// A reference by name, which [`Model::link`] has to complete.
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

impl JsonSchema for TypeRef {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "TypeRef".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string" })
    }
}

/// Every named type of a model, in the order in which they were written.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Types(Vec<TypeDef>);

impl Types {
    /// The types of a model that is about to be linked.
    pub(crate) fn new(types: Vec<TypeDef>) -> Self {
        Self(types)
    }

    /// The type of this name, if there is one: for a name that a person has typed.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&TypeDef> {
        self.0.iter().find(|ty| ty.name == name)
    }

    /// What a reference stands for.
    #[must_use]
    #[expect(
        clippy::indexing_slicing,
        reason = "`Model::link` gives the ids out, for these types"
    )]
    pub fn get(&self, reference: &TypeRef) -> &TypeDef {
        &self.0[reference.id.index()]
    }

    /// The struct that a reference stands for.
    #[must_use]
    pub fn structure(&self, reference: &StructRef) -> &StructType {
        match &self.get(reference).shape {
            TypeShape::Struct(shape) => shape,
            #[expect(clippy::unreachable, reason = "`Model::link` links structs only")]
            TypeShape::Enum(_) | TypeShape::OneOf(_) => unreachable!("`{reference}` is linked"),
        }
    }
}

impl Deref for Types {
    type Target = [TypeDef];

    fn deref(&self) -> &[TypeDef] {
        &self.0
    }
}

impl<'a> IntoIterator for &'a Types {
    type Item = &'a TypeDef;
    type IntoIter = std::slice::Iter<'a, TypeDef>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

/// A name that stands for nothing, and who uses it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unlinked {
    /// What is missing: ``the type `Station` ``.
    pub missing: String,
    /// Who names it.
    pub user: String,
}

impl Model {
    /// Gives every reference its id.
    ///
    /// # Errors
    ///
    /// [`Unlinked`] if one names a type that is not in the model, or no struct where there has to be one. A
    /// checked spec has no such name.
    pub(crate) fn link(mut self) -> Result<Self, Unlinked> {
        let missing = link(
            &mut self.types,
            &mut self.operations,
            &mut self.tables,
            Some(&mut self.envelope),
        );
        missing.map_or(Ok(self), Err)
    }
}

/// Gives every reference its id, and leaves out what refers to something that is not there: the first such name.
pub(crate) fn link(
    types: &mut Types,
    operations: &mut Vec<Operation>,
    tables: &mut Vec<Table>,
    envelope: Option<&mut Envelope>,
) -> Option<Unlinked> {
    let ids = Linker::new(types);
    let mut missing = None;
    let mut is_linked = |linked: Result<(), String>, user: &dyn Fn() -> String| {
        let is_linked = linked.is_ok();
        if let (Err(name), None) = (linked, &missing) {
            missing = Some(Unlinked {
                missing: name,
                user: user(),
            });
        }
        is_linked
    };
    for ty in &mut types.0 {
        let owner = &ty.name;
        match &mut ty.shape {
            TypeShape::Struct(shape) => shape.fields.retain_mut(|field| {
                let linked = ids.link_in(&mut field.ty);
                is_linked(linked, &|| format!("`{owner}.{}`", field.wire))
            }),
            TypeShape::OneOf(choice) => choice.variants.retain_mut(|variant| {
                let linked = ids.link_struct(&mut variant.ty);
                is_linked(linked, &|| format!("`{owner}.{}`", variant.name))
            }),
            TypeShape::Enum(_) => {}
        }
    }
    tables.retain_mut(|table| {
        let linked = ids.link_struct(&mut table.row);
        is_linked(linked, &|| format!("the table `{}`", table.id))
    });
    operations.retain_mut(|operation| {
        let name = &operation.name;
        let messages = operation.exchange.messages_mut();
        messages.is_none_or(|Messages { request, response }| {
            let request = ids.link_struct(&mut request.ty);
            let linked = request.and(ids.link_struct(&mut response.ty));
            is_linked(linked, &|| format!("`{name}`"))
        })
    });
    let sides = envelope
        .into_iter()
        .flat_map(|it| [&mut it.request, &mut it.response]);
    for fields in sides {
        fields.retain_mut(|field| {
            let linked = ids.link_in(&mut field.ty);
            is_linked(linked, &|| format!("the envelope's `{}`", field.wire))
        });
    }
    missing
}

/// The ids of the types, and which of them are structs.
struct Linker(HashMap<String, (TypeId, bool)>);

impl Linker {
    fn new(types: &Types) -> Self {
        let entries = types.iter().zip(0..).map(|(ty, index)| {
            let is_struct = matches!(ty.shape, TypeShape::Struct(_));
            (ty.name.clone(), (TypeId(index), is_struct))
        });
        Self(entries.collect())
    }

    /// Whether it is a struct; or what is missing.
    fn link(&self, reference: &mut TypeRef) -> Result<bool, String> {
        let known = self.0.get(&reference.name);
        let &(id, is_struct) = known.ok_or_else(|| format!("the type `{reference}`"))?;
        reference.id = id;
        Ok(is_struct)
    }

    fn link_in(&self, ty: &mut Type) -> Result<(), String> {
        let reference = ty.innermost_mut();
        reference.map_or(Ok(()), |reference| self.link(reference).map(drop))
    }

    fn link_struct(&self, reference: &mut StructRef) -> Result<(), String> {
        if self.link(&mut reference.0)? {
            Ok(())
        } else {
            Err(format!("the struct `{reference}`"))
        }
    }
}
