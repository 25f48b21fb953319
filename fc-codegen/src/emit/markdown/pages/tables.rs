//! The tables of constants.

use super::picture;
use super::shared::{AnswerView, Desk};
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::places::Kept;
use crate::emit::markdown::rows::Row;
use fc_spec::model::{Subject, Table, TypeDef, TypeShape, Value};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct TablesView {
    tables: Vec<TableView>,
}

#[derive(Debug, Serialize)]
struct TableView {
    anchor: String,
    id: String,
    title: String,
    about: String,
    row_type: Link,
    kept: Option<Kept>,
    /// The rows as grids of parts, if the table has this form.
    picture: Option<String>,
    /// The keys whose values fit a cell. The picture and the JSON show nested values.
    columns: Vec<Column>,
    /// The cells as JSON, in the order of the columns; empty if the row lacks the key.
    rows: Vec<Vec<String>>,
    fields: Vec<Row>,
    json: String,
    answers: Vec<AnswerView>,
    spec: Link,
}

#[derive(Debug, Serialize)]
struct Column {
    key: String,
    text: String,
}

pub(in crate::emit::markdown) fn tables(desk: Desk<'_, '_>) -> TablesView {
    TablesView {
        tables: desk
            .book
            .model
            .tables
            .iter()
            .map(|table| view(desk, table))
            .collect(),
    }
}

fn view(desk: Desk<'_, '_>, table: &Table) -> TableView {
    let row_type = desk.book.model.types.get(&table.row);
    let columns = columns(desk, table, row_type);
    let cells = |row: &Value| {
        let cell = |column: &Column| {
            row.get(&column.key)
                .map(Value::to_string)
                .unwrap_or_default()
        };
        columns.iter().map(cell).collect()
    };
    TableView {
        anchor: Anchor::of("table", &table.id).id(),
        id: table.id.clone(),
        title: desk.lang.text(&table.title).to_owned(),
        about: desk.sentence(&table.about),
        row_type: Link {
            text: table.row.to_string(),
            href: desk.page.link(desk.book.place_of_type(row_type)),
        },
        kept: table.kept.as_deref().map(|name| desk.rows().kept(name)),
        picture: picture::picture(desk, table, row_type),
        rows: table.rows.iter().map(cells).collect(),
        columns,
        fields: desk
            .rows()
            .of_type(row_type, Anchor::of("table", &table.id)),
        json: Value::Array(table.rows.clone()).pretty(),
        answers: desk.answers_to(&Subject::Table(table.id.clone())),
        spec: desk.spec(&table.location),
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
