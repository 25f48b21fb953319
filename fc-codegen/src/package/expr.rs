//! Constants of the spec as typed expressions: table rows and example bodies.

use super::items::{Item, Package, Shape, Spelled};
use crate::sample::Samples;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_spec::model::{
    EnumValue, Field, Number, Scalar, StructRef, Table, Type, TypeRef, Value, Variant,
};

/// A constant, in which every part has its type in the package.
#[derive(Clone, Debug)]
pub enum Expr<'p> {
    /// A bool.
    Bool(bool),
    /// An integer of any width, or a timestamp.
    Int(i128),
    /// A float of any width.
    Float(f64),
    /// A string.
    Text(String),
    /// The bytes that a base64 string encodes.
    Bytes(Vec<u8>),
    /// Any JSON value, as JSON text.
    Json(String),
    /// An id of an entity that has an id type: the name of the type, and the value.
    Id(&'p str, Box<Expr<'p>>),
    /// A list.
    List(Vec<Expr<'p>>),
    /// A struct.
    Record(Record<'p>),
    /// A value of a one-of: its type, the variant, and the variant's struct.
    Choice(&'p Item<'p>, &'p Spelled<'p, Variant>, Record<'p>),
    /// A named value of an enum: its type, and the value.
    Value(&'p Item<'p>, &'p Spelled<'p, EnumValue>),
    /// A value of an open enum that has no name.
    Unlisted(&'p Item<'p>, Box<Expr<'p>>),
}

/// A struct with a constant in each of its fields.
#[derive(Clone, Debug)]
pub struct Record<'p> {
    /// The type of the struct.
    pub item: &'p Item<'p>,
    /// The fields, in the order of the type; `None` for an absent field.
    pub members: Vec<(&'p Spelled<'p, Field>, Option<Expr<'p>>)>,
}

impl<'m> Package<'m> {
    /// Returns a struct value, given in wire form.
    #[must_use]
    pub fn record(&self, ty: &StructRef, value: &Value) -> Record<'_> {
        self.members(self.item(ty), value)
    }

    /// Returns the rows of a table as a list.
    #[must_use]
    pub fn rows(&self, table: &Table) -> Expr<'_> {
        let rows = table.rows.iter();
        let rows = rows.map(|row| Expr::Record(self.record(&table.row, row)));
        Expr::List(rows.collect())
    }

    fn members<'p>(&'p self, item: &'p Item<'m>, value: &Value) -> Record<'p> {
        let members = item.fields().iter().map(|field| {
            let held = value.get(&field.wire).filter(|held| **held != Value::Null);
            let made = match held {
                None if field.optional => None,
                held => {
                    let held = held.unwrap_or(&Value::Null);
                    Some(self.held(field, held))
                }
            };
            (field, made)
        });
        Record {
            members: members.collect(),
            item,
        }
    }

    /// Returns the value of a field, given in wire form.
    #[must_use]
    pub fn held(&self, field: &Field, value: &Value) -> Expr<'_> {
        let expr = self.value(&field.ty, value);
        match self.id_of(field) {
            Some(id) => expr.into_ids(&id.name),
            None => expr,
        }
    }

    fn named(&self, ty: &TypeRef, value: &Value) -> Expr<'_> {
        let item = self.item(ty);
        match &item.shape {
            Shape::Record(..) => Expr::Record(self.members(item, value)),
            Shape::Enum(_, values) => match values.iter().find(|it| is_it(it, value)) {
                Some(known) => Expr::Value(item, known),
                None => Expr::Unlisted(item, Box::new(plain(value))),
            },
            Shape::Choice(choice, variants) => {
                let samples = Samples::new(self.model);
                let taken = samples.variant_of(choice, value);
                let is_taken =
                    |it: &&Spelled<'_, Variant>| taken.is_some_and(|of| of.name == it.of.name);
                match variants.iter().find(is_taken) {
                    Some(variant) => Expr::Choice(item, variant, self.record(&variant.ty, value)),
                    None => Expr::Json(value.to_string()),
                }
            }
        }
    }

    /// Returns a value of a type, given in wire form.
    #[must_use]
    pub fn value(&self, ty: &Type, value: &Value) -> Expr<'_> {
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
            // Numbers and bools may travel inside JSON strings. Bools may also travel as numbers.
            (Type::Bool, Value::String(text)) => Expr::Bool(text == "true"),
            (Type::Bool, Value::Number(number)) => Expr::Bool(*number == Number::Int(1)),
            (Type::Float(_), Value::String(text)) => text.parse().map_or(plain(value), Expr::Float),
            (_, Value::String(text)) => text.parse().map_or(plain(value), Expr::Int),
            (_, value) => plain(value),
        }
    }
}

impl<'p> Expr<'p> {
    /// Wraps a scalar, or each item of a list, as an id of type `ty`.
    fn into_ids(self, ty: &'p str) -> Self {
        match self {
            Self::List(items) => Self::List(items.into_iter().map(|it| it.into_ids(ty)).collect()),
            scalar => Self::Id(ty, Box::new(scalar)),
        }
    }
}

/// Returns a value as the expression that matches its JSON type.
fn plain<'p>(value: &Value) -> Expr<'p> {
    match value {
        Value::Bool(value) => Expr::Bool(*value),
        Value::Number(Number::Int(value)) => Expr::Int(*value),
        Value::Number(Number::Float(value)) => Expr::Float(*value),
        Value::String(text) => Expr::Text(text.clone()),
        other => Expr::Json(other.to_string()),
    }
}

/// Returns `true` if `value` is this enum value. A number may travel inside a string.
fn is_it(known: &EnumValue, value: &Value) -> bool {
    match (&known.wire, value) {
        (Scalar::String(wire), Value::String(value)) => wire == value,
        (Scalar::Number(wire), Value::Number(value)) => wire == value,
        (Scalar::Number(Number::Int(wire)), Value::String(value)) => wire.to_string() == *value,
        _ => false,
    }
}
