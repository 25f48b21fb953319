//! The named types of a model, and the linker that sets the ids of references.
//!
//! **Architecture invariant.** Every reference to a type in a model holds the id of the type, so [`Types`] always finds it. Only
//! [`Model::link`](super::Model::link) assigns ids. It refuses a model with a reference to an undeclared thing.

use super::body::{StructType, Type, TypeDef, TypeShape};
use super::operation::{Exchange, Operation};
use super::precondition::{AcceptedIn, StateSet};
use super::process::SetOff;
use super::protocol::{Envelope, Table};
use super::reference::{StructRef, TypeId, TypeRef};
use crate::vocabulary::Kind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::ops::Deref;

/// Every named type of a model, in the order in which they were written.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Types(Vec<TypeDef>);

impl Types {
    /// Returns the types of a model that is not linked yet.
    pub(crate) fn new(types: Vec<TypeDef>) -> Self {
        Self(types)
    }

    /// Returns the type with this name, if there is one. Use it for names from user input.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&TypeDef> {
        self.0.iter().find(|ty| ty.name == name)
    }

    /// Returns the type of a reference.
    #[must_use]
    #[expect(
        clippy::indexing_slicing,
        reason = "`Model::link` gives the ids out, for these types"
    )]
    pub fn get(&self, reference: &TypeRef) -> &TypeDef {
        &self.0[reference.id().index()]
    }

    /// Returns the struct of a reference.
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

/// A reference to an undeclared thing, and its user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unlinked {
    /// The missing thing: ``the type `Station` ``.
    pub missing: String,
    /// The thing that has the reference.
    pub user: String,
}

/// Sets the id of every reference.
///
/// It removes every part with a reference to an undeclared thing, and returns the first such reference.
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
            TypeShape::Enum(shape) => {
                let names = shape.values.iter().map(|value| value.name.clone());
                let names: HashSet<String> = names.collect();
                for value in &mut shape.values {
                    let from = &value.name;
                    value.then.retain(|next| {
                        let user = || format!("`{owner}.{from}`");
                        is_linked(declared(&names, "value", next), &user)
                    });
                }
            }
        }
    }
    tables.retain_mut(|table| {
        let linked = ids.link_struct(&mut table.row);
        is_linked(linked, &|| format!("the table `{}`", table.id))
    });
    let names = |kind: Kind| -> HashSet<String> {
        let operations = operations.iter().filter(|it| it.kind() == kind);
        operations.map(|it| it.name.clone()).collect()
    };
    let (commands, reports) = (names(Kind::Command), names(Kind::Report));
    for operation in &mut *operations {
        let user = &operation.name;
        let user = || format!("`{user}`");
        match &mut operation.exchange {
            Exchange::Command {
                sets_off, accepted, ..
            } => {
                sets_off.retain(|SetOff { report, .. }| {
                    is_linked(declared(&reports, Kind::Report.name(), report), &user)
                });
                let Some(accepted) = accepted else { continue };
                accepted.after.retain(|name| {
                    is_linked(declared(&commands, Kind::Command.name(), name), &user)
                });
                if let Some(AcceptedIn::States(sets)) = &mut accepted.states {
                    sets.retain_mut(|StateSet { ty, .. }| is_linked(ids.link(ty).map(drop), &user));
                }
            }
            Exchange::Stream(stream) => {
                for by in [&mut stream.started_by, &mut stream.stopped_by] {
                    by.take_if(|name| {
                        !is_linked(declared(&commands, Kind::Command.name(), name), &user)
                    });
                }
            }
            Exchange::Report { .. } => {}
        }
    }
    operations.retain_mut(|operation| {
        let name = &operation.name;
        let bodies = operation.exchange.bodies_mut();
        let linked = bodies.map(|body| ids.link_struct(&mut body.ty));
        let linked = linked.fold(Ok(()), Result::and);
        is_linked(linked, &|| format!("`{name}`"))
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

/// Returns an error that describes the missing thing, unless it is declared.
fn declared(names: &HashSet<String>, kind: &str, name: &str) -> Result<(), String> {
    let is_declared = names.contains(name).then_some(());
    is_declared.ok_or_else(|| format!("the {kind} `{name}`"))
}

/// The ids of the types, each with `true` for a struct.
struct Linker(HashMap<String, (TypeId, bool)>);

impl Linker {
    fn new(types: &Types) -> Self {
        let entries = types.iter().zip(0..).map(|(ty, index)| {
            let is_struct = matches!(ty.shape, TypeShape::Struct(_));
            (ty.name.clone(), (TypeId(index), is_struct))
        });
        Self(entries.collect())
    }

    /// Sets the id of a reference. Returns `true` for a struct. The error describes the missing type.
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
