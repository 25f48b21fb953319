//! From a type and the examples of its fields to a JSON value.

use super::constraint::{self, Bound};
use fc_spec::model::{
    Direction, EnumType, EnvelopeField, EnvelopeRole, Example, Field, Model, OneOf, Operation,
    Scalar, StructType, Type, TypeDef, TypeShape, Value, WireForm,
};
use std::collections::HashMap;

/// Which of all the messages that a type allows is composed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Profile {
    /// What the spec's examples show.
    Example,
    /// As `Example`, with every optional field there.
    Full,
    /// Required fields only, smallest numbers, shortest strings and arrays that the constraints
    /// allow; what has no lower bound keeps its example.
    Minimal,
    /// Every field, arrays of two items, largest numbers and longest strings.
    Maximal,
}

/// Composes examples. Holds an index of the model's types, so that composing is linear.
#[derive(Clone, Debug)]
pub struct Samples<'m> {
    model: &'m Model,
    types: HashMap<&'m str, &'m TypeDef>,
}

impl<'m> Samples<'m> {
    /// Indexes the types.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        let types = model
            .types
            .iter()
            .map(|ty| (ty.name.as_str(), ty))
            .collect();
        Self { model, types }
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// The type of this name.
    #[must_use]
    pub fn type_named(&self, name: &str) -> Option<&'m TypeDef> {
        self.types.get(name).copied()
    }

    /// The struct of this name.
    #[must_use]
    pub fn struct_named(&self, name: &str) -> Option<&'m StructType> {
        match &self.type_named(name)?.shape {
            TypeShape::Struct(shape) => Some(shape),
            TypeShape::Enum(_) | TypeShape::OneOf(_) => None,
        }
    }

    /// A value of a named type. An unknown name gives an empty object; a checked model has none.
    #[must_use]
    pub fn named(&self, type_name: &str, profile: Profile) -> Value {
        self.value_of_named(type_name, profile, &mut Vec::new())
    }

    /// The own keys of one side of an operation; an empty object for raw bytes.
    #[must_use]
    pub fn body(&self, operation: &Operation, direction: Direction, profile: Profile) -> Value {
        match body_type(operation, direction) {
            Some(name) => self.named(name, profile),
            None => Value::Object(Vec::new()),
        }
    }

    /// A whole message: the envelope, then the own keys.
    #[must_use]
    pub fn message(&self, operation: &Operation, direction: Direction, profile: Profile) -> Value {
        let body = self.body(operation, direction, profile);
        let mut message = self.enveloped(direction, body, profile);
        if let (Value::Object(entries), Some(text)) = (&mut message, &operation.result_text) {
            let is_text = |key: &str| {
                let mut fields = self.envelope(direction).iter();
                fields.any(|field| field.role == EnvelopeRole::ResultText && field.wire == key)
            };
            for (_, value) in entries.iter_mut().filter(|(key, _)| is_text(key)) {
                *value = Value::String(text.clone());
            }
        }
        message
    }

    /// Own keys with the envelope before them.
    #[must_use]
    pub fn enveloped(&self, direction: Direction, body: Value, profile: Profile) -> Value {
        let fields = self.envelope(direction).iter();
        let fields = fields.filter(|field| !(field.optional && profile == Profile::Minimal));
        let mut entries: Vec<(String, Value)> = fields
            .map(|field| (field.wire.clone(), scalar(&field.example)))
            .collect();
        if let Value::Object(own) = body {
            entries.extend(own);
        }
        Value::Object(entries)
    }

    /// The keys that every message of this direction carries.
    #[must_use]
    pub fn envelope(&self, direction: Direction) -> &'m [EnvelopeField] {
        match direction {
            Direction::Request => &self.model.envelope.request,
            Direction::Response => &self.model.envelope.response,
        }
    }

    /// The variant that a received object is read as: the first whose required keys are all there.
    #[must_use]
    pub fn variant_of(&self, choice: &'m OneOf, value: &Value) -> Option<&'m StructType> {
        choice
            .variants
            .iter()
            .filter_map(|variant| self.struct_named(&variant.ty))
            .find(|shape| {
                let mut required = shape.fields.iter().filter(|field| !field.optional);
                required.all(|field| value.get(&field.wire).is_some())
            })
    }

    fn value_of_named(&self, name: &str, profile: Profile, open: &mut Vec<String>) -> Value {
        let Some(ty) = self.type_named(name) else {
            return Value::Object(Vec::new());
        };
        match &ty.shape {
            TypeShape::Struct(shape) => {
                open.push(name.to_owned());
                let value = self.object(shape, profile, open);
                open.pop();
                value
            }
            TypeShape::Enum(shape) => enum_value(shape, profile),
            TypeShape::OneOf(choice) => match choice.variants.first() {
                Some(variant) => self.value_of_named(&variant.ty, profile, open),
                None => Value::Object(Vec::new()),
            },
        }
    }

    fn object(&self, shape: &StructType, profile: Profile, open: &mut Vec<String>) -> Value {
        let mut entries = Vec::with_capacity(shape.fields.len());
        for field in &shape.fields {
            if let Some(value) = self.field(field, profile, open) {
                entries.push((field.wire.clone(), value));
            }
        }
        Value::Object(entries)
    }

    /// `None`: this profile leaves the field out.
    fn field(&self, field: &Field, profile: Profile, open: &mut Vec<String>) -> Option<Value> {
        if field.optional {
            let left_out = match profile {
                Profile::Example => field.example == Example::Absent,
                Profile::Full | Profile::Maximal => self.is_open(&field.ty, open),
                Profile::Minimal => true,
            };
            if left_out {
                return None;
            }
        }
        let given = match &field.example {
            Example::Given(value) => Some(value),
            Example::Derived | Example::Absent => None,
        };
        if let (Some(value), Profile::Example | Profile::Full) = (given, profile) {
            let value = self.canonical(&field.ty, field.wire_form, value);
            return Some(value).filter(|value| !is_absence(field, value));
        }
        let value = self.value(&field.ty, field, given, profile, open);
        Some(constraint::on_the_wire(value, field.wire_form))
    }

    fn value(
        &self,
        ty: &Type,
        field: &Field,
        given: Option<&Value>,
        profile: Profile,
        open: &mut Vec<String>,
    ) -> Value {
        let bound = match profile {
            Profile::Example | Profile::Full => Bound::None,
            Profile::Minimal => Bound::Least,
            Profile::Maximal => Bound::Most,
        };
        match ty {
            Type::Named(name) if open.contains(name) => Value::Object(Vec::new()),
            Type::Named(name) => self.value_of_named(name, profile, open),
            Type::Array(item) => {
                let first = match given {
                    Some(Value::Array(items)) => items.first(),
                    _ => None,
                };
                let count = if self.is_open(item, open) {
                    0
                } else {
                    constraint::item_count(field, bound)
                };
                let items = (0..count).map(|_| self.value(item, field, first, profile, open));
                Value::Array(items.collect())
            }
            leaf => constraint::leaf(leaf, field, given, bound),
        }
    }

    /// Whether a value of this type would hold a value of a type that is being composed.
    fn is_open(&self, ty: &Type, open: &[String]) -> bool {
        match ty {
            Type::Named(name) => {
                open.contains(name)
                    || self.type_named(name).is_some_and(|ty| match &ty.shape {
                        TypeShape::OneOf(choice) => choice
                            .variants
                            .first()
                            .is_some_and(|variant| open.contains(&variant.ty)),
                        TypeShape::Struct(_) | TypeShape::Enum(_) => false,
                    })
            }
            Type::Array(item) => self.is_open(item, open),
            _ => false,
        }
    }

    /// A given example as an encoder writes it: `1` of a float is `1.0`, an `f32` has its digits.
    fn canonical(&self, ty: &Type, form: WireForm, value: &Value) -> Value {
        match (ty, value) {
            (Type::Float(kind), Value::Number(number)) => {
                constraint::float_value(*kind, constraint::as_float(number))
            }
            (Type::Float(kind), Value::String(text)) => match text.parse() {
                Ok(number) => constraint::on_the_wire(constraint::float_value(*kind, number), form),
                Err(_) => value.clone(),
            },
            (Type::Array(item), Value::Array(items)) => {
                let items = items.iter().map(|value| self.canonical(item, form, value));
                Value::Array(items.collect())
            }
            (Type::Named(name), Value::Object(entries)) => {
                let shape = match self.type_named(name).map(|ty| &ty.shape) {
                    Some(TypeShape::Struct(shape)) => Some(shape),
                    Some(TypeShape::OneOf(choice)) => self.variant_of(choice, value),
                    Some(TypeShape::Enum(_)) | None => None,
                };
                let entries = entries.iter().map(|(key, value)| {
                    let field = shape.and_then(|shape| {
                        let mut fields = shape.fields.iter();
                        fields.find(|field| field.wire == *key)
                    });
                    let value = match field {
                        Some(field) => self.canonical(&field.ty, field.wire_form, value),
                        None => value.clone(),
                    };
                    (key.clone(), value)
                });
                Value::Object(entries.collect())
            }
            _ => value.clone(),
        }
    }
}

/// Whether a value says no more than that an optional field is absent.
fn is_absence(field: &Field, value: &Value) -> bool {
    field.optional && *value == Value::Null
}

/// Name of the struct type of one side of an operation.
pub(crate) fn body_type(operation: &Operation, direction: Direction) -> Option<&str> {
    let body = match direction {
        Direction::Request => &operation.request,
        Direction::Response => &operation.response,
    };
    body.ty.as_deref()
}

/// A scalar of the spec as JSON.
pub(crate) fn scalar(scalar: &Scalar) -> Value {
    match scalar {
        Scalar::Bool(value) => Value::Bool(*value),
        Scalar::Number(number) => Value::Number(number.clone()),
        Scalar::String(text) => Value::String(text.clone()),
    }
}

fn enum_value(shape: &EnumType, profile: Profile) -> Value {
    let value = match profile {
        Profile::Maximal => shape.values.last(),
        Profile::Example | Profile::Full | Profile::Minimal => shape.values.first(),
    };
    value.map_or(Value::Null, |value| scalar(&value.wire))
}
