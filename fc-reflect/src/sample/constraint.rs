//! Values of leaf types inside or at the end of a field's constraints.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_spec::model::{EnumType, Field, FloatKind, IntKind, Number, Scalar, Type, Value, WireForm};

/// The maximum length of a composed string, byte sequence or array. Larger upper bounds are not reached.
pub const LONGEST: u64 = 4096;

/// 2⁵³ − 1. Some JSON readers round larger integers.
const LARGEST_SAFE: i128 = 9_007_199_254_740_991;

const SAMPLE_MS: i128 = 1_667_823_500_544;
const SAMPLE_S: i128 = 1_667_739_993;
const SAMPLE_BASE64: &str = "aGVsbG8=";
const SAMPLE_TEXT: &str = "text";

/// The end of a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bound {
    /// Any allowed value.
    None,
    /// The smallest or shortest value.
    Least,
    /// The largest or longest value.
    Most,
}

/// Returns a value of a type without fields. It is not yet in wire form, unless it comes from `given`.
pub(crate) fn leaf(ty: &Type, field: &Field, given: Option<&Value>, bound: Bound) -> Value {
    match ty {
        Type::Bool => match bound {
            Bound::None => given.cloned().unwrap_or(Value::Bool(true)),
            Bound::Least => Value::Bool(false),
            Bound::Most => Value::Bool(true),
        },
        Type::Int(kind) => int(*kind, field, given, bound),
        Type::Float(kind) => float(*kind, field, given, bound),
        Type::String => string(field, given, bound),
        Type::Base64 => base64(field, given, bound),
        Type::TimestampMs => given.cloned().unwrap_or(int_value(SAMPLE_MS)),
        Type::TimestampS => given.cloned().unwrap_or(int_value(SAMPLE_S)),
        // `null` would only mean that the optional field is absent.
        Type::Json if field.optional => given.cloned().unwrap_or_else(any_json),
        Type::Json | Type::Array(_) | Type::Named(_) => given.cloned().unwrap_or(Value::Null),
    }
}

/// Converts a value to its wire form: a number or bool to a string, or a bool to a number.
#[must_use]
pub fn on_the_wire(value: Value, form: WireForm) -> Value {
    match (form, value) {
        (WireForm::String | WireForm::Number, Value::Array(items)) => {
            let items = items.into_iter().map(|item| on_the_wire(item, form));
            Value::Array(items.collect())
        }
        (WireForm::String, value @ (Value::Bool(_) | Value::Number(_))) => {
            Value::String(value.to_string())
        }
        (WireForm::Number, Value::Bool(truth)) => int_value(truth.into()),
        (_, value) => value,
    }
}

fn any_json() -> Value {
    Value::Object(vec![(
        "any".to_owned(),
        Value::Array(vec![
            int_value(1),
            Value::String("two".to_owned()),
            Value::Null,
        ]),
    )])
}

/// Returns the first or last value of an enum. If `only` has values, only these count.
pub(crate) fn enum_value(shape: &EnumType, only: &[Scalar], bound: Bound) -> Value {
    let wires = shape.values.iter().map(|value| &value.wire);
    let mut taken = wires.filter(|wire| only.is_empty() || only.contains(wire));
    let value = match bound {
        Bound::Most => taken.next_back(),
        Bound::None | Bound::Least => taken.next(),
    };
    value.map_or(Value::Null, Value::from)
}

/// Returns the number of items of an array.
pub(crate) fn item_count(field: &Field, bound: Bound) -> u64 {
    let (least, most) = match (&field.ty, field.details().constraints.length) {
        (Type::Array(_), Some(length)) => length,
        _ => (0, u64::MAX),
    };
    let wanted = match bound {
        Bound::None => 1,
        Bound::Least => 0,
        Bound::Most => 2,
    };
    wanted.clamp(least.min(LONGEST), most.max(least).min(LONGEST))
}

/// Returns a float as an encoder writes it. An `f32` gets the fewest digits that identify it.
pub(crate) fn float_value(kind: FloatKind, value: f64) -> Value {
    #[allow(clippy::cast_possible_truncation)]
    let short = value as f32;
    let digits = match kind {
        FloatKind::F32 if short.is_finite() => format!("{short:?}").parse().ok(),
        FloatKind::F32 | FloatKind::F64 => None,
    };
    Value::Number(Number::Float(digits.unwrap_or(value)))
}

/// Returns `true` if the field has no pattern, or its pattern matches the whole text.
#[must_use]
pub fn pattern_takes(field: &Field, text: &str) -> bool {
    let pattern = field.details().constraints.pattern.as_ref();
    pattern.is_none_or(|pattern| pattern.matches(text))
}

/// Returns `count` characters by repeating `text`, at most [`LONGEST`] and one more.
#[must_use]
pub fn cycled(text: &str, count: u64) -> String {
    let text = if text.is_empty() { SAMPLE_TEXT } else { text };
    let count = usize::try_from(count.min(LONGEST + 1)).unwrap_or(0);
    text.chars().cycle().take(count).collect()
}

/// Returns `count` bytes as standard base64 with padding (RFC 4648, section 4), at most [`LONGEST`] and one more.
#[must_use]
pub fn base64_of(count: u64) -> String {
    STANDARD.encode(cycled("hello", count))
}

fn int(kind: IntKind, field: &Field, given: Option<&Value>, bound: Bound) -> Value {
    let constraints = &field.details().constraints;
    let nearest = |wanted| int_value(constraints.nearest_int(kind, wanted));
    match bound {
        Bound::Least if constraints.min.is_some() => nearest(i128::MIN),
        Bound::None | Bound::Least => given.cloned().unwrap_or_else(|| nearest(1)),
        Bound::Most if constraints.max.is_some() => nearest(i128::MAX),
        Bound::Most => nearest(LARGEST_SAFE),
    }
}

fn float(kind: FloatKind, field: &Field, given: Option<&Value>, bound: Bound) -> Value {
    let constraints = &field.details().constraints;
    let edge = match bound {
        Bound::None => None,
        Bound::Least => constraints.min.as_ref(),
        Bound::Most => constraints.max.as_ref(),
    };
    let given = match (edge, given) {
        (Some(edge), _) | (None, Some(Value::Number(edge))) => Some(edge.to_f64()),
        (None, Some(value)) => return value.clone(),
        (None, None) => None,
    };
    let within = || {
        let least = constraints.min.as_ref().map_or(f64::MIN, Number::to_f64);
        let most = constraints.max.as_ref().map_or(f64::MAX, Number::to_f64);
        0.5_f64.min(most).max(least)
    };
    float_value(kind, given.unwrap_or_else(within))
}

fn string(field: &Field, given: Option<&Value>, bound: Bound) -> Value {
    let base = match given {
        Some(Value::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let constraints = &field.details().constraints;
    let is_free = constraints.pattern.is_none();
    let wanted = match (bound, constraints.length, base) {
        (Bound::Least, Some((least, _)), _) if is_free => Some(least),
        (Bound::Most, Some((_, most)), _) if is_free && most <= LONGEST => Some(most),
        (_, Some((least, most)), None) => {
            let length = SAMPLE_TEXT.len() as u64;
            Some(length.clamp(least, most.max(least)))
        }
        _ => None,
    };
    let base = base.unwrap_or(SAMPLE_TEXT);
    Value::String(match wanted {
        Some(count) => cycled(base, count),
        None => base.to_owned(),
    })
}

fn base64(field: &Field, given: Option<&Value>, bound: Bound) -> Value {
    let wanted = match (bound, field.details().constraints.length) {
        (Bound::Least, Some((least, _))) => Some(least),
        (Bound::Most, Some((_, most))) if most <= LONGEST => Some(most),
        (_, Some((least, _))) if given.is_none() => Some(least),
        _ => None,
    };
    match (wanted, given) {
        (Some(count), _) => Value::String(base64_of(count)),
        (None, Some(value)) => value.clone(),
        (None, None) => Value::String(SAMPLE_BASE64.to_owned()),
    }
}

fn int_value(value: i128) -> Value {
    Value::Number(Number::Int(value))
}
