//! The tables of constants.

use super::picture;
use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use fc_spec::model::{Field, Subject, Table, Value};
use minijinja::context;
use minijinja::value::Serde;

pub(in crate::emit::markdown) fn tables(desk: Desk<'_, '_>) -> minijinja::Value {
    let tables = desk.book.model.tables.iter();
    context! {
        tables => list(tables.map(|table| view(desk, table))),
    }
}

fn view(desk: Desk<'_, '_>, table: &Table) -> minijinja::Value {
    let row_type = desk.book.model.types.get(&table.row);
    let shape = desk.book.model.types.structure(&table.row);
    let is_flat = |field: &&Field| {
        let mut values = table.rows.iter().filter_map(|row| row.get(&field.wire));
        values.all(|value| !nests(value))
    };
    let columns: Vec<&Field> = shape.fields.iter().filter(is_flat).collect();
    let cells = |row: &Value| {
        let cells = columns.iter().map(|column| row.get(&column.wire));
        let cells = cells.map(|cell| cell.map(Value::to_string).unwrap_or_default());
        cells.collect::<Vec<_>>()
    };
    let head = |column: &&Field| {
        context! { key => &column.wire, text => desk.lang.text(&column.text) }
    };
    context! {
        anchor => Anchor::of("table", &table.id).id(),
        id => &table.id,
        title => desk.lang.text(&table.title),
        about => desk.sentence(&table.about),
        row_type => desk.to(table.row.to_string(), desk.book.place_of_type(row_type)),
        kept => table.kept.as_deref().map(|name| desk.kept(name)),
        picture => picture::picture(desk, table, shape),
        rows => list(table.rows.iter().map(cells)),
        columns => list(columns.iter().map(head)),
        fields => Serde(desk.type_rows(row_type, Anchor::of("table", &table.id))),
        json => Value::Array(table.rows.clone()).pretty(),
        answers => desk.answers_to(&Subject::Table(table.id.clone())),
        spec => desk.spec(&table.location),
    }
}

fn nests(value: &Value) -> bool {
    match value {
        Value::Object(_) => true,
        Value::Array(items) => items.iter().any(nests),
        _ => false,
    }
}
