//! Forms that a lenient decoder accepts, with the canonical form.

use super::case::Case;
use super::edit::{get, removed, renamed, replaced};
use super::sites::{Site, sites};
use crate::emit::json::{int, text};
use fc_spec::model::{Number, Quirk, StructRef, Type, Value, WireForm};

/// Returns a message for every form of every quirk in the body. `full` has every field.
pub(super) fn messages(case: &Case<'_, '_>, ty: &StructRef, full: &Value) -> Vec<Value> {
    let mut entries = Vec::new();
    for site in sites(case.samples, ty, full) {
        if !site.is_item {
            entries.extend(of_field(case, full, &site));
        }
        let Some(value) = get(full, &site.path) else {
            continue;
        };
        for quirk in &site.field.details().quirks {
            let forms = match quirk {
                Quirk::LenientNumber => number_forms(&site, value),
                Quirk::LenientBool => bool_forms(&site, value),
                Quirk::EmptyIsAbsent => Vec::new(),
            };
            for (form, value) in forms {
                let name = format!("quirk_{}_{form}", site.path);
                let body = replaced(full, &site.path, value);
                entries.push(case.accepted_as(&name, body, full));
            }
        }
    }
    entries
}

/// Returns messages with other keys of a field, and with values that count as its absence.
fn of_field(case: &Case<'_, '_>, full: &Value, site: &Site<'_>) -> Vec<Value> {
    let mut entries = Vec::new();
    for also in site.field.details().also.iter().filter(|_| site.present) {
        let name = format!("quirk_{}_also_{also}", site.path);
        let body = renamed(full, &site.path, also);
        entries.push(case.accepted_as(&name, body, full));
    }
    if site.field.details().quirks.contains(&Quirk::EmptyIsAbsent) {
        for (form, value) in [
            ("null", Value::Null),
            ("empty_object", Value::Object(Vec::new())),
            ("empty_array", Value::Array(Vec::new())),
            ("empty_string", text("")),
        ] {
            let name = format!("quirk_{}_{form}", site.path);
            let body = replaced(full, &site.path, value);
            entries.push(case.accepted_as(&name, body, &removed(full, &site.path)));
        }
    }
    entries
}

fn number_forms(site: &Site<'_>, value: &Value) -> Vec<(&'static str, Value)> {
    if matches!(value, Value::Array(_)) {
        return Vec::new();
    }
    let spelled = match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let mut forms = Vec::new();
    match site.field.wire_form {
        WireForm::String => forms.extend(number_in(&spelled).map(|number| ("number", number))),
        WireForm::Plain | WireForm::Number => forms.push(("string", text(&spelled))),
    }
    let is_int = matches!(site.ty, Type::Int(_) | Type::TimestampMs | Type::TimestampS);
    if let (true, Ok(number @ 0..)) = (is_int, spelled.parse::<i128>()) {
        forms.push(("hex", text(&format!("0x{number:X}"))));
    }
    forms
}

fn bool_forms(site: &Site<'_>, value: &Value) -> Vec<(&'static str, Value)> {
    let truth = match value {
        Value::Bool(truth) => *truth,
        Value::String(text) => text == "true",
        Value::Number(number) => *number == Number::Int(1),
        _ => return Vec::new(),
    };
    let as_bool = ("bool", Value::Bool(truth));
    let as_string = ("string", text(if truth { "true" } else { "false" }));
    let as_number = ("number", int(truth));
    match site.field.wire_form {
        WireForm::Plain => vec![as_string, as_number],
        WireForm::String => vec![as_bool, as_number],
        WireForm::Number => vec![as_bool, as_string],
    }
}

/// Returns the number in a text.
pub(super) fn number_in(text: &str) -> Option<Value> {
    let integer = text.parse::<i128>().map(int).ok();
    integer.or_else(|| Some(Value::Number(Number::Float(text.parse().ok()?))))
}
