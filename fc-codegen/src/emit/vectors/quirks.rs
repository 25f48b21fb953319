//! Where the wire is odd: what a lenient decoder takes, beside what is sent instead.

use super::Case;
use super::values::{int, text};
use crate::model::{Field, Number, Quirk, Type, Value, WireForm};
use crate::sample::edit::{get, removed, renamed, replaced};
use crate::sample::{Site, sites};

/// A message for every form of every quirk in the body. `full` has every field.
pub(super) fn messages(case: &Case<'_, '_>, ty: &str, full: &Value) -> Vec<Value> {
    let mut entries = Vec::new();
    for site in sites(case.samples, ty, full) {
        let Some(field) = site.field else { continue };
        for also in &field.also {
            if site.present {
                let name = format!("quirk_{}_also_{also}", site.path);
                let body = renamed(full, &site.path, also);
                entries.push(case.accepted_as(&name, &body, full));
            }
        }
        for quirk in &field.quirks {
            for (form, value) in forms(*quirk, field, full, &site) {
                let canonical = match quirk {
                    Quirk::EmptyIsAbsent => removed(full, &site.path),
                    Quirk::LenientNumber | Quirk::LenientBool => full.clone(),
                };
                let name = format!("quirk_{}_{form}", site.path);
                let body = replaced(full, &site.path, value);
                entries.push(case.accepted_as(&name, &body, &canonical));
            }
        }
    }
    entries
}

/// The odd spellings of a field's value, each with a name.
fn forms(quirk: Quirk, field: &Field, full: &Value, site: &Site<'_>) -> Vec<(&'static str, Value)> {
    let value = get(full, &site.path);
    match quirk {
        Quirk::EmptyIsAbsent => vec![
            ("null", Value::Null),
            ("empty_object", Value::Object(Vec::new())),
            ("empty_array", Value::Array(Vec::new())),
            ("empty_string", text("")),
        ],
        Quirk::LenientNumber => value
            .map(|value| number_forms(field, value))
            .unwrap_or_default(),
        Quirk::LenientBool => value
            .map(|value| bool_forms(field, value))
            .unwrap_or_default(),
    }
}

fn number_forms(field: &Field, value: &Value) -> Vec<(&'static str, Value)> {
    let spelled = match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let mut forms = Vec::new();
    match field.wire_form {
        WireForm::Plain => forms.push(("string", text(&spelled))),
        WireForm::String => {
            let number = spelled.parse().map(int).ok();
            let number = number.or_else(|| {
                let number = spelled.parse().ok()?;
                Some(Value::Number(Number::Float(number)))
            });
            forms.extend(number.map(|number| ("number", number)));
        }
    }
    let is_int = matches!(
        field.ty,
        Type::Int(_) | Type::TimestampMs | Type::TimestampS
    );
    if let (true, Ok(number @ 0..)) = (is_int, spelled.parse::<i128>()) {
        forms.push(("hex", text(&format!("0x{number:X}"))));
    }
    forms
}

fn bool_forms(field: &Field, value: &Value) -> Vec<(&'static str, Value)> {
    let truth = match value {
        Value::Bool(truth) => *truth,
        Value::String(text) => text == "true",
        _ => return Vec::new(),
    };
    let other_form = match field.wire_form {
        WireForm::Plain => ("string", text(if truth { "true" } else { "false" })),
        WireForm::String => ("bool", Value::Bool(truth)),
    };
    vec![other_form, ("number", int(truth.into()))]
}
