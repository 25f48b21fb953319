//! Reduces an operation to the part for one audience.

use super::View;
use crate::model::process::{Find, way};
use crate::model::{
    Accepted, AcceptedIn, EnumType, Exchange, KeyPath, Operation, StructRef, Type, TypeRef, Types,
    Value,
};
use std::collections::HashSet;

impl View<'_> {
    /// Removes references to operations outside `names` and references to keys for other audiences.
    pub(super) fn operation(&self, operation: &mut Operation, names: &HashSet<String>) {
        if let Some(deprecated) = &mut operation.deprecated {
            let by = deprecated.replaced_by.take();
            deprecated.replaced_by = by.filter(|name| names.contains(name));
        }
        match &mut operation.exchange {
            Exchange::Command {
                sets_off,
                accepted,
                messages,
                ..
            } => {
                sets_off.retain(|set_off| names.contains(&set_off.report));
                for set_off in sets_off {
                    let report = self.model.operation(&set_off.report);
                    let report = report.and_then(Operation::messages);
                    // The command still sets off the report if the key that ties them is for other audiences.
                    set_off.tied.retain(|tie| {
                        let ours = self.leads(&messages.body(tie.side).ty, keys(&tie.command));
                        let theirs = |body| self.leads(body, keys(&tie.report));
                        ours && report.is_some_and(|report| theirs(&report.request.ty))
                    });
                }
                if let Some(accepted) = accepted {
                    accepted.after.retain(|name| names.contains(name));
                    if let Some(AcceptedIn::States(sets)) = &mut accepted.states {
                        for set in sets {
                            let ty = Type::Named(TypeRef::clone(&set.ty));
                            set.values
                                .retain(|value| self.value(&Value::from(value), &ty).is_some());
                        }
                    }
                }
            }
            Exchange::Report {
                cadence,
                state,
                failures,
                messages,
                ..
            } => {
                let body = &messages.request.ty;
                *state = state.take().filter(|path| self.leads(body, keys(path)));
                failures.retain(|path| self.leads(body, keys(path)));
                *cadence = cadence.take().filter(|cadence| {
                    let field = cadence.field();
                    field.is_none_or(|path| self.leads(body, path.split('.')))
                });
            }
            Exchange::Stream(stream) => {
                for command in [&mut stream.started_by, &mut stream.stopped_by] {
                    *command = command.take().filter(|name| names.contains(name));
                }
            }
        }
    }

    /// Returns `true` if the audience has every field on the path.
    fn leads<'k>(&self, body: &StructRef, keys: impl Iterator<Item = &'k str>) -> bool {
        let mut shape = Some(self.model.types.structure(body));
        for key in keys {
            let Some(holder) = shape else { return false };
            let Some(field) = holder
                .field(key)
                .filter(|field| self.has_field(holder, field))
            else {
                return false;
            };
            let inside = field.ty.innermost();
            shape = inside.and_then(|named| self.model.types.get(named).shape.structure());
        }
        true
    }
}

/// Removes conditions on states, and paths to states, that the reduced model no longer has.
pub(super) fn keep_states(operation: &mut Operation, types: &Types) {
    match &mut operation.exchange {
        Exchange::Command { accepted, .. } => {
            *accepted = accepted.take().and_then(|it| keep_accepted(it, types));
        }
        Exchange::Report {
            state,
            failures,
            messages,
            ..
        } => {
            let at = |path: &KeyPath| enum_at(types, &messages.request.ty, path);
            *state = (state.take()).filter(|path| at(path).is_some_and(EnumType::is_process));
            failures.retain(|path| at(path).is_some_and(EnumType::has_failures));
        }
        Exchange::Stream(_) => {}
    }
}

fn keep_accepted(mut accepted: Accepted, types: &Types) -> Option<Accepted> {
    if let Some(AcceptedIn::States(sets)) = &mut accepted.states {
        sets.retain(|set| !set.values.is_empty() && types.named(set.ty.name()).is_some());
        if sets.is_empty() {
            accepted.states = None;
        }
    }
    let says_nothing = accepted.states.is_none() && accepted.after.is_empty();
    (!says_nothing).then_some(accepted)
}

/// Returns the enum at the path of a body. It finds types by name, because the reduced model is not linked yet.
fn enum_at<'t>(types: &'t Types, body: &StructRef, path: &[String]) -> Option<&'t EnumType> {
    let find: Find<'_, 't> = &|named| types.named(named.name());
    let shape = find(body)?.shape.structure()?;
    match &way(find, shape, path)?.last()?.ty {
        Type::Named(named) => find(named)?.shape.enumeration(),
        _ => None,
    }
}

fn keys(path: &[String]) -> impl Iterator<Item = &str> {
    path.iter().map(String::as_str)
}
