//! Messages that a reader must accept and write back.

use super::case::Case;
use super::conditions;
use super::edit::{Path, get, replaced};
use super::quirks;
use super::sites::{shape_of, sites};
use super::unknown::{with_unknown_keys, with_unknown_values};
use crate::emit::json::{float, int};
use crate::sample::Profile;
use fc_spec::model::{
    Direction, EncodingRole, EnvelopeRole, Number, ResultCode, StructRef, Type, TypeShape, Value,
};

pub(super) fn stream(case: &Case<'_, '_>, data: &[u8]) -> Vec<Value> {
    let plain = case.accepted_bytes(EncodingRole::Plain, data);
    let gzip = case.accepted_bytes(EncodingRole::Gzip, data);
    plain.into_iter().chain(gzip).collect()
}

pub(super) fn messages(case: &Case<'_, '_>) -> Vec<Value> {
    let example = case.message(Profile::Example);
    let packed = |encoding: EncodingRole| case.accepted(encoding.name(), encoding, example.clone());
    let mut entries = vec![packed(EncodingRole::Plain)];
    if case.packs(EncodingRole::Gzip) {
        entries.push(packed(EncodingRole::Gzip));
    }
    let Some(ty) = case.body_type() else {
        return entries;
    };
    let mut push = |name: &str, body: Value| {
        entries.push(case.accepted(name, EncodingRole::Plain, body));
    };
    let full = case.message(Profile::Full);
    push(
        "unknown_keys",
        with_unknown_keys(case.samples, ty, &example),
    );
    if let Some(body) = with_unknown_values(case.samples, ty, &full) {
        push("unknown_value", body);
    }
    push("minimal", case.message(Profile::Minimal));
    push("maximal", case.message(Profile::Maximal));
    for (name, body) in variants(case, ty, &full) {
        push(&name, body);
    }
    for (name, body) in refusals(case) {
        push(&name, body);
    }
    let integral = with_points(case, ty, &full);
    if integral != full {
        entries.push(case.accepted_as("integral", integral, &full));
    }
    entries.extend(quirks::messages(case, ty, &full));
    entries.extend(conditions::messages(case, ty, &full));
    entries
}

/// Returns a response for each error that the operation declares, if responses carry a result code.
fn refusals(case: &Case<'_, '_>) -> Vec<(String, Value)> {
    let model = case.samples.model();
    let envelope = &model.envelope;
    let (Direction::Response, Some(code)) = (case.direction, envelope.result_code()) else {
        return Vec::new();
    };
    let mut keys = envelope.response.iter();
    let text = keys.find(|key| key.role == EnvelopeRole::ResultText);
    let declared = |result: &&ResultCode| case.operation.error(result.code).is_some();
    let refusal = |result: &ResultCode| {
        let samples = case.samples;
        let own = samples.body(case.operation, case.direction, Profile::Minimal);
        let mut body = samples.enveloped(case.direction, own, Profile::Example);
        body.set(&code.wire, int(result.code));
        if let Some(text) = text {
            body.set(&text.wire, Value::String(result.text.zh.clone()));
        }
        (format!("error_{}", result.name), body)
    };
    model.results.iter().filter(declared).map(refusal).collect()
}

/// Returns the message with integers in a form of other languages: `1.0`.
fn with_points(case: &Case<'_, '_>, ty: &StructRef, full: &Value) -> Value {
    let mut body = full.clone();
    let envelope = case.samples.envelope(case.direction).iter();
    let keys = envelope.map(|field| Path::default().key(&field.wire));
    let sites = sites(case.samples, ty, full).into_iter();
    let places = sites
        .filter(|site| !matches!(site.ty, Type::Json | Type::Float(_)))
        .map(|site| site.path);
    for path in keys.chain(places) {
        if let Some(Value::Number(number @ Number::Int(value))) = get(full, &path)
            && value.unsigned_abs() < 1 << 53
        {
            body = replaced(&body, &path, float(number.to_f64()));
        }
    }
    body
}

/// Returns a message for each variant of a one-of except the first, which the example shows.
fn variants(case: &Case<'_, '_>, ty: &StructRef, full: &Value) -> Vec<(String, Value)> {
    let mut messages = Vec::new();
    for site in sites(case.samples, ty, full) {
        let Some(TypeShape::OneOf(choice)) = shape_of(case.samples, site.ty) else {
            continue;
        };
        for variant in choice.variants.iter().skip(1) {
            let ty = case.samples.model().types.get(&variant.ty);
            let value = case.samples.named(ty, Profile::Example);
            let body = replaced(full, &site.path, value);
            messages.push((format!("variant_{}_{}", site.path, variant.name), body));
        }
    }
    messages
}
