//! The reports that a command sets off: the keys that tie them to the command, and the keys with the state of the process.

use super::body::{EnumType, Field, StructType, Type, TypeDef, TypeShape};
use super::{Exchange, Model, Operation, StructRef, TypeRef, Unlinked};
use crate::vocabulary::Direction;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The wire keys from a body through objects to a field, such as `["data", "status"]`.
pub type KeyPath = Vec<String>;

/// A report that a command sets off.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SetOff {
    /// Name of the report.
    pub report: String,
    /// Keys that tie a report to a call. Empty if no key in the messages ties them.
    pub tied: Vec<Tie>,
}

/// A key of a command and the key of a report that has the same value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Tie {
    /// Message of the command that has the key.
    pub side: Direction,
    /// The key of the command.
    pub command: KeyPath,
    /// The key of the report.
    pub report: KeyPath,
}

impl EnumType {
    /// Returns `true` if the values are states of a process: they have an order, or a value is final.
    #[must_use]
    pub fn is_process(&self) -> bool {
        self.order.is_some() || self.values.iter().any(|value| value.is_final)
    }

    /// Returns `true` if a value is an error.
    #[must_use]
    pub fn has_failures(&self) -> bool {
        self.values.iter().any(|value| value.is_error)
    }
}

/// The lookup of a named type.
pub(crate) type Find<'f, 't> = &'f dyn Fn(&TypeRef) -> Option<&'t TypeDef>;

/// Returns the fields on a path from a struct. `None` if the path does not exist or leads through something other than objects.
pub(crate) fn way<'t>(
    find: Find<'_, 't>,
    from: &'t StructType,
    keys: &[String],
) -> Option<Vec<&'t Field>> {
    let mut shape = Some(from);
    let mut fields = Vec::new();
    for key in keys {
        let field = shape?.fields.iter().find(|field| field.wire == *key)?;
        fields.push(field);
        shape = match &field.ty {
            Type::Named(named) => find(named).and_then(|ty| ty.shape.structure()),
            _ => None,
        };
    }
    (!fields.is_empty()).then_some(fields)
}

/// The maximum number of fields to inspect in one body. The check reports larger bodies anyway.
const MOST_FIELDS: usize = 10_000;

/// Returns every field with a single enum value outside lists, and its path.
pub(crate) fn enums<'t>(find: Find<'_, 't>, from: &'t StructType) -> Vec<(KeyPath, &'t EnumType)> {
    let mut found = Vec::new();
    // Each entry holds the types on its path, so that a recursive type ends the search.
    let mut open: Vec<(KeyPath, Vec<&str>, &StructType)> = vec![(Vec::new(), Vec::new(), from)];
    let mut left = MOST_FIELDS;
    while let Some((path, within, shape)) = open.pop() {
        let mut inner = Vec::new();
        for field in &shape.fields {
            let Some(rest) = left.checked_sub(1) else {
                return found;
            };
            left = rest;
            let Type::Named(named) = &field.ty else {
                continue;
            };
            let Some(ty) = find(named).filter(|ty| !within.contains(&ty.name.as_str())) else {
                continue;
            };
            let path: KeyPath = path.iter().chain([&field.wire]).cloned().collect();
            match &ty.shape {
                TypeShape::Enum(shape) => found.push((path, shape)),
                TypeShape::Struct(shape) => {
                    let within = within.iter().copied().chain([ty.name.as_str()]);
                    inner.push((path, within.collect(), shape));
                }
                TypeShape::OneOf(_) => {}
            }
        }
        open.extend(inner.into_iter().rev());
    }
    found
}

impl Model {
    /// Returns the fields on a path from a body. Empty if the path does not exist.
    #[must_use]
    pub fn way(&self, body: &StructRef, keys: &[String]) -> Vec<&Field> {
        let find = |named: &TypeRef| Some(self.types.get(named));
        way(&find, self.types.structure(body), keys).unwrap_or_default()
    }

    /// Returns the enum at a path of a body, with its reference.
    #[must_use]
    pub fn enum_at(&self, body: &StructRef, keys: &[String]) -> Option<(&TypeRef, &EnumType)> {
        let Type::Named(named) = &self.way(body, keys).last()?.ty else {
            return None;
        };
        Some((named, self.types.get(named).shape.enumeration()?))
    }

    /// Checks that every key in the process data of an operation exists in its messages.
    pub(super) fn check_ways(&self) -> Result<(), Unlinked> {
        for operation in &self.operations {
            let missing = |operation: &Operation, keys: &KeyPath| Unlinked {
                missing: format!("the key `{}`", keys.join(".")),
                user: format!("`{}`", operation.name),
            };
            let Some(messages) = operation.messages() else {
                continue;
            };
            if let Exchange::Report {
                state, failures, ..
            } = &operation.exchange
            {
                let mut keys = state.iter().chain(failures);
                let body = &messages.request.ty;
                if let Some(keys) = keys.find(|keys| self.enum_at(body, keys).is_none()) {
                    return Err(missing(operation, keys));
                }
            }
            for SetOff { report, tied } in operation.sets_off() {
                let report = self.operation(report).and_then(Operation::messages);
                for tie in tied {
                    if self
                        .way(&messages.body(tie.side).ty, &tie.command)
                        .is_empty()
                    {
                        return Err(missing(operation, &tie.command));
                    }
                    if report.is_none_or(|it| self.way(&it.request.ty, &tie.report).is_empty()) {
                        return Err(missing(operation, &tie.report));
                    }
                }
            }
        }
        Ok(())
    }
}
