//! Under which values of the fields beside it a field is there: for the derive, and for people.

use super::enums::enum_wire;
use super::facts::code;
use super::messages::constant;
use crate::surface::expr::{Expr, Expressions};
use crate::surface::package::Spelled;
use fc_spec::model::{Asked, Condition, Field, Scalar, Type, Value};

/// A struct's fields, of which one may have a condition that asks the others.
pub struct Conditions<'c, 's, 'p, 'm> {
    /// The fields.
    pub fields: &'c [Spelled<'m, Field>],
    /// Makes their values.
    pub expressions: &'c Expressions<'s, 'p, 'm>,
}

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

    /// What its comment says of it.
    pub fn sentence(&self, field: &Field) -> Option<String> {
        let condition = field.details().condition.as_ref()?;
        let is = if field.optional { "Present" } else { "Valid" };
        let word = match condition {
            Condition::When(_) => "only when",
            Condition::Unless(_) => "unless",
        };
        let asked = self.each(condition, " or ", |beside, wire| {
            match self.value(beside, wire) {
                Expr::Value(item, value) => format!("`{}::{}`", item.ty.name, value.name),
                value => code(&constant(&value)),
            }
        });
        let asked: Vec<String> = asked
            .map(|(name, any)| format!("`{name}` is {any}"))
            .collect();
        Some(format!("{is} {word} {}.", asked.join(" and ")))
    }

    /// The name of each field that is asked, and its values.
    fn each<'a>(
        &'a self,
        condition: &'a Condition,
        or: &'a str,
        value: impl Fn(&Spelled<'_, Field>, &Scalar) -> String + 'a,
    ) -> impl Iterator<Item = (&'a str, String)> + 'a {
        condition
            .asked()
            .iter()
            .filter_map(move |Asked { wire, values }| {
                let beside = self.fields.iter().find(|field| field.wire == *wire)?;
                let values: Vec<String> = values.iter().map(|wire| value(beside, wire)).collect();
                Some((&*beside.name, values.join(or)))
            })
    }

    fn value(&self, field: &Field, wire: &Scalar) -> Expr<'_> {
        self.expressions.value(&field.ty, &Value::from(wire))
    }
}
