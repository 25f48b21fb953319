//! Composes JSON values from types and the examples of their fields.

use super::STREAM_BYTES;
use super::constraint::{self, Bound};
use fc_spec::model::{
    Direction, EnvelopeField, EnvelopeRole, Example, Field, Kind, Model, Number, OneOf, Operation,
    ResultCode, ResultRole, StructType, Type, TypeDef, TypeRef, TypeShape, Value, Variant,
    WireForm,
};

/// The choice of fields and values in a composed message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Profile {
    /// The examples of the spec.
    Example,
    /// As `Example`, with every optional field. Every profile leaves out a field whose condition does not hold.
    Full,
    /// Required fields, and fields whose condition holds. Numbers, strings and arrays are at the lower end of their
    /// constraints. A value without a lower bound keeps its example.
    Minimal,
    /// All fields, arrays of two items, and the largest numbers and longest strings.
    Maximal,
}

impl Profile {
    /// Returns the end of constraints that the values are at.
    fn bound(self) -> Bound {
        match self {
            Self::Example | Self::Full => Bound::None,
            Self::Minimal => Bound::Least,
            Self::Maximal => Bound::Most,
        }
    }
}

/// Composes messages from the examples of a model.
#[derive(Clone, Debug)]
pub struct Samples<'m> {
    model: &'m Model,
}

impl<'m> Samples<'m> {
    /// Uses the examples of a model.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        Self { model }
    }

    /// Returns the model.
    #[must_use]
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// Returns a value of a named type.
    #[must_use]
    pub fn named(&self, ty: &TypeDef, profile: Profile) -> Value {
        self.value_of_named(ty, profile, &mut Vec::new())
    }

    /// Returns a value of a field and ignores its condition.
    #[must_use]
    pub fn value_of(&self, field: &Field) -> Value {
        let value = self.field(field, Profile::Full, &mut Vec::new());
        value.unwrap_or(Value::Null)
    }

    /// Returns the body of one side of an operation, without the envelope. Returns an empty object for raw bytes.
    #[must_use]
    pub fn body(&self, operation: &Operation, direction: Direction, profile: Profile) -> Value {
        match operation.body(direction) {
            Some(body) => self.named(self.model.types.get(&body.ty), profile),
            None => Value::Object(Vec::new()),
        }
    }

    /// Returns a whole message: the envelope, then the body. A stream has no envelope.
    #[must_use]
    pub fn message(&self, operation: &Operation, direction: Direction, profile: Profile) -> Value {
        let body = self.body(operation, direction, profile);
        if operation.kind() == Kind::Stream {
            return body;
        }
        let mut message = self.enveloped(direction, body, profile);
        if let Some(text) = &operation.result_text {
            let text = Value::String(text.clone());
            self.tell(&mut message, direction, EnvelopeRole::ResultText, &text);
        }
        message
    }

    /// Returns a whole response with this result. Only a success of a known operation has a body.
    #[must_use]
    pub fn response(&self, operation: Option<&Operation>, result: &ResultCode) -> Value {
        let direction = Direction::Response;
        let own = operation.filter(|_| result.role == Some(ResultRole::Success));
        let mut message = match own {
            Some(operation) => self.message(operation, direction, Profile::Example),
            None => self.enveloped(direction, Value::Object(Vec::new()), Profile::Example),
        };
        let code = Value::Number(Number::Int(result.code.into()));
        self.tell(&mut message, direction, EnvelopeRole::ResultCode, &code);
        if own.is_none_or(|operation| operation.result_text.is_none()) {
            let text = Value::String(result.text.zh.clone());
            self.tell(&mut message, direction, EnvelopeRole::ResultText, &text);
        }
        message
    }

    /// Returns the data of a frame with the example: the text of the message, or the bytes of a stream.
    #[must_use]
    pub fn data(&self, operation: &Operation, direction: Direction) -> Vec<u8> {
        if operation.body(direction).is_none() {
            return STREAM_BYTES.to_vec();
        }
        let message = self.message(operation, direction, Profile::Example);
        message.to_string().into_bytes()
    }

    /// Sets the envelope keys with this role.
    fn tell(&self, message: &mut Value, direction: Direction, role: EnvelopeRole, value: &Value) {
        let fields = self.envelope(direction).iter();
        for field in fields.filter(|field| field.role == role) {
            if let Some(there) = message.get_mut(&field.wire) {
                there.clone_from(value);
            }
        }
    }

    /// Returns the body with the envelope before it.
    #[must_use]
    pub fn enveloped(&self, direction: Direction, body: Value, profile: Profile) -> Value {
        let fields = self.envelope(direction).iter();
        let fields = fields.filter(|field| !(field.optional && profile == Profile::Minimal));
        let mut entries: Vec<(String, Value)> = fields
            .map(|field| (field.wire.clone(), Value::from(&field.example)))
            .collect();
        if let Value::Object(own) = body {
            entries.extend(own);
        }
        Value::Object(entries)
    }

    /// Returns the envelope keys of this direction.
    #[must_use]
    pub fn envelope(&self, direction: Direction) -> &'m [EnvelopeField] {
        match direction {
            Direction::Request => &self.model.envelope.request,
            Direction::Response => &self.model.envelope.response,
        }
    }

    /// Returns the variant of a received object: the first whose required keys are all there.
    #[must_use]
    pub fn variant_of<'c>(&self, choice: &'c OneOf, value: &Value) -> Option<&'c Variant> {
        choice.variants.iter().find(|variant| {
            let fields = &self.model.types.structure(&variant.ty).fields;
            let mut required = fields.iter().filter(|field| !field.optional);
            required.all(|field| value.get(&field.wire).is_some())
        })
    }

    fn value_of_named(&self, ty: &TypeDef, profile: Profile, open: &mut Vec<String>) -> Value {
        match &ty.shape {
            TypeShape::Struct(shape) => {
                open.push(ty.name.clone());
                let value = self.object(shape, profile, open);
                open.pop();
                value
            }
            TypeShape::Enum(shape) => constraint::enum_value(shape, &[], profile.bound()),
            TypeShape::OneOf(choice) => match choice.variants.first() {
                Some(variant) => {
                    self.value_of_named(self.model.types.get(&variant.ty), profile, open)
                }
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
        without_unasked(shape, Value::Object(entries))
    }

    /// Returns `None` if the profile leaves the field out.
    fn field(&self, field: &Field, profile: Profile, open: &mut Vec<String>) -> Option<Value> {
        if field.optional {
            let left_out = match profile {
                Profile::Example => field.example == Example::Absent,
                Profile::Full | Profile::Maximal => self.is_open(&field.ty, open),
                // A field whose condition holds counts as required.
                Profile::Minimal => {
                    field.details().condition.is_none() || self.is_open(&field.ty, open)
                }
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
        let bound = profile.bound();
        match ty {
            Type::Named(named) if is_in(open, named) => Value::Object(Vec::new()),
            Type::Named(named) => {
                let ty = self.model.types.get(named);
                match &ty.shape {
                    TypeShape::Enum(shape) => {
                        constraint::enum_value(shape, &field.details().constraints.only, bound)
                    }
                    TypeShape::Struct(_) | TypeShape::OneOf(_) => {
                        self.value_of_named(ty, profile, open)
                    }
                }
            }
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

    /// Returns `true` if a value of this type would contain a type that is being composed.
    fn is_open(&self, ty: &Type, open: &[String]) -> bool {
        match ty {
            Type::Named(named) => {
                let choice = self.model.types.get(named).shape.choice();
                let first = choice.and_then(|choice| choice.variants.first());
                is_in(open, named) || first.is_some_and(|variant| is_in(open, &variant.ty))
            }
            Type::Array(item) => self.is_open(item, open),
            _ => false,
        }
    }

    /// Returns an example in the form that an encoder writes: `1` as a float is `1.0`, and an `f32` has its shortest
    /// digits.
    fn canonical(&self, ty: &Type, form: WireForm, value: &Value) -> Value {
        match (ty, value) {
            (Type::Float(kind), Value::Number(number)) => {
                constraint::float_value(*kind, number.to_f64())
            }
            (Type::Float(kind), Value::String(text)) => match text.parse() {
                Ok(number) => constraint::on_the_wire(constraint::float_value(*kind, number), form),
                Err(_) => value.clone(),
            },
            (Type::Array(item), Value::Array(items)) => {
                let items = items.iter().map(|value| self.canonical(item, form, value));
                Value::Array(items.collect())
            }
            (Type::Named(named), Value::Object(entries)) => {
                let shape = match &self.model.types.get(named).shape {
                    TypeShape::Struct(shape) => Some(shape),
                    TypeShape::OneOf(choice) => self
                        .variant_of(choice, value)
                        .map(|variant| self.model.types.structure(&variant.ty)),
                    TypeShape::Enum(_) => None,
                };
                let entries = entries.iter().map(|(key, value)| {
                    let value = match shape.and_then(|shape| shape.field(key)) {
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

/// Returns an object without the optional fields whose condition does not hold in it.
fn without_unasked(shape: &StructType, object: Value) -> Value {
    let is_unasked = |field: &&Field| {
        let condition = field.details().condition.as_ref();
        field.optional && condition.is_some_and(|condition| !condition.holds(&object))
    };
    let unasked = shape.fields.iter().filter(is_unasked);
    let unasked: Vec<&str> = unasked.map(|field| field.wire.as_str()).collect();
    match object {
        Value::Object(mut entries) => {
            entries.retain(|(key, _)| !unasked.contains(&key.as_str()));
            Value::Object(entries)
        }
        other => other,
    }
}

/// Returns `true` if the value only means that an optional field is absent.
fn is_absence(field: &Field, value: &Value) -> bool {
    field.optional && *value == Value::Null
}

/// Returns `true` if the type is being composed.
fn is_in(open: &[String], ty: &TypeRef) -> bool {
    open.iter().any(|name| name == ty.name())
}
