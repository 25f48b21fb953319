//! Under which values of the fields beside it a field is there, for people.

use super::facts::code;
use crate::surface::expr::{Expr, Expressions};
use crate::surface::package::Spelled;
use fc_spec::model::{Asked, Condition, Field, Scalar, Value};

/// A struct's fields, of which one may have a condition that asks the others.
pub struct Conditions<'c, 's, 'p, 'm> {
    /// The fields.
    pub fields: &'c [Spelled<'m, Field>],
    /// Makes their values.
    pub expressions: &'c Expressions<'s, 'p, 'm>,
}

impl Conditions<'_, '_, '_, '_> {
    /// What its comment says of it, with constants as the language spells them.
    pub fn sentence(&self, field: &Field, spelled: impl Fn(&Expr<'_>) -> String) -> Option<String> {
        let condition = field.details().condition.as_ref()?;
        let is = if field.optional { "Present" } else { "Valid" };
        let word = match condition {
            Condition::When(_) => "only when",
            Condition::Unless(_) => "unless",
        };
        let asked = self.each(condition, " or ", |beside, wire| {
            code(&spelled(&self.value(beside, wire)))
        });
        let asked: Vec<String> = asked
            .map(|(name, any)| format!("`{name}` is {any}"))
            .collect();
        Some(format!("{is} {word} {}.", asked.join(" and ")))
    }

    /// The name of each field that is asked, and its values.
    pub fn each<'a>(
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

    pub fn value(&self, field: &Field, wire: &Scalar) -> Expr<'_> {
        self.expressions.value(&field.ty, &Value::from(wire))
    }
}
