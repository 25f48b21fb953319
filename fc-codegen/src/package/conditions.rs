//! Under which values of other fields of its struct a field is there.

use super::facts::code;
use crate::package::expr::{Expr, Expressions};
use crate::package::items::Spelled;
use fc_spec::model::{Condition, Field, Scalar, Value};

/// The fields that a condition asks.
pub struct Asked<'f, 'm> {
    /// `when` or `unless`.
    pub word: &'static str,
    /// The fields, each with the values of which it must have one.
    pub fields: Vec<(&'f Spelled<'m, Field>, &'f [Scalar])>,
}

/// What the condition of a field asks of the fields of its struct.
pub fn asked<'f, 'm>(field: &'f Field, fields: &'f [Spelled<'m, Field>]) -> Option<Asked<'f, 'm>> {
    let condition = field.details().condition.as_ref()?;
    let asked = condition.asked().iter().filter_map(|asked| {
        let other = fields.iter().find(|other| other.wire == asked.wire)?;
        Some((other, asked.values.as_slice()))
    });
    Some(Asked {
        word: match condition {
            Condition::When(_) => "when",
            Condition::Unless(_) => "unless",
        },
        fields: asked.collect(),
    })
}

impl Asked<'_, '_> {
    /// The name of each field, and its values.
    pub fn each(
        &self,
        or: &str,
        value: impl Fn(&Spelled<'_, Field>, &Scalar) -> String,
    ) -> Vec<(&str, String)> {
        let fields = self.fields.iter().map(|(field, values)| {
            let values: Vec<String> = values.iter().map(|wire| value(field, wire)).collect();
            (&*field.name, values.join(or))
        });
        fields.collect()
    }
}

/// The sentence about the condition of a field, with constants as the language spells them.
pub fn sentence(
    expressions: &Expressions<'_, '_>,
    field: &Field,
    fields: &[Spelled<'_, Field>],
    spelled: impl Fn(&Expr<'_>) -> String,
) -> Option<String> {
    let asked = asked(field, fields)?;
    let is = if field.optional { "Present" } else { "Valid" };
    let only = if asked.word == "when" { "only " } else { "" };
    let each = asked.each(" or ", |other, wire| {
        let value = expressions.value(&other.ty, &Value::from(wire));
        code(&spelled(&value))
    });
    let each = each.iter().map(|(name, any)| format!("`{name}` is {any}"));
    let each: Vec<String> = each.collect();
    Some(format!("{is} {only}{} {}.", asked.word, each.join(" and ")))
}
