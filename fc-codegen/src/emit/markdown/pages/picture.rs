//! Tables that divide the same numbered parts among groups, such as the doors of a box among its compartments. Each row
//! becomes a line of text, and the site draws it as a grid.

use super::shared::Desk;
use fc_spec::model::{EnumRepr, Field, Number, StructType, Table, Type, TypeShape, Value};
use std::fmt::Write as _;

/// Returns a line for each row, such as `1: 左上 #1 = 1; 右上 #2 = 2`. The row type must have one array of structs, and
/// these one array of integers. Every row must contain the same numbers from 1 up; otherwise the result is `None`.
pub(super) fn picture(desk: Desk<'_, '_>, table: &Table, row: &StructType) -> Option<String> {
    let (groups, group) = only(row, |field| match &field.ty {
        Type::Array(item) => match (&**item, named(desk, item)) {
            (Type::Named(_), Some(TypeShape::Struct(shape))) => Some(shape),
            _ => None,
        },
        _ => None,
    })?;
    let (parts, ()) = only(group, |field| match &field.ty {
        Type::Array(item) if matches!(**item, Type::Int(_)) => Some(()),
        _ => None,
    })?;
    let label = group
        .fields
        .iter()
        .find_map(|field| match named(desk, &field.ty) {
            Some(TypeShape::Enum(shape)) if shape.repr == EnumRepr::String => Some((field, shape)),
            _ => None,
        })?;
    let id = |shape: &StructType| {
        let field = shape
            .fields
            .iter()
            .find(|field| matches!(field.ty, Type::Int(_)));
        field.map(|field| field.wire.clone())
    };
    let (row_id, group_id) = (id(row)?, id(group)?);

    let mut lines = String::new();
    let mut total = None;
    for value in &table.rows {
        let Value::Array(cells) = value.get(&groups.wire)? else {
            return None;
        };
        let mut spelled = Vec::new();
        let mut all = Vec::new();
        for cell in cells {
            let Value::Array(numbers) = cell.get(&parts.wire)? else {
                return None;
            };
            let numbers: Option<Vec<i128>> = numbers.iter().map(int).collect();
            let wire = cell.get(&label.0.wire)?;
            let word = label.1.values.iter().find_map(|known| {
                let same = super::super::rows::scalar(&known.wire) == wire.to_string();
                same.then(|| desk.lang.text(&known.text))
            })?;
            let words: Vec<String> = numbers.iter().flatten().map(ToString::to_string).collect();
            spelled.push(format!(
                "{word} #{} = {}",
                int(cell.get(&group_id)?)?,
                words.join(" ")
            ));
            all.extend(numbers?);
        }
        all.sort_unstable();
        if !all.iter().copied().eq(1..=i128::try_from(all.len()).ok()?)
            || *total.get_or_insert(all.len()) != all.len()
        {
            return None;
        }
        // Writing to a String cannot fail.
        let _ = writeln!(
            lines,
            "{}: {}",
            int(value.get(&row_id)?)?,
            spelled.join("; ")
        );
    }
    (!lines.is_empty()).then_some(lines)
}

/// Returns the field that `is` accepts, if there is exactly one.
fn only<'m, T>(
    shape: &'m StructType,
    is: impl Fn(&'m Field) -> Option<T>,
) -> Option<(&'m Field, T)> {
    let mut found = shape
        .fields
        .iter()
        .filter_map(|field| Some((field, is(field)?)));
    let first = found.next()?;
    found.next().is_none().then_some(first)
}

fn named<'m>(desk: Desk<'_, 'm>, ty: &Type) -> Option<&'m TypeShape> {
    let Type::Named(named) = ty else { return None };
    Some(&desk.book.model.types.get(named).shape)
}

fn int(value: &Value) -> Option<i128> {
    match value {
        Value::Number(Number::Int(value)) => Some(*value),
        _ => None,
    }
}
