//! Fields that contradict their conditions. A receiver accepts them unchanged.

use super::case::Case;
use super::edit::{get, removed, replaced};
use super::sites::{Site, shape_of, sites};
use crate::sample::constraint::on_the_wire;
use fc_spec::model::{Asked, Condition, Field, StructRef, Type, TypeShape, Value};

/// Returns a message for each optional field that contradicts its condition. The field is missing although the
/// condition holds, or present although it does not. `full` has every field whose condition holds.
pub(super) fn messages(case: &Case<'_, '_>, ty: &StructRef, full: &Value) -> Vec<Value> {
    let mut entries = Vec::new();
    for site in sites(case.samples, ty, full) {
        let condition = site.field.details().condition.as_ref();
        let Some(condition) = condition.filter(|_| site.field.optional && !site.is_item) else {
            continue;
        };
        let mut push = |contradiction: &str, body: Value| {
            let name = format!("condition_{}_{contradiction}", site.path);
            entries.push(case.accepted_as(&name, body.clone(), &body));
        };
        if !site.present {
            let value = case.samples.value_of(site.field);
            push("unasked", replaced(full, &site.path, value));
            continue;
        }
        push("missing", removed(full, &site.path));
        if let Some(body) = contradicted(case, &site, condition, full) {
            push("unasked", body);
        }
    }
    entries
}

/// Returns the message with another value of a field in the condition, so that the condition no longer holds.
fn contradicted(
    case: &Case<'_, '_>,
    site: &Site<'_>,
    condition: &Condition,
    full: &Value,
) -> Option<Value> {
    let object = site.path.parent();
    condition.asked().iter().find_map(|Asked { wire, .. }| {
        let field = site.beside.field(wire)?;
        let path = object.key(wire);
        let mut bodies = values(case, field)
            .into_iter()
            .map(|value| replaced(full, &path, value));
        bodies.find(|body| get(body, &object).is_some_and(|object| !condition.holds(object)))
    })
}

/// Returns all values of a field with a bool or an enum.
fn values(case: &Case<'_, '_>, field: &Field) -> Vec<Value> {
    let only = &field.details().constraints.only;
    match (&field.ty, shape_of(case.samples, &field.ty)) {
        (Type::Bool, _) => {
            let both = [true, false].map(Value::Bool);
            both.map(|value| on_the_wire(value, field.wire_form)).into()
        }
        (_, Some(TypeShape::Enum(shape))) => {
            let wires = shape.values.iter().map(|value| &value.wire);
            let taken = wires.filter(|wire| only.is_empty() || only.contains(wire));
            taken.map(Value::from).collect()
        }
        _ => Vec::new(),
    }
}
