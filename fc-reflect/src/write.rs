//! The canonical text of what has been read: the keys of the envelope, own keys in the order of the spec, unknown ones.

use crate::error::{BodyError, BodyFault};
use crate::json::{write_f32, write_f64, write_string};
use crate::tree::{About, Node, Value};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_spec::model::{FloatKind, Number, Scalar, Type, WireForm};

/// Writes one object of several groups of keys.
pub(crate) fn object(groups: &[&[Node<'_>]]) -> Result<String, BodyError> {
    let mut out = String::new();
    keys(&mut out, groups)?;
    Ok(out)
}

fn keys(out: &mut String, groups: &[&[Node<'_>]]) -> Result<(), BodyError> {
    out.push('{');
    let mut is_first = true;
    for group in groups {
        let mut sorted: Vec<_> = group.iter().collect();
        // Unknown keys stay in the order in which they came.
        sorted.sort_by_key(|node| node.slot);
        for node in sorted {
            if matches!(node.value, Value::Absent) {
                continue;
            }
            if !std::mem::take(&mut is_first) {
                out.push(',');
            }
            write_string(out, node.wire());
            out.push(':');
            field(out, node)?;
        }
    }
    out.push('}');
    Ok(())
}

fn field(out: &mut String, node: &Node<'_>) -> Result<(), BodyError> {
    let quoted = matches!(node.about, About::Field(field) if field.wire_form == WireForm::String);
    if quoted {
        out.push('"');
    }
    value(out, node)?;
    if quoted {
        out.push('"');
    }
    Ok(())
}

fn value(out: &mut String, node: &Node<'_>) -> Result<(), BodyError> {
    match &node.value {
        Value::Absent => out.push_str("null"),
        Value::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
        Value::Int(value) => out.push_str(&value.to_string()),
        Value::Float(value) => float(out, *value, node.ty)?,
        Value::Text(text) => write_string(out, text),
        Value::Bytes(bytes) => {
            out.push('"');
            STANDARD.encode_string(bytes, out);
            out.push('"');
        }
        Value::Json(text) => out.push_str(text),
        Value::Enum { wire, .. } => match wire {
            Scalar::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Scalar::Number(Number::Int(value)) => out.push_str(&value.to_string()),
            Scalar::Number(Number::Float(value)) => float(out, *value, None)?,
            Scalar::String(text) => write_string(out, text),
        },
        Value::List(items) => {
            out.push('[');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    out.push(',');
                }
                value(out, item)?;
            }
            out.push(']');
        }
        Value::Object(nodes) | Value::OneOf { keys: nodes, .. } => keys(out, &[nodes])?,
    }
    Ok(())
}

/// JSON has neither NaN nor infinities, and `null` in their place would be read as absent.
fn float(out: &mut String, value: f64, ty: Option<&Type>) -> Result<(), BodyError> {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "the nearest value is what is wanted"
    )]
    let short = value as f32;
    match ty {
        Some(Type::Float(FloatKind::F32)) if short.is_finite() => write_f32(out, short),
        Some(Type::Float(FloatKind::F64)) | None if value.is_finite() => write_f64(out, value),
        _ => {
            let detail = "JSON has neither NaN nor infinities; send a finite number";
            return Err(BodyError::new(BodyFault::OutOfRange, 0, detail));
        }
    }
    Ok(())
}
