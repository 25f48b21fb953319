//! Compares the values that two fields accept.

use crate::rule::Wire;
use fc_spec::model::{Field, FieldDetails, IntKind, Number, Quirk, Scalar, Type};
use std::cmp::Ordering;

/// The smallest and the largest number. `None` means no limit.
pub(super) type Interval = (Option<Number>, Option<Number>);

/// Returns the numbers that a type holds within the limits of a field, or `None` for a type without numbers.
pub(super) fn interval(ty: &Type, details: &FieldDetails) -> Option<Interval> {
    let (mut least, mut most) = match ty {
        Type::Int(kind) => of_integers(*kind),
        // Timestamps are integers in messages.
        Type::TimestampMs | Type::TimestampS => of_integers(IntKind::I64),
        Type::Float(_) => (None, None),
        _ => return None,
    };
    for (end, limit, keeps) in [
        (&mut least, &details.constraints.min, Ordering::Less),
        (&mut most, &details.constraints.max, Ordering::Greater),
    ] {
        if let Some(limit) = limit
            && end.as_ref().is_none_or(|end| compare(end, limit) == keeps)
        {
            *end = Some(limit.clone());
        }
    }
    Some((least, most))
}

/// Returns the numbers that a type of integers holds.
pub(super) fn of_integers(kind: IntKind) -> Interval {
    let (least, most) = kind.range();
    (Some(Number::Int(least)), Some(Number::Int(most)))
}

/// Returns `true` if `outer` contains all of `inner`.
pub(super) fn within(inner: &Interval, outer: &Interval) -> bool {
    let ends = |inner: &Option<Number>, outer: &Option<Number>, beyond: Ordering| {
        let inner = inner.as_ref();
        let holds = |outer| inner.is_some_and(|inner| compare(inner, outer) != beyond);
        outer.as_ref().is_none_or(holds)
    };
    ends(&inner.0, &outer.0, Ordering::Less) && ends(&inner.1, &outer.1, Ordering::Greater)
}

fn compare(one: &Number, other: &Number) -> Ordering {
    match (one, other) {
        (Number::Int(one), Number::Int(other)) => one.cmp(other),
        _ => one.to_f64().total_cmp(&other.to_f64()),
    }
}

/// Returns `true` if `outer` contains all values of `inner`. An empty list means all values.
pub(super) fn only_within(inner: &[Scalar], outer: &[Scalar]) -> bool {
    outer.is_empty() || (!inner.is_empty() && inner.iter().all(|value| outer.contains(value)))
}

/// Returns the messages that a change of form breaks. A lenient receiver reads both forms.
pub(super) fn forms(old: &Field, new: &Field) -> Wire {
    let is_lenient = |field: &Field| {
        let quirks = &field.details().quirks;
        quirks.contains(&Quirk::LenientNumber) || quirks.contains(&Quirk::LenientBool)
    };
    Wire::of(!is_lenient(new), !is_lenient(old))
}

/// Returns the messages that a change of type breaks, if no other rule judges it. A string accepts any Base64, and JSON
/// accepts any value.
pub(super) fn types(old: &Type, new: &Type) -> Wire {
    let takes = |receiver: &Type, sender: &Type| match (receiver, sender) {
        (Type::Json, _) | (Type::String, Type::Base64) => true,
        (receiver, sender) => receiver == sender,
    };
    Wire::of(!takes(new, old), !takes(old, new))
}
