//! Messages that must be read, and written again as they were.

use super::{Case, quirks};
use crate::model::{EncodingRole, Type, TypeShape, Value};
use crate::sample::edit::replaced;
use crate::sample::{Profile, STREAM_BYTES, sites, with_unknown_keys, with_unknown_values};

pub(super) fn stream(case: &Case<'_, '_>) -> Vec<Value> {
    let plain = case.accepted_bytes("plain", EncodingRole::Plain, STREAM_BYTES);
    let gzip = case.accepted_bytes("gzip", EncodingRole::Gzip, STREAM_BYTES);
    plain.into_iter().chain(gzip).collect()
}

pub(super) fn messages(case: &Case<'_, '_>) -> Vec<Value> {
    let example = case.message(Profile::Example);
    let mut entries = vec![case.accepted("plain", EncodingRole::Plain, &example)];
    if case.input(EncodingRole::Gzip).is_some() {
        entries.push(case.accepted("gzip", EncodingRole::Gzip, &example));
    }
    let Some(ty) = case.body_type() else {
        return entries;
    };
    let mut push = |name: &str, body: &Value| {
        entries.push(case.accepted(name, EncodingRole::Plain, body));
    };
    let full = case.message(Profile::Full);
    push(
        "unknown_keys",
        &with_unknown_keys(case.samples, ty, &example),
    );
    if let Some(body) = with_unknown_values(case.samples, ty, &full) {
        push("unknown_value", &body);
    }
    push("minimal", &case.message(Profile::Minimal));
    push("maximal", &case.message(Profile::Maximal));
    for (name, body) in variants(case, ty, &full) {
        push(&name, &body);
    }
    entries.extend(quirks::messages(case, ty, &full));
    entries
}

/// A message for each variant of a one-of but the first, which the example shows.
fn variants(case: &Case<'_, '_>, ty: &str, full: &Value) -> Vec<(String, Value)> {
    let mut messages = Vec::new();
    for site in sites(case.samples, ty, full) {
        let Type::Named(name) = site.ty else { continue };
        let shape = case.samples.type_named(name).map(|ty| &ty.shape);
        let Some(TypeShape::OneOf(choice)) = shape else {
            continue;
        };
        for variant in choice.variants.iter().skip(1) {
            let value = case.samples.named(&variant.ty, Profile::Example);
            let body = replaced(full, &site.path, value);
            messages.push((format!("variant_{}_{}", site.path, variant.name), body));
        }
    }
    messages
}
