//! Conditions that make a field depend on the values of other fields of its struct.

use super::facts::code;
use crate::package::expr::Expr;
use crate::package::items::{Package, Spelled};
use crate::package::joined::Joined;
use fc_spec::model::{Condition, Field, Scalar, Value};

/// The fields that a condition tests.
pub struct Asked<'f, 'm> {
    /// `when` or `unless`.
    pub word: &'static str,
    /// The fields, each with its accepted values.
    pub fields: Vec<(&'f Spelled<'m, Field>, &'f [Scalar])>,
}

/// Returns the fields that the condition of `field` tests; `None` without a condition.
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
    /// Returns the name of each field with its values, joined by `or`.
    pub fn each(
        &self,
        or: &str,
        value: impl Fn(&Spelled<'_, Field>, &Scalar) -> String,
    ) -> Vec<(&str, String)> {
        let fields = self.fields.iter().map(|(field, values)| {
            let values = values.iter().map(|wire| value(field, wire));
            (&*field.name, values.joined(or))
        });
        fields.collect()
    }
}

/// Returns the sentence about the condition of a field. `spelled` writes a constant in the language.
pub fn sentence(
    package: &Package<'_>,
    field: &Field,
    fields: &[Spelled<'_, Field>],
    spelled: impl Fn(&Expr<'_>) -> String,
) -> Option<String> {
    let asked = asked(field, fields)?;
    let is = if field.optional { "Present" } else { "Valid" };
    let only = if asked.word == "when" { "only " } else { "" };
    let each = asked.each(" or ", |other, wire| {
        let value = package.value(&other.ty, &Value::from(wire));
        code(&spelled(&value))
    });
    let each = each.iter().map(|(name, any)| format!("`{name}` is {any}"));
    let each = each.joined(" and ");
    Some(format!("{is} {only}{} {each}.", asked.word))
}
