//! Types and fields of JSON bodies.

use super::{
    Available, Change, Condition, Constraints, Deprecation, Location, Scalar, StructRef, Text,
    TypeRef, Value,
};
use crate::names;
use crate::vocabulary::{BodyState, Direction, FloatKind, IntKind, Quirk, StateOrder, WireForm};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

/// The type of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    /// `bool`.
    Bool,
    /// `i8` … `u64`.
    Int(IntKind),
    /// `f32`, `f64`.
    Float(FloatKind),
    /// `string`.
    String,
    /// `timestamp_ms`: signed milliseconds since 1970-01-01T00:00:00Z.
    TimestampMs,
    /// `timestamp_s`: signed seconds since 1970-01-01T00:00:00Z.
    TimestampS,
    /// `base64`: bytes as RFC 4648 text.
    Base64,
    /// `json`: any JSON value, kept as its text.
    Json,
    /// `[T]`.
    Array(Box<Type>),
    /// A struct, enum or one-of.
    Named(TypeRef),
}

impl Type {
    /// Returns the named type inside any nested lists, if there is one.
    #[must_use]
    pub fn innermost(&self) -> Option<&TypeRef> {
        match self {
            Self::Named(named) => Some(named),
            Self::Array(item) => item.innermost(),
            _ => None,
        }
    }

    /// Returns the type of an item inside any nested lists. For other types, returns the type itself.
    #[must_use]
    pub fn item(&self) -> &Self {
        match self {
            Self::Array(item) => item.item(),
            ty => ty,
        }
    }

    /// Returns the same as [`innermost`](Self::innermost), for linking.
    pub(crate) fn innermost_mut(&mut self) -> Option<&mut TypeRef> {
        match self {
            Self::Named(named) => Some(named),
            Self::Array(item) => item.innermost_mut(),
            _ => None,
        }
    }
}

/// A named type.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct TypeDef {
    /// `PascalCase` name.
    #[serde(deserialize_with = "names::read_pascal")]
    pub name: String,
    /// Group whose file (and Rust module) contains it; `null` for `spec/types.yaml`.
    pub group: Option<String>,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Longer description.
    pub about: Option<Text>,
    /// Struct, enum or one-of.
    #[serde(flatten)]
    pub shape: TypeShape,
    /// Body that the type was made for, or inline object of a body. `null` for a type of a `types:` section.
    pub body_of: Option<BodyField>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// History.
    pub changes: Vec<Change>,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

/// A body, or an inline object in it, for which a type was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BodyField {
    /// Operation.
    pub operation: String,
    /// Direction of the message with this body.
    pub side: Direction,
    /// Path of wire keys of an inline object (`["data"]`); empty for the body itself.
    #[serde(deserialize_with = "names::read_line")]
    pub path: Vec<String>,
}

/// Shape of a named type.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum TypeShape {
    /// An object with known keys.
    Struct(StructType),
    /// A choice of named values.
    Enum(EnumType),
    /// A choice of structs told apart by which keys are present.
    OneOf(OneOf),
}

impl TypeShape {
    /// Returns the struct, if it is one.
    #[must_use]
    pub fn structure(&self) -> Option<&StructType> {
        match self {
            Self::Struct(shape) => Some(shape),
            Self::Enum(_) | Self::OneOf(_) => None,
        }
    }

    /// Returns the enum, if it is one.
    #[must_use]
    pub fn enumeration(&self) -> Option<&EnumType> {
        match self {
            Self::Enum(shape) => Some(shape),
            Self::Struct(_) | Self::OneOf(_) => None,
        }
    }

    /// Returns the one-of, if it is one.
    #[must_use]
    pub fn choice(&self) -> Option<&OneOf> {
        match self {
            Self::OneOf(choice) => Some(choice),
            Self::Struct(_) | Self::Enum(_) => None,
        }
    }
}

/// An object with known keys; unknown keys are kept.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct StructType {
    /// Fields in the order written, which is the order sent.
    pub fields: Vec<Field>,
    /// `open` for a lost body. It has no fields, and every key is kept as JSON.
    pub state: BodyState,
    /// Name of the coordinate system of its values; `null` if none is stated.
    pub coordinates: Option<String>,
}

impl StructType {
    /// Returns a struct without fields.
    pub(crate) fn new(state: BodyState, coordinates: Option<String>) -> Self {
        Self {
            fields: Vec::new(),
            state,
            coordinates,
        }
    }
}

impl StructType {
    /// Returns the field with this wire key.
    #[must_use]
    pub fn field(&self, wire: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.wire == wire)
    }
}

/// A field of a struct.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Field {
    /// Key on the wire, exact.
    #[serde(deserialize_with = "names::read_line")]
    #[serde(rename = "path")]
    pub wire: String,
    /// `snake_case` name in code.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Type without the optional mark.
    #[serde(rename = "type")]
    pub ty: Type,
    /// `true` if the field may be absent (`T?`).
    pub optional: bool,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
    /// Value in generated examples.
    #[serde(flatten)]
    pub example: Example,
    /// Form in which it is sent.
    pub wire_form: WireForm,
    /// `true` if it must not appear in logs.
    pub sensitive: bool,
    /// Rare properties, kept apart to save memory.
    #[serde(flatten, serialize_with = "details")]
    pub details: Option<Box<FieldDetails>>,
}

impl Field {
    /// Returns the details of the field, or empty details if it has none.
    #[must_use]
    pub fn details(&self) -> &FieldDetails {
        self.details.as_deref().unwrap_or(&NO_DETAILS)
    }
}

/// Rare properties of a field.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldDetails {
    /// Additional notes, such as special values and origin.
    pub note: Option<Text>,
    /// Name of the entity that its value identifies, or each value of its list.
    pub refers: Option<String>,
    /// Condition under which an optional field is present and a required field is valid; `null` for no condition.
    pub condition: Option<Condition>,
    /// Name of the coordinate system of its object, or of each object in its list.
    /// For an inline object, and for a declared struct that names one, the struct has the name instead.
    pub coordinates: Option<String>,
    /// Name of the store in which its value is kept; `null` if none is stated.
    pub kept: Option<String>,
    /// Unit, such as `m`, `rad`, `ms`.
    pub unit: Option<String>,
    /// Constraints on values.
    #[serde(flatten)]
    pub constraints: Constraints,
    /// Value that the receiver uses if the optional field is absent. It is documented and not sent.
    pub default: Option<Scalar>,
    /// Leniencies of the decoder.
    pub quirks: Vec<Quirk>,
    /// Other wire keys the decoder accepts for it.
    #[serde(deserialize_with = "names::read_line")]
    pub also: Vec<String>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// Audiences, machines and releases that have it; `null` for all.
    pub available: Option<Available>,
    /// Its deprecation; `null` if it is not deprecated.
    pub deprecated: Option<Deprecation>,
}

impl FieldDetails {
    /// Returns empty details.
    #[must_use]
    pub fn none() -> &'static Self {
        &NO_DETAILS
    }
}

/// Serializes all keys of the details, also for a field without details.
#[expect(clippy::ref_option, reason = "serde hands it over so")]
fn details<S: Serializer>(
    details: &Option<Box<FieldDetails>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    (details.as_deref().unwrap_or(&NO_DETAILS)).serialize(serializer)
}

static NO_DETAILS: FieldDetails = FieldDetails {
    note: None,
    refers: None,
    condition: None,
    coordinates: None,
    kept: None,
    unit: None,
    constraints: Constraints::NONE,
    default: None,
    quirks: Vec::new(),
    also: Vec::new(),
    since: None,
    available: None,
    deprecated: None,
};

/// Value of a field in generated examples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "example_is", content = "example", rename_all = "snake_case")]
pub enum Example {
    /// Given in the spec, in wire form.
    Given(Value),
    /// Composed from the type: enums show the first value that the field takes, structs their fields, arrays one item,
    /// bools true, timestamps and base64 a fixed value.
    Derived,
    /// An optional field that examples leave out.
    Absent,
}

/// A choice of named values.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EnumType {
    /// Wire type of the values.
    pub repr: EnumRepr,
    /// `true` if an unknown value is an error. Otherwise, it is kept.
    pub closed: bool,
    /// Meaning of `then` of the values; `null` if their order is not stated.
    pub order: Option<StateOrder>,
    /// Values in the order written.
    pub values: Vec<EnumValue>,
}

/// The wire type of enum values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnumRepr {
    /// An integer.
    Int(IntKind),
    /// A string.
    String,
}

/// A value of an enum.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EnumValue {
    /// Value on the wire: an integer or a string.
    #[serde(rename = "value")]
    pub wire: Scalar,
    /// `snake_case` name.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Its meaning.
    #[serde(flatten)]
    pub text: Text,
    /// `true` if a process begins with it.
    pub start: bool,
    /// Names of the values that can follow it. The `order` of the enum gives the meaning of the list.
    pub then: Vec<String>,
    /// `true` if no value follows it.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// `true` if it means that something failed.
    #[serde(rename = "error")]
    pub is_error: bool,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// Audiences, machines and releases that have it; `null` for all.
    pub available: Option<Available>,
}

/// A choice of structs. The first variant whose required keys are all present is taken, in the order written.
/// A checked model has no variant that an earlier one always hides.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct OneOf {
    /// Variants in the order written.
    pub variants: Vec<Variant>,
}

/// A variant of a one-of.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Variant {
    /// `snake_case` name.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Its meaning.
    #[serde(flatten)]
    pub text: Text,
    /// Its struct.
    #[serde(rename = "type")]
    pub ty: StructRef,
    /// Audiences, machines and releases that have it; `null` for all.
    pub available: Option<Available>,
    /// Its deprecation; `null` if it is not deprecated.
    pub deprecated: Option<Deprecation>,
}
