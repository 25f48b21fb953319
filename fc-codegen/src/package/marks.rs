//! Constraints and wire forms of a field, as names and values that each language spells.

use super::conditions::{Asked, asked};
use crate::package::items::Spelled;
use fc_spec::model::{Argument, Constraint, Field, Quirk, WireForm};

/// The marks of a field.
pub struct FieldMarks<'f, 'm> {
    /// The alternative keys that a reader accepts.
    pub also: &'f [String],
    /// The wire form, unless it is the default of the type.
    pub form: Option<&'static str>,
    /// The constraints, in the order of the checks.
    pub constraints: Vec<(&'static str, Argument<'f>)>,
    /// The names of the quirks.
    pub quirks: Vec<&'static str>,
    /// `true` if numbers or bools are also read from other forms.
    pub is_lenient: bool,
    /// `true` if empty values are read as absent.
    pub empty_is_absent: bool,
    /// The condition of an optional field.
    pub condition: Option<Asked<'f, 'm>>,
}

impl<'f, 'm> FieldMarks<'f, 'm> {
    /// Returns the marks of a field in a struct with these fields.
    pub fn build(field: &'f Field, fields: &'f [Spelled<'m, Field>]) -> Self {
        let details = field.details();
        let form = field.wire_form;
        let has = |quirk| details.quirks.contains(&quirk);
        Self {
            also: &details.also,
            form: (form != WireForm::Plain).then(|| form.name()),
            constraints: details.constraints.iter().map(named).collect(),
            quirks: details.quirks.iter().map(|quirk| quirk.name()).collect(),
            is_lenient: has(Quirk::LenientNumber) || has(Quirk::LenientBool),
            empty_is_absent: has(Quirk::EmptyIsAbsent),
            condition: asked(field, fields).filter(|_| field.optional),
        }
    }
}

impl FieldMarks<'_, '_> {
    /// Returns the names of the quirks, in the order of the vocabulary.
    pub fn quirks_in_order(&self) -> impl Iterator<Item = &'static str> {
        let quirks = Quirk::ALL.iter().map(|quirk| quirk.name());
        quirks.filter(|name| self.quirks.contains(name))
    }
}

fn named(constraint: Constraint<'_>) -> (&'static str, Argument<'_>) {
    (constraint.name(), constraint.argument())
}
