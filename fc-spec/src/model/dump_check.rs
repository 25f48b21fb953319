//! Checks the bodies and examples of a dump against its types.

use super::{
    EnumRepr, Example, Field, Model, Number, StructType, Type, TypeShape, Unlinked, Value, WireForm,
};

impl Model {
    /// Checks that every type built from a body belongs to a body of an operation.
    pub(super) fn check_bodies(&self) -> Result<(), Unlinked> {
        for ty in &self.types {
            let Some(body) = &ty.body_of else { continue };
            let operation = self.operations.iter().find(|it| it.name == body.operation);
            let found = operation.and_then(|it| it.body(body.side));
            if !found.is_some_and(|it| !body.path.is_empty() || it.ty.name() == ty.name) {
                let side = body.side.name();
                return Err(Unlinked {
                    missing: format!("the {side} of `{}`", body.operation),
                    user: format!("`{}`", ty.name),
                });
            }
        }
        Ok(())
    }

    /// Returns the first place with a value that does not fit its type: a field as `Type.key`, or a table.
    pub(super) fn misfit(&self) -> Option<String> {
        let mut fields = self.types.iter().filter_map(|ty| {
            let mut fields = ty.shape.structure()?.fields.iter();
            let field = fields.find(|field| !self.fits_field(field))?;
            Some(format!("{}.{}", ty.name, field.wire))
        });
        let mut tables = self.tables.iter().filter(|table| {
            let shape = self.types.structure(&table.row);
            !table.rows.iter().all(|row| self.fits_struct(shape, row))
        });
        fields.next().or_else(|| Some(tables.next()?.id.clone()))
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
                (TypeShape::Struct(shape), value) => self.fits_struct(shape, value),
                (TypeShape::Enum(shape), Value::String(_)) => shape.repr == EnumRepr::String,
                (TypeShape::Enum(shape), Value::Number(_)) => shape.repr != EnumRepr::String,
                (TypeShape::OneOf(_), Value::Object(_)) => true,
                _ => false,
            },
            _ => false,
        }
    }

    fn fits_struct(&self, shape: &StructType, value: &Value) -> bool {
        let Value::Object(entries) = value else {
            return false;
        };
        let mut required = shape.fields.iter().filter(|field| !field.optional);
        let is_whole = required.all(|field| value.get(&field.wire).is_some());
        is_whole
            && entries.iter().all(|(key, value)| {
                let field = shape.field(key);
                field.is_none_or(|field| self.fits(field, value))
            })
    }
}
