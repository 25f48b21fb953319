//! Operations and the flat list of what may stand in their bodies.

use super::build::{
    aliases, dated, deprecation, described, list, number, object, or_null, place, scalar, string,
    text, type_name,
};
use super::state;
use crate::sample::{Profile, Samples};
use fc_spec::model::{
    Body, EnumRepr, Field, Kind, Operation, PortRole, Quirk, Side, Text, Type, TypeShape, Value,
    WireForm,
};
use std::collections::HashMap;

/// An operation.
pub(super) fn operation(samples: &Samples<'_>, operation: &Operation) -> Value {
    let model = samples.model();
    described(
        [
            ("name", string(&operation.name)),
            ("kind", string(kind_name(operation.kind))),
            ("kind_state", state(operation.kind_state)),
            ("group", string(&operation.group)),
        ],
        &operation.title,
        [
            ("aliases", aliases(&operation.aliases)),
            ("about", or_null(operation.about.as_ref(), text)),
            ("code", or_null(operation.code.value, number)),
            ("code_state", state(operation.code.state)),
            ("sender", string(sender_name(operation.sender))),
            (
                "port",
                or_null(model.transport.port(operation.port), |port| {
                    number(port.number)
                }),
            ),
            (
                "effect",
                or_null(operation.effect, |effect| string(effect.name())),
            ),
            (
                "effect_state",
                or_null(operation.effect, |_| state(operation.effect_state)),
            ),
            (
                "sections",
                list(&operation.sections, |section| number(*section)),
            ),
            ("lost", list(&operation.lost, |lost| string(lost))),
            ("request", body(samples, &operation.request)),
            ("response", body(samples, &operation.response)),
            (
                "ack",
                or_null(operation.ack, |ack| {
                    object([
                        ("timeout_ms", number(ack.timeout_ms)),
                        ("retries", number(ack.retries)),
                    ])
                }),
            ),
            (
                "result_text",
                or_null(operation.result_text.as_deref(), string),
            ),
            ("errors", list(&operation.errors, |code| number(*code))),
            ("since", or_null(operation.since.as_deref(), string)),
            (
                "deprecated",
                or_null(operation.deprecated.as_ref(), deprecation),
            ),
            ("changes", list(&operation.changes, dated)),
            ("place", place(&operation.location)),
        ],
    )
}

fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Command => "command",
        Kind::Report => "report",
        Kind::Stream => "stream",
    }
}

fn sender_name(side: Side) -> &'static str {
    match side {
        Side::App => "app",
        Side::Robot => "robot",
    }
}

/// `command` or `data`.
pub(super) fn port_name(role: PortRole) -> &'static str {
    match role {
        PortRole::Command => "command",
        PortRole::Data => "data",
    }
}

fn body(samples: &Samples<'_>, body: &Body) -> Value {
    let mut walk = Walk {
        samples,
        entries: Vec::new(),
        at: HashMap::new(),
    };
    if let Some(name) = &body.ty {
        let example = samples.named(name, Profile::Example);
        walk.named(name, "", Some(&example), None);
    }
    object([
        ("state", state(body.state)),
        ("note", or_null(body.note.as_ref(), text)),
        ("type", or_null(body.ty.as_deref(), string)),
        (
            "fields",
            walk.entries.into_iter().map(Entry::into_value).collect(),
        ),
    ])
}

/// A field of a body.
struct Entry<'m> {
    path: String,
    ty: &'m Type,
    wire: &'static str,
    text: &'m Text,
    example: Value,
    optional: bool,
    variants: Vec<&'m str>,
    /// The field; `None` for the item of a list.
    field: Option<&'m Field>,
}

impl Entry<'_> {
    fn into_value(self) -> Value {
        let mut entries = vec![
            ("path".to_owned(), Value::String(self.path)),
            ("type".to_owned(), Value::String(type_name(self.ty))),
            ("optional".to_owned(), Value::Bool(self.optional)),
            ("wire".to_owned(), string(self.wire)),
            ("example".to_owned(), self.example),
            (
                "variants".to_owned(),
                list(&self.variants, |name| string(name)),
            ),
        ];
        entries.extend(super::build::text_entries(self.text));
        entries.extend(facts(self.field));
        Value::Object(entries)
    }
}

/// What else the spec says about a field.
pub(super) fn facts(field: Option<&Field>) -> Vec<(String, Value)> {
    let length = |(least, most): (u64, u64)| [least, most].into_iter().map(number).collect();
    let strings = |texts: &[String]| list(texts, |text| string(text));
    let facts = [
        ("name", or_null(field, |field| string(&field.name))),
        (
            "unit",
            or_null(
                field.and_then(|field| field.details().unit.as_deref()),
                string,
            ),
        ),
        (
            "min",
            or_null(
                field.and_then(|field| field.details().min.clone()),
                Value::Number,
            ),
        ),
        (
            "max",
            or_null(
                field.and_then(|field| field.details().max.clone()),
                Value::Number,
            ),
        ),
        (
            "length",
            or_null(field.and_then(|field| field.details().length), length),
        ),
        (
            "pattern",
            or_null(
                field.and_then(|field| field.details().pattern.as_deref()),
                string,
            ),
        ),
        (
            "default",
            or_null(
                field.and_then(|field| field.details().default.as_ref()),
                scalar,
            ),
        ),
        (
            "quirks",
            list(
                field.map_or(&[], |field| &field.details().quirks),
                |quirk| {
                    string(match quirk {
                        Quirk::EmptyIsAbsent => "empty_is_absent",
                        Quirk::LenientNumber => "lenient_number",
                        Quirk::LenientBool => "lenient_bool",
                    })
                },
            ),
        ),
        (
            "also",
            strings(field.map_or(&[], |field| &field.details().also)),
        ),
        (
            "sensitive",
            Value::Bool(field.is_some_and(|field| field.sensitive)),
        ),
        (
            "since",
            or_null(
                field.and_then(|field| field.details().since.as_deref()),
                string,
            ),
        ),
        (
            "deprecated",
            or_null(
                field.and_then(|field| field.details().deprecated.as_ref()),
                deprecation,
            ),
        ),
        (
            "note",
            or_null(field.and_then(|field| field.details().note.as_ref()), text),
        ),
    ];
    facts
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}

/// A walk over a body and everything in it.
struct Walk<'s, 'm> {
    samples: &'s Samples<'m>,
    entries: Vec<Entry<'m>>,
    /// Where the entry of each path stands: variants of a choice share their keys.
    at: HashMap<String, usize>,
}

impl<'m> Walk<'_, 'm> {
    /// Adds what is in a named type at `path`.
    fn named(&mut self, name: &str, path: &str, example: Option<&Value>, variant: Option<&'m str>) {
        let Some(ty) = self.samples.type_named(name) else {
            return;
        };
        match &ty.shape {
            TypeShape::Enum(_) => {}
            TypeShape::Struct(shape) => {
                for field in &shape.fields {
                    self.field(field, path, example, variant);
                }
            }
            TypeShape::OneOf(choice) => {
                for variant in &choice.variants {
                    let example = self.samples.named(&variant.ty, Profile::Example);
                    self.named(&variant.ty, path, Some(&example), Some(&variant.name));
                }
            }
        }
    }

    fn field(
        &mut self,
        field: &'m Field,
        path: &str,
        example: Option<&Value>,
        variant: Option<&'m str>,
    ) {
        let path = match path {
            "" => field.wire.clone(),
            path => format!("{path}.{}", field.wire),
        };
        let example = example.and_then(|example| example.get(&field.wire));
        if let (Some(variant), Some(entry)) = (
            variant,
            self.at.get(&path).and_then(|at| self.entries.get_mut(*at)),
        ) {
            entry.variants.push(variant);
            return;
        }
        self.add(Entry {
            path: path.clone(),
            ty: &field.ty,
            wire: wire(self.samples, &field.ty, field.wire_form),
            text: &field.text,
            example: example.cloned().unwrap_or(Value::Null),
            optional: field.optional || variant.is_some(),
            variants: variant.into_iter().collect(),
            field: Some(field),
        });
        self.inside(&field.ty, &path, field, example);
    }

    /// Adds what is in a value of this type.
    fn inside(&mut self, ty: &'m Type, path: &str, field: &'m Field, example: Option<&Value>) {
        match ty {
            Type::Named(name) => self.named(name, path, example, None),
            Type::Array(item) => {
                let path = format!("{path}[]");
                let example = match example {
                    Some(Value::Array(items)) => items.first(),
                    _ => None,
                };
                let text = match &**item {
                    Type::Named(name) => self.samples.type_named(name).map(|ty| &ty.title),
                    _ => None,
                };
                self.add(Entry {
                    path: path.clone(),
                    ty: item,
                    wire: wire(self.samples, item, field.wire_form),
                    text: text.unwrap_or(&field.text),
                    example: example.cloned().unwrap_or(Value::Null),
                    optional: false,
                    variants: Vec::new(),
                    field: None,
                });
                self.inside(item, &path, field, example);
            }
            _ => {}
        }
    }

    fn add(&mut self, entry: Entry<'m>) {
        self.at.insert(entry.path.clone(), self.entries.len());
        self.entries.push(entry);
    }
}

/// How a value of this type travels.
pub(super) fn wire(samples: &Samples<'_>, ty: &Type, form: WireForm) -> &'static str {
    match ty {
        Type::Array(_) => "array",
        Type::Bool | Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS
            if form == WireForm::String =>
        {
            "string"
        }
        Type::Bool => "bool",
        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS => "number",
        Type::String | Type::Base64 => "string",
        Type::Json => "any",
        Type::Named(name) => match samples.type_named(name).map(|ty| &ty.shape) {
            Some(TypeShape::Enum(shape)) => match shape.repr {
                EnumRepr::Int(_) => "number",
                EnumRepr::String => "string",
            },
            _ => "object",
        },
    }
}
