//! Constants of the spec as typed expressions: the rows of its tables, the bodies of its examples.

use crate::sample::Samples;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_spec::model::{
    EnumType, EnumValue, Field, Number, Scalar, StructRef, StructType, Type, TypeDef, TypeRef,
    TypeShape, Value, Variant,
};

/// A constant, with the types of all that is in it.
#[derive(Clone, Debug)]
pub enum Expr<'m> {
    /// A bool.
    Bool(bool),
    /// An integer of any width, or a timestamp.
    Int(i128),
    /// A float of any width.
    Float(f64),
    /// A text.
    Text(String),
    /// The bytes behind a base64 text.
    Bytes(Vec<u8>),
    /// Any JSON value, as its text.
    Json(String),
    /// A list.
    List(Vec<Expr<'m>>),
    /// A struct.
    Record(Record<'m>),
    /// A value of a one-of: its type, the variant, and the struct that this one holds.
    Choice(&'m TypeDef, &'m Variant, Record<'m>),
    /// A value of an enum that has a name: its type, and the value.
    Value(&'m TypeDef, &'m EnumValue),
    /// A value of an open enum that has none.
    Unlisted(&'m TypeDef, Box<Expr<'m>>),
}

/// A struct with a constant in each of its fields.
#[derive(Clone, Debug)]
pub struct Record<'m> {
    /// Its type.
    pub ty: &'m TypeDef,
    /// What the type is made of.
    pub shape: &'m StructType,
    /// Its fields, in the order of the type; `None` where one is absent.
    pub members: Vec<(&'m Field, Option<Expr<'m>>)>,
}

/// Makes expressions of checked values.
#[derive(Debug)]
pub struct Expressions<'s, 'm> {
    samples: &'s Samples<'m>,
}

impl<'s, 'm> Expressions<'s, 'm> {
    /// For the values of a model.
    #[must_use]
    pub fn new(samples: &'s Samples<'m>) -> Self {
        Self { samples }
    }

    /// A value of a struct, in wire form.
    #[must_use]
    pub fn record(&self, ty: &StructRef, value: &Value) -> Record<'m> {
        let types = &self.samples.model().types;
        self.members(types.get(ty), types.structure(ty), value)
    }

    fn members(&self, ty: &'m TypeDef, shape: &'m StructType, value: &Value) -> Record<'m> {
        let members = shape.fields.iter().map(|field| {
            let held = value.get(&field.wire).filter(|held| **held != Value::Null);
            let made = match held {
                None if field.optional => None,
                held => {
                    let held = held.unwrap_or(&Value::Null);
                    Some(self.value(&field.ty, held))
                }
            };
            (field, made)
        });
        Record {
            ty,
            shape,
            members: members.collect(),
        }
    }

    fn named(&self, ty: &TypeRef, value: &Value) -> Expr<'m> {
        let def = self.samples.model().types.get(ty);
        match &def.shape {
            TypeShape::Struct(shape) => Expr::Record(self.members(def, shape, value)),
            TypeShape::Enum(shape) => match listed(shape, value) {
                Some(known) => Expr::Value(def, known),
                None => Expr::Unlisted(def, Box::new(plain(value))),
            },
            TypeShape::OneOf(choice) => match self.samples.variant_of(choice, value) {
                Some(variant) => Expr::Choice(def, variant, self.record(&variant.ty, value)),
                None => Expr::Json(value.to_string()),
            },
        }
    }

    fn value(&self, ty: &Type, value: &Value) -> Expr<'m> {
        match (ty, value) {
            (Type::Named(named), value) => self.named(named, value),
            (Type::Json, value) => Expr::Json(value.to_string()),
            (Type::Array(item), Value::Array(items)) => {
                let items = items.iter().map(|value| self.value(item, value));
                Expr::List(items.collect())
            }
            (Type::Float(_), Value::Number(Number::Int(value))) =>
            {
                #[expect(clippy::cast_precision_loss, reason = "what a float holds of it")]
                Expr::Float(*value as f64)
            }
            (Type::Base64, Value::String(text)) => {
                Expr::Bytes(STANDARD.decode(text).unwrap_or_default())
            }
            (Type::String, value) => plain(value),
            // Numbers and bools that travel inside JSON strings.
            (Type::Bool, Value::String(text)) => Expr::Bool(text == "true"),
            (Type::Float(_), Value::String(text)) => text.parse().map_or(plain(value), Expr::Float),
            (_, Value::String(text)) => text.parse().map_or(plain(value), Expr::Int),
            (_, value) => plain(value),
        }
    }
}

/// A scalar as what it is.
fn plain<'m>(value: &Value) -> Expr<'m> {
    match value {
        Value::Bool(value) => Expr::Bool(*value),
        Value::Number(Number::Int(value)) => Expr::Int(*value),
        Value::Number(Number::Float(value)) => Expr::Float(*value),
        Value::String(text) => Expr::Text(text.clone()),
        other => Expr::Json(other.to_string()),
    }
}

/// The value of an enum that this is; a number may travel inside a text.
fn listed<'m>(shape: &'m EnumType, value: &Value) -> Option<&'m EnumValue> {
    let same = |wire: &Scalar| match (wire, value) {
        (Scalar::String(wire), Value::String(value)) => wire == value,
        (Scalar::Number(wire), Value::Number(value)) => wire == value,
        (Scalar::Number(Number::Int(wire)), Value::String(value)) => wire.to_string() == *value,
        _ => false,
    };
    shape.values.iter().find(|known| same(&known.wire))
}
