//! Checks the bodies and examples of a dump against its types.

use super::{
    EnumRepr, Example, Field, Model, Number, Type, TypeDef, TypeShape, Unlinked, Value, WireForm,
};

impl Model {
    /// Checks that every type built from a body belongs to a body of an operation.
    pub(super) fn check_bodies(&self) -> Result<(), Unlinked> {
        for ty in &self.types {
            let Some(body) = &ty.body_of else { continue };
            let operation = self.operations.iter().find(|it| it.name == body.operation);
            let found = operation.and_then(|it| it.body(body.side));
            if !found.is_some_and(|it| !body.path.is_empty() || it.ty.name() == ty.name) {
                return Err(Unlinked {
                    missing: format!("such a body of `{}`", body.operation),
                    user: format!("`{}`", ty.name),
                });
            }
        }
        Ok(())
    }

    /// Returns the first field whose example or default does not fit its type.
    pub(super) fn misfit(&self) -> Option<(&TypeDef, &Field)> {
        self.types.iter().find_map(|ty| {
            let TypeShape::Struct(shape) = &ty.shape else {
                return None;
            };
            let field = shape.fields.iter().find(|field| !self.fits_field(field))?;
            Some((ty, field))
        })
    }

    fn fits_field(&self, field: &Field) -> bool {
        let is_default = |default| self.fits_type(&field.ty, &Value::from(default));
        let is_example = match &field.example {
            Example::Given(value) => self.fits(field, value),
            Example::Derived | Example::Absent => true,
        };
        is_example && field.details().default.as_ref().is_none_or(is_default)
    }

    /// Returns `true` if a field can have this value in wire form. The check ignores constraints.
    fn fits(&self, field: &Field, value: &Value) -> bool {
        match (field.wire_form, &field.ty, value) {
            (WireForm::String, Type::Bool, Value::String(text)) => {
                matches!(text.as_str(), "true" | "false")
            }
            (WireForm::String, _, Value::String(text)) => text.parse::<f64>().is_ok(),
            (WireForm::String, _, _) => false,
            (WireForm::Number, Type::Bool, value) => matches!(value, Value::Number(_)),
            (WireForm::Number | WireForm::Plain, ty, value) => self.fits_type(ty, value),
        }
    }

    fn fits_type(&self, ty: &Type, value: &Value) -> bool {
        match (ty, value) {
            (Type::Json, _)
            | (Type::Bool, Value::Bool(_))
            | (Type::Float(_), Value::Number(_))
            | (Type::String | Type::Base64, Value::String(_)) => true,
            (Type::Int(_) | Type::TimestampMs | Type::TimestampS, Value::Number(number)) => {
                matches!(number, Number::Int(_))
            }
            (Type::Array(item), Value::Array(items)) => {
                items.iter().all(|value| self.fits_type(item, value))
            }
            (Type::Named(named), value) => match (&self.types.get(named).shape, value) {
                (TypeShape::Struct(shape), Value::Object(entries)) => {
                    entries.iter().all(|(key, value)| {
                        shape.field(key).is_none_or(|field| self.fits(field, value))
                    })
                }
                (TypeShape::Enum(shape), Value::String(_)) => shape.repr == EnumRepr::String,
                (TypeShape::Enum(shape), Value::Number(_)) => shape.repr != EnumRepr::String,
                (TypeShape::OneOf(_), Value::Object(_)) => true,
                _ => false,
            },
            _ => false,
        }
    }
}
