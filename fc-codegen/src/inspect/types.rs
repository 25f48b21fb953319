//! Types and tables.

use super::body::{facts, wire};
use super::build::{
    dated, described, list, object, or_null, place, scalar, string, text, text_entries, type_name,
};
use super::state;
use crate::sample::Samples;
use fc_spec::model::{
    BodyField, EnumRepr, EnumType, Example, Field, OneOf, StructType, Table, TypeDef, TypeShape,
    Value,
};

/// An entry of `types`.
pub(super) fn type_def(samples: &Samples<'_>, ty: &TypeDef) -> Value {
    let (kind, shape) = match &ty.shape {
        TypeShape::Struct(shape) => ("struct", struct_entries(samples, shape)),
        TypeShape::Enum(shape) => ("enum", enum_entries(shape)),
        TypeShape::OneOf(choice) => ("one_of", one_of_entries(choice)),
    };
    let mut entries = vec![
        ("name".to_owned(), string(&ty.name)),
        ("kind".to_owned(), string(kind)),
        ("group".to_owned(), or_null(ty.group.as_deref(), string)),
        ("body_of".to_owned(), or_null(ty.body_of.as_ref(), body_of)),
    ];
    entries.extend(text_entries(&ty.title));
    entries.extend([
        ("about".to_owned(), or_null(ty.about.as_ref(), text)),
        ("since".to_owned(), or_null(ty.since.as_deref(), string)),
        ("changes".to_owned(), list(&ty.changes, dated)),
        ("place".to_owned(), place(&ty.location)),
    ]);
    entries.extend(
        shape
            .into_iter()
            .map(|(key, value)| (key.to_owned(), value)),
    );
    Value::Object(entries)
}

fn body_of(body: &BodyField) -> Value {
    let side = if body.request { "request" } else { "response" };
    object([
        ("operation", string(&body.operation)),
        ("side", string(side)),
        ("path", list(&body.path, |key| string(key))),
    ])
}

type Entries = Vec<(&'static str, Value)>;

fn struct_entries(samples: &Samples<'_>, shape: &StructType) -> Entries {
    vec![
        ("state", state(shape.state)),
        (
            "fields",
            list(&shape.fields, |field| self::field(samples, field)),
        ),
    ]
}

fn field(samples: &Samples<'_>, field: &Field) -> Value {
    let example = match &field.example {
        Example::Given(value) => value.clone(),
        Example::Derived | Example::Absent => Value::Null,
    };
    let mut entries = vec![
        ("path".to_owned(), string(&field.wire)),
        ("type".to_owned(), Value::String(type_name(&field.ty))),
        ("optional".to_owned(), Value::Bool(field.optional)),
        (
            "wire".to_owned(),
            string(wire(samples, &field.ty, field.wire_form)),
        ),
        ("example".to_owned(), example),
        ("variants".to_owned(), Value::Array(Vec::new())),
    ];
    entries.extend(text_entries(&field.text));
    entries.extend(facts(Some(field)));
    Value::Object(entries)
}

fn enum_entries(shape: &EnumType) -> Entries {
    let repr = match shape.repr {
        EnumRepr::Int(kind) => kind.name(),
        EnumRepr::String => "string",
    };
    let values = list(&shape.values, |value| {
        described(
            [
                ("value", scalar(&value.wire)),
                ("name", string(&value.name)),
            ],
            &value.text,
            [("since", or_null(value.since.as_deref(), string))],
        )
    });
    vec![
        ("repr", string(repr)),
        ("closed", Value::Bool(shape.closed)),
        ("values", values),
    ]
}

fn one_of_entries(choice: &OneOf) -> Entries {
    let variants = list(&choice.variants, |variant| {
        described(
            [
                ("name", string(&variant.name)),
                ("type", string(&variant.ty)),
            ],
            &variant.text,
            [],
        )
    });
    vec![("variants", variants)]
}

/// An entry of `tables`.
pub(super) fn table(table: &Table) -> Value {
    described(
        [
            ("id", string(&table.id)),
            ("row", string(&table.row)),
            ("rows", Value::Array(table.rows.clone())),
        ],
        &table.title,
        [
            ("about", text(&table.about)),
            ("place", place(&table.location)),
        ],
    )
}
