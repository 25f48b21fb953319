//! Conditions of fields, as derive attributes and as Rust values in comments.

use super::enums::enum_wire;
use super::messages::constant;
use crate::package::conditions::Asked;
use crate::package::expr::Expr;
use crate::package::items::Package;
use crate::package::joined::Joined;
use fc_spec::model::{Type, Value};

/// Returns the attribute of a conditional field: `when(mode = 2 | 3)`.
pub fn attribute(package: &Package<'_>, condition: &Asked<'_, '_>) -> String {
    let asked = condition.each(" | ", |other, wire| match &other.ty {
        Type::Named(_) => enum_wire(wire),
        ty => constant(&package.value(ty, &Value::from(wire))),
    });
    let asked = asked.iter().map(|(name, any)| format!("{name} = {any}"));
    format!("{}({})", condition.word, asked.joined(", "))
}

/// Returns a value as comments write it.
pub fn spelled(value: &Expr<'_>) -> String {
    match value {
        Expr::Value(item, value) => format!("{}::{}", item.ty.name, value.name),
        value => constant(value),
    }
}
