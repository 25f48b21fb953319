//! Bodies that a reader must refuse. Each breaks exactly one rule.

use super::case::Case;
use super::edit::{Path, doubled, get, removed, replaced};
use super::quirks::number_in;
use super::sites::{Site, shape_of, sites};
use super::unknown::{UNKNOWN_KEY, unknown_enum_value};
use crate::emit::json::{float, int, object, text};
use crate::sample::Profile;
use crate::sample::constraint::{LONGEST, base64_of, cycled, on_the_wire, pattern_takes};
use fc_spec::model::{
    EncodingRole, EnumType, Field, Number, OneOf, Quirk, Type, TypeShape, Value, WireForm,
};

/// The maximum nesting that a vector contains. A larger limit has no vector.
const DEEPEST: u32 = 1024;

pub(super) fn of_operation(case: &Case<'_, '_>) -> Vec<Value> {
    let full = case.message(Profile::Full);
    let mut entries = not_json(case, &full);
    let mut push = |error: &str, name: &str, body: &Value| {
        let carrier = case.carrier(body.to_string().as_bytes(), EncodingRole::Plain);
        entries.push(case.rejected(&format!("{error}_{name}"), carrier, error));
    };
    for field in case.samples.envelope(case.direction) {
        let path = Path::default().key(&field.wire);
        let other = replaced(&full, &path, wrong_type(&field.ty));
        push("wrong_type", &field.wire, &other);
        if !field.optional {
            push("missing_field", &field.wire, &removed(&full, &path));
        }
        push("duplicate_key", &field.wire, &doubled(&full, &path));
    }
    let Some(ty) = case.body_type() else {
        return entries;
    };
    for site in sites(case.samples, ty, &full) {
        if !site.present {
            continue;
        }
        let name = site.path.to_string();
        if !site.field.optional && !site.is_item && !site.in_variant {
            push("missing_field", &name, &removed(&full, &site.path));
        }
        if !site.is_item {
            push("duplicate_key", &name, &doubled(&full, &site.path));
        }
        for (error, form, value) in broken(case, &site, &full) {
            let body = replaced(&full, &site.path, value);
            push(error, &format!("{name}{form}"), &body);
        }
    }
    entries
}

/// Returns texts that are not a JSON object, or are nested too deeply.
fn not_json(case: &Case<'_, '_>, full: &Value) -> Vec<Value> {
    let whole = full.to_string();
    let inside = whole.strip_prefix('{').unwrap_or_default();
    let comma = if inside == "}" { "" } else { "," };
    let with_first = |value: &[u8]| {
        let mut bytes = format!("{{\"{UNKNOWN_KEY}\":").into_bytes();
        bytes.extend(value);
        bytes.extend(comma.bytes());
        bytes.extend(inside.bytes());
        bytes
    };
    let cut_off = whole.strip_suffix('}').unwrap_or_default();
    let mut texts = vec![
        ("bad_json", cut_off.as_bytes().to_vec()),
        ("not_an_object", b"[1]".to_vec()),
    ];
    if case.id().is_some() {
        texts.push(("not_utf8", with_first(b"\"\xFF\"")));
    }
    let limit = case.samples.model().limits.json_depth;
    if limit <= DEEPEST {
        // The depth exceeds the limit by several levels, so that it does not matter whether the outermost object
        // counts.
        let depth = usize::try_from(limit).unwrap_or(0) + 8;
        let nested = "[".repeat(depth) + &"]".repeat(depth);
        texts.push(("too_deep", with_first(nested.as_bytes())));
    }
    let entry = |(error, bytes): (&'static str, Vec<u8>)| {
        case.rejected(error, case.carrier(&bytes, EncodingRole::Plain), error)
    };
    texts.into_iter().map(entry).collect()
}

type Broken = (&'static str, &'static str, Value);

/// Returns values that break one rule of a place: the error, a suffix for the name, and the value.
fn broken(case: &Case<'_, '_>, site: &Site<'_>, full: &Value) -> Vec<Broken> {
    let mut values = Vec::new();
    if *site.ty != Type::Json {
        values.push(("wrong_type", "", wrong_type(site.ty)));
    }
    match shape_of(case.samples, site.ty) {
        Some(TypeShape::Enum(shape)) => {
            values.extend(unknown_value(shape, site.field));
            values.extend(not_taken(shape, site.field));
        }
        Some(TypeShape::OneOf(choice)) => values.extend(no_variant(case, choice)),
        Some(TypeShape::Struct(_)) | None => {}
    }
    let value = get(full, &site.path);
    values.extend(value.into_iter().flat_map(|value| other_forms(site, value)));
    match (site.ty, value) {
        (Type::Int(_) | Type::Float(_), _) => {
            let form = site.field.wire_form;
            let numbers = out_of_range(site.ty, site.field).into_iter();
            values.extend(
                numbers.map(|(edge, value)| ("out_of_range", edge, on_the_wire(value, form))),
            );
        }
        (Type::String, Some(Value::String(sample))) => {
            values.extend(bad_pattern(site.field, sample));
            values.extend(wrong_lengths(site, |count| {
                let wrong = cycled(sample, count);
                // If the value also breaks the pattern, readers may report either error.
                pattern_takes(site.field, &wrong).then(|| text(&wrong))
            }));
        }
        (Type::Base64, _) => {
            values.push(("bad_base64", "", text("not base64!")));
            values.extend(wrong_lengths(site, |count| Some(text(&base64_of(count)))));
        }
        (Type::Array(_), Some(Value::Array(items))) => {
            let item = items.first().cloned().unwrap_or(Value::Null);
            values.extend(wrong_lengths(site, |count| {
                Some(Value::Array((0..count).map(|_| item.clone()).collect()))
            }));
        }
        _ => {}
    }
    values
}

/// Returns a value that only the type `json` accepts.
fn wrong_type(ty: &Type) -> Value {
    match ty {
        Type::Array(_) | Type::Named(_) => Value::Bool(true),
        _ => Value::Array(vec![int(1)]),
    }
}

/// Returns forms of a value that neither the `wire` of its field nor a quirk allows.
fn other_forms(site: &Site<'_>, value: &Value) -> Vec<Broken> {
    let quirks = &site.field.details().quirks;
    let is_strict = !quirks
        .iter()
        .any(|quirk| matches!(quirk, Quirk::LenientNumber | Quirk::LenientBool));
    let mut forms = Vec::new();
    match (site.field.wire_form, value) {
        (WireForm::String, Value::String(held)) if is_strict => match held.as_str() {
            "true" | "false" => forms.push(("_bool", Value::Bool(held == "true"))),
            number => forms.extend(number_in(number).map(|number| ("_number", number))),
        },
        (WireForm::Number, Value::Number(number)) => {
            let truth = *number == Number::Int(1);
            forms.extend(is_strict.then_some(("_bool", Value::Bool(truth))));
            forms.push(("_two", int(2)));
            forms.push(("_string", text(&value.to_string())));
        }
        _ => {}
    }
    let broken = forms.into_iter();
    broken
        .map(|(form, value)| ("wrong_type", form, value))
        .collect()
}

fn unknown_value(shape: &EnumType, field: &Field) -> Option<Broken> {
    let value = shape.closed.then(|| unknown_enum_value(shape)).flatten()?;
    Some(("unknown_value", "", on_the_wire(value, field.wire_form)))
}

/// Returns values that the `only` of a field excludes: a known one, and an unknown one that the enum alone would keep.
fn not_taken(shape: &EnumType, field: &Field) -> Vec<Broken> {
    let only = &field.details().constraints.only;
    if only.is_empty() {
        return Vec::new();
    }
    let mut wires = shape.values.iter().map(|value| &value.wire);
    let other = wires.find(|wire| !only.contains(wire)).map(Value::from);
    let unknown = (!shape.closed).then(|| unknown_enum_value(shape)).flatten();
    [("_other", other), ("_unknown", unknown)]
        .into_iter()
        .filter_map(|(form, value)| Some(("out_of_range", form, value?)))
        .collect()
}

fn no_variant(case: &Case<'_, '_>, choice: &OneOf) -> Option<Broken> {
    let nothing_known = object([(UNKNOWN_KEY, int(1))]);
    let taken = case.samples.variant_of(choice, &nothing_known).is_some();
    (!taken).then_some(("no_variant", "", nothing_known))
}

/// Returns numbers that a field refuses, near the edges of those that it accepts.
fn out_of_range(ty: &Type, field: &Field) -> Vec<(&'static str, Value)> {
    match ty {
        Type::Int(kind) => {
            let refused = field.details().constraints.refused_ints(*kind).into_iter();
            // The ends of 64 bits are left out, because some JSON readers round them.
            let exact = refused.filter(|(_, value)| value.unsigned_abs() <= 1 << 53);
            exact.map(|(name, value)| (name, int(value))).collect()
        }
        Type::Float(_) => {
            let beside = |edge: Option<&Number>, step: f64| {
                let edge = edge?.to_f64();
                Some(float(edge + step * edge.abs().max(1.0)))
            };
            let below = beside(field.details().constraints.min.as_ref(), -1.0)
                .map(|value| ("_below", value));
            let above = beside(field.details().constraints.max.as_ref(), 1.0)
                .map(|value| ("_above", value));
            below.into_iter().chain(above).collect()
        }
        _ => Vec::new(),
    }
}

/// Returns values just too short and just too long, which `value` makes. A length counts the items of an array, not
/// their contents.
fn wrong_lengths(site: &Site<'_>, value: impl Fn(u64) -> Option<Value>) -> Vec<Broken> {
    let length = site
        .field
        .details()
        .constraints
        .length
        .filter(|_| !site.is_item);
    let Some((least, most)) = length else {
        return Vec::new();
    };
    let edges = [
        ("_short", least.checked_sub(1)),
        ("_long", most.checked_add(1)),
    ];
    let broken = edges.into_iter().filter_map(|(form, length)| {
        let length = length.filter(|length| *length <= LONGEST)?;
        Some(("bad_length", form, value(length)?))
    });
    broken.collect()
}

/// Returns the sample with one character changed so that it breaks the pattern.
fn bad_pattern(field: &Field, sample: &str) -> Option<Broken> {
    field.details().constraints.pattern.as_ref()?;
    let stem: String = sample
        .chars()
        .take(sample.chars().count().saturating_sub(1))
        .collect();
    let candidates = ['!', ' ', 'x', '0', '\u{1}'].map(|last| format!("{stem}{last}"));
    let wrong = candidates
        .into_iter()
        .find(|wrong| !pattern_takes(field, wrong))?;
    Some(("bad_pattern", "", text(&wrong)))
}
