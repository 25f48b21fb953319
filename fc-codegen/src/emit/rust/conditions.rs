//! Under which values of the fields beside it a field is there, for the derive and as Rust spells it.

use super::enums::enum_wire;
use super::messages::constant;
use crate::surface::expr::Expr;
use fc_spec::model::{Condition, Field, Type};

pub use crate::emit::stub::conditions::Conditions;

impl Conditions<'_, '_, '_, '_> {
    /// What the derive has to be told of a field, if that may be absent: `when(mode = 2 | 3)`.
    pub fn attribute(&self, field: &Field) -> Option<String> {
        let condition = field.details().condition.as_ref();
        let condition = condition.filter(|_| field.optional)?;
        let word = match condition {
            Condition::When(_) => "when",
            Condition::Unless(_) => "unless",
        };
        let asked = self.each(condition, " | ", |beside, wire| match &beside.ty {
            Type::Named(_) => enum_wire(wire),
            _ => constant(&self.value(beside, wire)),
        });
        let asked: Vec<String> = asked.map(|(name, any)| format!("{name} = {any}")).collect();
        Some(format!("{word}({})", asked.join(", ")))
    }
}

/// A value as a comment names it.
pub fn spelled(value: &Expr<'_>) -> String {
    match value {
        Expr::Value(item, value) => format!("{}::{}", item.ty.name, value.name),
        value => constant(value),
    }
}
