//! Writes the canonical text of a message: the envelope, then known keys in the order of the spec, then unknown keys.

use crate::tree::{About, Node, Value};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_runtime::json::{BodyError, BodyErrorKind, Writer};
use fc_spec::model::{FloatKind, Number, Scalar, Type, WireForm};

/// Writes one object from several groups of keys.
pub(crate) fn object(groups: &[&[Node<'_>]]) -> Result<String, BodyError> {
    let mut out = Vec::new();
    keys(&mut out, groups)?;
    // All writers produce UTF-8.
    Ok(String::from_utf8(out).unwrap_or_default())
}

fn keys(out: &mut Vec<u8>, groups: &[&[Node<'_>]]) -> Result<(), BodyError> {
    out.push(b'{');
    let mut is_first = true;
    for group in groups {
        let mut sorted: Vec<_> = group.iter().collect();
        // Unknown keys keep their order.
        sorted.sort_by_key(|node| node.slot);
        for node in sorted {
            if matches!(node.value, Value::Absent) {
                continue;
            }
            if !std::mem::take(&mut is_first) {
                out.push(b',');
            }
            Writer::new(out).string(node.wire());
            out.push(b':');
            field(out, node)?;
        }
    }
    out.push(b'}');
    Ok(())
}

fn field(out: &mut Vec<u8>, node: &Node<'_>) -> Result<(), BodyError> {
    let form = match node.about {
        About::Field(field) => field.wire_form,
        _ => WireForm::Plain,
    };
    match (form, &node.value) {
        (WireForm::String, _) => {
            out.push(b'"');
            value(out, node)?;
            out.push(b'"');
        }
        (WireForm::Number, Value::Bool(truth)) => Writer::new(out).integer(u8::from(*truth)),
        (WireForm::Number | WireForm::Plain, _) => value(out, node)?,
    }
    Ok(())
}

fn value(out: &mut Vec<u8>, node: &Node<'_>) -> Result<(), BodyError> {
    match &node.value {
        Value::Absent => Writer::new(out).null(),
        Value::Bool(value) => Writer::new(out).bool(*value),
        Value::Int(value) => Writer::new(out).integer(*value),
        Value::Float(value) => float(out, *value, node.ty)?,
        Value::Text(text) => Writer::new(out).string(text),
        Value::Bytes(bytes) => {
            out.push(b'"');
            out.extend(STANDARD.encode(bytes).into_bytes());
            out.push(b'"');
        }
        Value::Json(text) => out.extend_from_slice(text.as_bytes()),
        Value::Enum { wire, .. } => match wire {
            Scalar::Bool(value) => Writer::new(out).bool(*value),
            Scalar::Number(Number::Int(value)) => Writer::new(out).integer(*value),
            Scalar::Number(Number::Float(value)) => float(out, *value, None)?,
            Scalar::String(text) => Writer::new(out).string(text),
        },
        Value::List(items) => {
            out.push(b'[');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    out.push(b',');
                }
                value(out, item)?;
            }
            out.push(b']');
        }
        Value::Object(nodes) | Value::OneOf { keys: nodes, .. } => keys(out, &[nodes])?,
    }
    Ok(())
}

/// Refuses NaN and infinities. JSON has neither, and `null` would mean absent.
fn float(out: &mut Vec<u8>, value: f64, ty: Option<&Type>) -> Result<(), BodyError> {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the nearest value is what is wanted"
    )]
    let short = value as f32;
    match ty {
        Some(Type::Float(FloatKind::F32)) if short.is_finite() => Writer::new(out).f32(short),
        Some(Type::Float(FloatKind::F64)) | None if value.is_finite() => {
            Writer::new(out).f64(value);
        }
        _ => {
            let detail = "JSON has neither NaN nor infinities; send a finite number";
            return Err(BodyError::new(BodyErrorKind::OutOfRange, detail));
        }
    }
    Ok(())
}
