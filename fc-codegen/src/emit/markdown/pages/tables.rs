//! The tables of constants.

use super::picture;
use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use fc_spec::model::{Subject, Table, TypeDef, TypeShape, Value};
use minijinja::context;
use minijinja::value::Serde;
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Column {
    key: String,
    text: String,
}

pub(in crate::emit::markdown) fn tables(desk: Desk<'_, '_>) -> minijinja::Value {
    let tables = desk.book.model.tables.iter();
    context! {
        tables => list(tables.map(|table| view(desk, table))),
    }
}

fn view(desk: Desk<'_, '_>, table: &Table) -> minijinja::Value {
    let row_type = desk.book.model.types.get(&table.row);
    let columns = columns(desk, table, row_type);
    let cells = |row: &Value| {
        let cell = |column: &Column| {
            row.get(&column.key)
                .map(Value::to_string)
                .unwrap_or_default()
        };
        columns.iter().map(cell).collect::<Vec<_>>()
    };
    context! {
        anchor => Anchor::of("table", &table.id).id(),
        id => &table.id,
        title => desk.lang.text(&table.title),
        about => desk.sentence(&table.about),
        row_type => desk.to(table.row.to_string(), desk.book.place_of_type(row_type)),
        kept => table.kept.as_deref().map(|name| desk.kept(name)),
        picture => picture::picture(desk, table, row_type),
        rows => list(table.rows.iter().map(cells)),
        columns => Serde(columns),
        fields => Serde(desk.type_rows(row_type, Anchor::of("table", &table.id))),
        json => Value::Array(table.rows.clone()).pretty(),
        answers => desk.answers_to(&Subject::Table(table.id.clone())),
        spec => desk.spec(&table.location),
    }
}

fn columns(desk: Desk<'_, '_>, table: &Table, ty: &TypeDef) -> Vec<Column> {
    let TypeShape::Struct(shape) = &ty.shape else {
        return Vec::new();
    };
    let is_flat = |key: &str| {
        let mut values = table.rows.iter().filter_map(|row| row.get(key));
        values.all(|value| !nests(value))
    };
    let fields = shape.fields.iter().filter(|field| is_flat(&field.wire));
    fields
        .map(|field| Column {
            key: field.wire.clone(),
            text: desk.lang.text(&field.text).to_owned(),
        })
        .collect()
}

fn nests(value: &Value) -> bool {
    match value {
        Value::Object(_) => true,
        Value::Array(items) => items.iter().any(nests),
        _ => false,
    }
}
