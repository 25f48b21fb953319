//! Types and fields of JSON bodies.

use super::{
    Available, Change, Condition, Deprecation, Location, Number, Pattern, Scalar, StructRef, Text,
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
    /// Group whose file (and Rust module) holds it; `None` for `spec/types.yaml`.
    pub group: Option<String>,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// More about it.
    pub about: Option<Text>,
    /// Struct, enum or one-of.
    #[serde(flatten)]
    pub shape: TypeShape,
    /// Operation and side whose body, or inline object in whose body, this is; `None` for a type
    /// of a `types:` section.
    pub body_of: Option<BodyField>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// History.
    pub changes: Vec<Change>,
    /// Where it stands.
    #[serde(rename = "place")]
    pub location: Location,
}

/// Which body a made type belongs to, and where in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BodyField {
    /// Operation.
    pub operation: String,
    /// Which of its two bodies.
    pub side: Direction,
    /// Path of wire keys of an inline object (`["data"]`); empty for the body itself.
    #[serde(deserialize_with = "names::read_line")]
    pub path: Vec<String>,
}

/// What a named type is made of.
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

/// An object with known keys; unknown keys are kept.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct StructType {
    /// Fields in the order written, which is the order sent.
    pub fields: Vec<Field>,
    /// `Open` for a lost body: no fields, every key kept as JSON.
    pub state: BodyState,
    /// Name of the coordinate system in which its values are given.
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
    /// `T?`: may be absent.
    pub optional: bool,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
    /// What composed examples show for it.
    #[serde(flatten)]
    pub example: Example,
    /// How it travels.
    pub wire_form: WireForm,
    /// Never in logs.
    pub sensitive: bool,
    /// What few fields have; a spec has more fields than anything else.
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

/// What a field says about itself beyond the usual.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldDetails {
    /// More about it: meaning of odd values, where it comes from.
    pub note: Option<Text>,
    /// Name of the entity of which its value is the id, or each value of its list.
    pub refers: Option<String>,
    /// Under which values of the fields beside it an optional field is there, and a required one is valid; `None`: under
    /// all.
    pub condition: Option<Condition>,
    /// Name of the coordinate system in which its object, or each object of its list, is given. That of an object in
    /// place, and one that a declared struct names itself, is with the struct.
    pub coordinates: Option<String>,
    /// Name of the store in which it is kept.
    pub kept: Option<String>,
    /// Unit, such as `m`, `rad`, `ms`.
    pub unit: Option<String>,
    /// Smallest value of a number.
    pub min: Option<Number>,
    /// Largest value of a number.
    pub max: Option<Number>,
    /// Fewest and most characters of a string, bytes of a base64, items of an array.
    pub length: Option<(u64, u64)>,
    /// Regular expression that a string must match as a whole.
    pub pattern: Option<Pattern>,
    /// Values of its enum that it takes, in wire form; all where there are none.
    pub only: Vec<Scalar>,
    /// What the receiver takes for an absent optional field; documented, not sent.
    pub default: Option<Scalar>,
    /// Where the decoder is lenient.
    pub quirks: Vec<Quirk>,
    /// Other wire keys the decoder accepts for it.
    #[serde(deserialize_with = "names::read_line")]
    pub also: Vec<String>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// For whom it is, and where; `None` for everyone.
    pub available: Option<Available>,
    /// Withdrawn.
    pub deprecated: Option<Deprecation>,
}

impl FieldDetails {
    /// Returns the constraints on values, in the order of their checks.
    pub fn constraints(&self) -> impl Iterator<Item = Constraint<'_>> {
        let min = self.min.as_ref().map(Constraint::Min);
        let max = self.max.as_ref().map(Constraint::Max);
        let length = self.length;
        let length = length.map(|(least, most)| Constraint::Length(least, most));
        let pattern = self.pattern.as_ref().map(Constraint::Pattern);
        let only = (!self.only.is_empty()).then_some(Constraint::Only(&self.only));
        [min, max, length, pattern, only].into_iter().flatten()
    }

    /// Returns empty details.
    #[must_use]
    pub fn none() -> &'static Self {
        &NO_DETAILS
    }
}

/// A constraint on the values of a field, in addition to its type. An absent value meets every constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint<'f> {
    /// The smallest value of a number.
    Min(&'f Number),
    /// The largest value of a number.
    Max(&'f Number),
    /// Fewest and most characters of a string, bytes of a base64, items of an array.
    Length(u64, u64),
    /// A regular expression that a string must match as a whole.
    Pattern(&'f Pattern),
    /// The accepted values of an enum, in wire form. Every other value is refused, including values that the enum does not declare.
    Only(&'f [Scalar]),
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
    min: None,
    max: None,
    length: None,
    pattern: None,
    only: Vec::new(),
    default: None,
    quirks: Vec::new(),
    also: Vec::new(),
    since: None,
    available: None,
    deprecated: None,
};

/// What composed examples show for a field.
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
    /// What travels.
    pub repr: EnumRepr,
    /// `closed: true`: an unknown value is a fault. Otherwise it is kept.
    pub closed: bool,
    /// What `then` of the values claims; `None` where nothing is said of how they follow each other.
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
    /// On the wire: `Scalar::Number(Number::Int)` or `Scalar::String`.
    #[serde(rename = "value")]
    pub wire: Scalar,
    /// `snake_case` name.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// What it means.
    #[serde(flatten)]
    pub text: Text,
    /// Whether a process begins with it.
    pub start: bool,
    /// Names of the values that follow it, as the enum's `order` says.
    pub then: Vec<String>,
    /// Whether nothing follows it.
    #[serde(rename = "final")]
    pub is_final: bool,
    /// Whether it says that something failed.
    #[serde(rename = "error")]
    pub is_error: bool,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// For whom it is, and where; `None` for everyone.
    pub available: Option<Available>,
}

/// A choice of structs. A variant is taken when all its required keys are present, in the order
/// written; a checked model has no variant that an earlier one always hides.
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
    /// What it means.
    #[serde(flatten)]
    pub text: Text,
    /// Its struct.
    #[serde(rename = "type")]
    pub ty: StructRef,
    /// For whom it is, and where; `None` for everyone.
    pub available: Option<Available>,
    /// Withdrawn.
    pub deprecated: Option<Deprecation>,
}
