//! Constraints and wire forms of a field, as names and values that each language spells.

use super::conditions::{Asked, asked};
use crate::package::items::Spelled;
use fc_spec::model::{Constraint, Field, Number, Quirk, Scalar, WireForm};

/// The marks of a field.
pub struct FieldMarks<'f, 'm> {
    /// The alternative keys that a reader accepts.
    pub also: &'f [String],
    /// The wire form, unless it is the default of the type.
    pub form: Option<&'static str>,
    /// The constraints, in the order of the checks.
    pub constraints: Vec<(&'static str, Bound<'f>)>,
    /// The names of the quirks.
    pub quirks: Vec<&'static str>,
    /// `true` if numbers or bools are also read from other forms.
    pub is_lenient: bool,
    /// `true` if empty values are read as absent.
    pub empty_is_absent: bool,
    /// The condition of an optional field.
    pub condition: Option<Asked<'f, 'm>>,
}

/// The value of a constraint.
#[derive(Clone, Copy, Debug)]
pub enum Bound<'f> {
    /// A number.
    Number(&'f Number),
    /// The least and the most of a count.
    Range(u64, u64),
    /// A regular expression that every language reads.
    Pattern(&'f str),
    /// Values in wire form.
    Values(&'f [Scalar]),
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
            constraints: details.constraints().map(bound).collect(),
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

fn bound(constraint: Constraint<'_>) -> (&'static str, Bound<'_>) {
    match constraint {
        Constraint::Min(min) => ("min", Bound::Number(min)),
        Constraint::Max(max) => ("max", Bound::Number(max)),
        Constraint::Length(least, most) => ("length", Bound::Range(least, most)),
        Constraint::Pattern(pattern) => ("pattern", Bound::Pattern(pattern.portable())),
        Constraint::Only(taken) => ("only", Bound::Values(taken)),
    }
}
