//! Checks values against the constraints of the spec.

use crate::plan::FieldPlan;
use crate::tree::{Node, Value};
use fc_runtime::json::{BodyError, BodyErrorKind, Reader};
use fc_spec::model::{Argument, Constraints, Judged, Number};

/// Checks the fields of the object that begins at `start`, in the order of the spec.
pub(crate) fn check(
    fields: &[FieldPlan<'_>],
    nodes: &[Node<'_>],
    start: &Reader<'_>,
) -> Result<(), BodyError> {
    let mut values: Vec<Option<&Value<'_>>> = vec![None; fields.len()];
    for node in nodes {
        if let Some(place) = values.get_mut(node.slot) {
            *place = Some(&node.value);
        }
    }
    for (field, value) in fields.iter().zip(values) {
        if let Some(value) = value
            && let Some(constraints) = field.constraints
            && let Some((fault, detail)) = broken(constraints, value)
        {
            return Err(start.fault(fault, detail).in_key(field.wire));
        }
    }
    Ok(())
}

/// Returns the first constraint that a value breaks. An absent value breaks none.
fn broken(constraints: &Constraints, value: &Value<'_>) -> Option<(BodyErrorKind, String)> {
    let value = judged(value)?;
    constraints.iter().find_map(|constraint| {
        let message = constraint.broken(&value)?;
        let kind = match constraint.argument() {
            Argument::Number(_) | Argument::Values(_) => BodyErrorKind::OutOfRange,
            Argument::Range(..) => BodyErrorKind::BadLength,
            Argument::Pattern(_) => BodyErrorKind::BadPattern,
        };
        Some((kind, message.en))
    })
}

/// Returns the part of a value that constraints judge.
fn judged<'v>(value: &'v Value<'_>) -> Option<Judged<'v>> {
    Some(match value {
        Value::Int(value) => Judged::Number(Number::Int(*value)),
        Value::Float(value) => Judged::Number(Number::Float(*value)),
        Value::Text(text) => Judged::String(text),
        Value::Bytes(bytes) => Judged::Bytes(bytes.len()),
        Value::List(items) => Judged::Items(items.len()),
        Value::Enum { wire, .. } => Judged::EnumValue(wire.clone()),
        _ => return None,
    })
}
