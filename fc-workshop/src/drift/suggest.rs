//! Edits of the spec that would settle a deviation.

use super::process::ARROW;
use super::{Deviation, DeviationKind};
use fc_reflect::BodyErrorKind;
use fc_spec::amend::{Amendment, FieldKey, amend};
use fc_spec::diagnostic::Faults;
use fc_spec::format::Revised;
use fc_spec::load::load;
use fc_spec::model::{Field, IntKind, Model, Number, Quirk, Scalar, Type, TypeDef, WireForm};
use fc_spec::source::Sources;
use serde_json::Value;

/// Returns the edit that makes the spec agree with the first frame of a deviation. Returns `None` if the spec cannot express
/// the deviation, such as a missing response, or if the edited spec would have errors.
///
/// The edit says that the peers are right. If the spec is right, change the peers instead.
#[must_use]
pub fn suggest(sources: &Sources, model: &Model, deviation: &Deviation<'_>) -> Option<Revised> {
    let amended = amend(sources, model, &amendment(model, deviation)?)?;
    let model = load(&amended.sources, &mut Faults::new()).model();
    model.map(|_| amended)
}

fn amendment(model: &Model, deviation: &Deviation<'_>) -> Option<Amendment> {
    let place = &deviation.place;
    if place.kind == DeviationKind::UnknownResult {
        return Some(Amendment::AddResult(place.value.parse().ok()?));
    }
    let path: Vec<&str> = place.path.split('.').collect();
    let (key, before) = path.split_last()?;
    let operation = deviation.operation?;
    let body = operation.body(place.direction?)?;
    let body = model.types.named(body.ty.name())?;
    let owner = match &place.owner {
        Some(owner) => model.types.named(owner)?,
        None => owner(model, body, before, key)?,
    };
    let found: Option<Value> = serde_json::from_str(&deviation.example).ok();
    if place.kind == DeviationKind::UnknownKey {
        return Some(Amendment::AddField {
            owner: owner.name.clone(),
            key: (*key).to_owned(),
            ty: type_of(found.as_ref()),
        });
    }
    let key = key.trim_end_matches("[]");
    let field = owner.shape.structure()?.field(key)?;
    let set = |key: FieldKey, value: Option<String>| Amendment::SetKey {
        owner: owner.name.clone(),
        field: field.wire.clone(),
        key,
        value,
    };
    Some(match place.kind {
        DeviationKind::UnknownEnumValue | DeviationKind::Body(BodyErrorKind::UnknownValue) => {
            let ty = enum_of(model, field)?;
            let value = match found? {
                Value::String(text) => Scalar::String(text),
                Value::Number(number) => Scalar::Number(Number::Int(number.as_i64()?.into())),
                _ => return None,
            };
            Amendment::AddValue {
                owner: ty.name.clone(),
                value,
            }
        }
        DeviationKind::StateOrder => {
            let ty = enum_of(model, field)?;
            let (state, successor) = place.value.split_once(ARROW)?;
            Amendment::AddSuccessor {
                owner: ty.name.clone(),
                state: state.to_owned(),
                successor: successor.to_owned(),
            }
        }
        DeviationKind::Body(BodyErrorKind::MissingField) => {
            set(FieldKey::OPTIONAL, Some(true.to_string()))
        }
        DeviationKind::Body(BodyErrorKind::BadPattern) => set(FieldKey::PATTERN, None),
        DeviationKind::Body(BodyErrorKind::BadLength) => {
            let count = match found? {
                Value::String(text) if field.ty == Type::Base64 => text.len() / 4 * 3,
                Value::String(text) => text.chars().count(),
                Value::Array(items) => items.len(),
                _ => return None,
            };
            let count = u64::try_from(count).ok()?;
            let (least, most) = field.details().constraints.length?;
            let (least, most) = (least.min(count), most.max(count));
            set(FieldKey::LENGTH, Some(format!("[{least}, {most}]")))
        }
        DeviationKind::Body(BodyErrorKind::OutOfRange) => {
            range(owner, field, found?.as_f64(), set)?
        }
        DeviationKind::Body(BodyErrorKind::WrongType) => wrong_type(owner, field, &found?, set),
        DeviationKind::Body(BodyErrorKind::BadBase64) => with_type(owner, field, "string"),
        _ => return None,
    })
}

/// Returns the amendment for a number or an enum value that the field refuses.
fn range(
    owner: &TypeDef,
    field: &Field,
    found: Option<f64>,
    set: impl Fn(FieldKey, Option<String>) -> Amendment,
) -> Option<Amendment> {
    let constraints = &field.details().constraints;
    if !constraints.only.is_empty() {
        return Some(set(FieldKey::ONLY, None));
    }
    let found = found?;
    let is_below = |least: &Number| found < least.to_f64();
    let is_above = |most: &Number| found > most.to_f64();
    if constraints.min.as_ref().is_some_and(is_below) {
        return Some(set(FieldKey::MIN, Some(found.to_string())));
    }
    if constraints.max.as_ref().is_some_and(is_above) {
        return Some(set(FieldKey::MAX, Some(found.to_string())));
    }
    let Type::Int(_) = field.ty else {
        return None;
    };
    let fitting = IntKind::ALL.iter().find(|kind| {
        let (least, most) = kind.range();
        Number::Int(least).to_f64() <= found && found <= Number::Int(most).to_f64()
    });
    Some(with_type(owner, field, fitting?.name()))
}

/// Returns the amendment that gives a field another type.
fn with_type(owner: &TypeDef, field: &Field, ty: &str) -> Amendment {
    let mark = if field.optional { "?" } else { "" };
    Amendment::SetType {
        owner: owner.name.clone(),
        field: field.wire.clone(),
        ty: format!("{ty}{mark}"),
    }
}

/// Returns the amendment for a value of another kind.
fn wrong_type(
    owner: &TypeDef,
    field: &Field,
    found: &Value,
    set: impl Fn(FieldKey, Option<String>) -> Amendment,
) -> Amendment {
    let is_number = matches!(field.ty, Type::Int(_) | Type::Float(_));
    let quirk = match (&field.ty, found) {
        (_, Value::Null) => return set(FieldKey::OPTIONAL, Some(true.to_string())),
        (Type::Bool, Value::Number(_) | Value::String(_)) => Quirk::LenientBool,
        (_, Value::Number(_)) if is_number && field.wire_form == WireForm::String => {
            Quirk::LenientNumber
        }
        (_, Value::String(text)) if is_number && text.parse::<f64>().is_ok() => {
            Quirk::LenientNumber
        }
        _ => return with_type(owner, field, "json"),
    };
    let mut quirks: Vec<_> = field.details().quirks.iter().map(|it| it.name()).collect();
    quirks.push(quirk.name());
    set(FieldKey::QUIRK, Some(format!("[{}]", quirks.join(", "))))
}

/// Returns the type of a new field with this value, as the spec writes it.
fn type_of(value: Option<&Value>) -> &'static str {
    match value {
        Some(Value::Bool(_)) => "bool",
        Some(Value::String(_)) => "string",
        Some(Value::Number(number)) if number.is_i64() => "i64",
        Some(Value::Number(number)) if number.is_u64() => "u64",
        Some(Value::Number(_)) => "f64",
        _ => "json",
    }
}

/// Returns the struct at the end of a path from a body. In a one-of, it is the first variant with the next key, or else the first one.
fn owner<'m>(
    model: &'m Model,
    body: &'m TypeDef,
    path: &[&str],
    last: &str,
) -> Option<&'m TypeDef> {
    let mut owner = body;
    let nexts = path.iter().skip(1).chain([&last]);
    for (key, next) in path.iter().zip(nexts) {
        let field = owner.shape.structure()?.field(key.trim_end_matches("[]"))?;
        let named = field.ty.innermost()?;
        owner = model.types.get(named);
        if let Some(choice) = owner.shape.choice() {
            let variants = choice.variants.iter();
            let mut structs = variants.map(|it| model.types.get(&it.ty));
            let has = |it: &&TypeDef| {
                it.shape
                    .structure()
                    .is_some_and(|it| it.field(next).is_some())
            };
            owner = structs.clone().find(has).or(structs.next())?;
        }
    }
    Some(owner)
}

fn enum_of<'m>(model: &'m Model, field: &Field) -> Option<&'m TypeDef> {
    let ty = model.types.get(field.ty.innermost()?);
    ty.shape.enumeration().map(|_| ty)
}
