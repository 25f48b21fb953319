//! Checks values against the constraints of the spec.

use crate::plan::FieldPlan;
use crate::tree::{Node, Value};
use fc_runtime::json::{BodyError, BodyErrorKind, Reader};
use fc_spec::model::{self, Constraint, Number, Scalar};
use std::cmp::Ordering;

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
            && let Some((fault, detail)) = broken(field, value)
        {
            return Err(start.fault(fault, detail).in_key(field.wire));
        }
    }
    Ok(())
}

/// Returns the first constraint that a value breaks. An absent value breaks none.
fn broken(field: &FieldPlan<'_>, value: &Value<'_>) -> Option<(BodyErrorKind, String)> {
    let mut constraints = field.constraints.iter();
    constraints.find_map(|constraint| match *constraint {
        Constraint::Min(min) => {
            let is_below = compare(value, min).is_some_and(Ordering::is_lt);
            is_below.then(|| out_of_range("at least", min))
        }
        Constraint::Max(max) => {
            let is_above = compare(value, max).is_some_and(Ordering::is_gt);
            is_above.then(|| out_of_range("at most", max))
        }
        Constraint::Length(least, most) => {
            let length = length(value)?;
            let detail = || format!("the length is {length}; it must be from {least} to {most}");
            let fits = (least..=most).contains(&length);
            (!fits).then(|| (BodyErrorKind::BadLength, detail()))
        }
        Constraint::Pattern(source) => {
            let Value::Text(text) = value else {
                return None;
            };
            // The patterns of a checked model compile. A pattern that does not compile matches nothing.
            let regex = field.pattern.as_ref();
            let fits = regex.is_some_and(|regex| regex.is_match(text));
            let detail = || format!("the string must match `{source}` as a whole");
            (!fits).then(|| (BodyErrorKind::BadPattern, detail()))
        }
        Constraint::Only(taken) => {
            let Value::Enum { wire, .. } = value else {
                return None;
            };
            (!taken.contains(wire)).then(|| (BodyErrorKind::OutOfRange, not_taken(taken)))
        }
    })
}

fn out_of_range(relation: &str, limit: &Number) -> (BodyErrorKind, String) {
    let limit = match limit {
        Number::Int(limit) => limit.to_string(),
        Number::Float(limit) => format!("{limit:?}"),
    };
    let detail = format!("the number must be {relation} {limit}");
    (BodyErrorKind::OutOfRange, detail)
}

/// Returns the message for a value that is not in the list.
fn not_taken(taken: &[Scalar]) -> String {
    let taken: Vec<String> = taken
        .iter()
        .map(|value| match value {
            Scalar::String(text) => text.clone(),
            other => model::Value::from(other).to_string(),
        })
        .collect();
    format!("the value must be one of: {}", taken.join(", "))
}

/// Compares a number with a limit. The comparison is exact if both are integers.
fn compare(value: &Value<'_>, limit: &Number) -> Option<Ordering> {
    match (value, limit) {
        (Value::Int(value), Number::Int(limit)) => Some(value.cmp(limit)),
        (Value::Int(value), limit) => Number::Int(*value).to_f64().partial_cmp(&limit.to_f64()),
        (Value::Float(value), limit) => value.partial_cmp(&limit.to_f64()),
        _ => None,
    }
}

/// Returns the number of characters of a string, items of a list, or bytes of base64.
fn length(value: &Value<'_>) -> Option<u64> {
    let length = match value {
        Value::Text(text) => text.chars().count(),
        Value::Bytes(bytes) => bytes.len(),
        Value::List(items) => items.len(),
        _ => return None,
    };
    Some(u64::try_from(length).unwrap_or(u64::MAX))
}
