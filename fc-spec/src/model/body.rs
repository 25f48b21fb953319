//! Types and fields of JSON bodies.

use super::{BodyState, Change, Deprecation, Location, Text, Value};

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
    /// A struct, enum or one-of in `Model::types`.
    Named(String),
}

/// Integers, named as in Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum IntKind {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

impl IntKind {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::I8,
        Self::I16,
        Self::I32,
        Self::I64,
        Self::U8,
        Self::U16,
        Self::U32,
        Self::U64,
    ];

    /// Its name in the spec and in Rust.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::I8 => "i8",
            Self::I16 => "i16",
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::U8 => "u8",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::U64 => "u64",
        }
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(self) -> (i128, i128) {
        match self {
            Self::I8 => (i8::MIN.into(), i8::MAX.into()),
            Self::I16 => (i16::MIN.into(), i16::MAX.into()),
            Self::I32 => (i32::MIN.into(), i32::MAX.into()),
            Self::I64 => (i64::MIN.into(), i64::MAX.into()),
            Self::U8 => (0, u8::MAX.into()),
            Self::U16 => (0, u16::MAX.into()),
            Self::U32 => (0, u32::MAX.into()),
            Self::U64 => (0, u64::MAX.into()),
        }
    }
}

/// Floating-point numbers, named as in Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum FloatKind {
    F32,
    F64,
}

/// A number as the spec writes it, exact.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// An integer.
    Int(i128),
    /// A decimal fraction.
    Float(f64),
}

/// A scalar of the spec.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// `true`, `false`.
    Bool(bool),
    /// A number.
    Number(Number),
    /// A text.
    String(String),
}

/// How a value travels where that differs from its type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WireForm {
    /// As its type says.
    #[default]
    Plain,
    /// `wire: string`: a number or bool inside a JSON string (`"0.5"`, `"true"`).
    String,
}

/// Where a decoder is lenient. The encoder is not: it sends the canonical form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quirk {
    /// `empty_is_absent`: null, `{}`, `[]` and `""` are read as an absent optional field.
    EmptyIsAbsent,
    /// `lenient_number`: a number is read from a JSON number, a decimal string or a `0x` string.
    LenientNumber,
    /// `lenient_bool`: a bool is read from true/false, "true"/"false", 0/1.
    LenientBool,
}

/// A named type.
#[derive(Clone, Debug)]
pub struct TypeDef {
    /// `PascalCase` name.
    pub name: String,
    /// Group whose file (and Rust module) holds it; `None` for `spec/types.yaml`.
    pub group: Option<String>,
    /// Title.
    pub title: Text,
    /// More about it.
    pub about: Option<Text>,
    /// Struct, enum or one-of.
    pub shape: TypeShape,
    /// Operation and side whose body, or inline object in whose body, this is; `None` for a type
    /// of a `types:` section.
    pub body_of: Option<BodyField>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    pub since: Option<String>,
    /// History.
    pub changes: Vec<Change>,
    /// Where it stands.
    pub location: Location,
}

/// Which body a made type belongs to, and where in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyField {
    /// Operation.
    pub operation: String,
    /// `true` for the request.
    pub request: bool,
    /// Path of wire keys of an inline object (`["data"]`); empty for the body itself.
    pub path: Vec<String>,
}

/// What a named type is made of.
#[derive(Clone, Debug)]
pub enum TypeShape {
    /// An object with known keys.
    Struct(StructType),
    /// A choice of named values.
    Enum(EnumType),
    /// A choice of structs told apart by which keys are present.
    OneOf(OneOf),
}

/// An object with known keys; unknown keys are kept.
#[derive(Clone, Debug)]
pub struct StructType {
    /// Fields in the order written, which is the order sent.
    pub fields: Vec<Field>,
    /// `Open` for a lost body: no fields, every key kept as JSON.
    pub state: BodyState,
}

/// A field of a struct.
#[derive(Clone, Debug)]
pub struct Field {
    /// Key on the wire, exact.
    pub wire: String,
    /// `snake_case` name in code.
    pub name: String,
    /// Type without the optional mark.
    pub ty: Type,
    /// `T?`: may be absent.
    pub optional: bool,
    /// Description.
    pub text: Text,
    /// What composed examples show for it.
    pub example: Example,
    /// How it travels.
    pub wire_form: WireForm,
    /// Never in logs.
    pub sensitive: bool,
    /// What few fields have; a spec has more fields than anything else.
    pub details: Option<Box<FieldDetails>>,
}

impl Field {
    /// What few fields have; nothing of it where this one does not.
    #[must_use]
    pub fn details(&self) -> &FieldDetails {
        self.details.as_deref().unwrap_or(&NO_DETAILS)
    }
}

/// What a field says about itself beyond the usual.
#[derive(Clone, Debug)]
pub struct FieldDetails {
    /// More about it: meaning of odd values, where it comes from.
    pub note: Option<Text>,
    /// Unit, such as `m`, `rad`, `ms`.
    pub unit: Option<String>,
    /// Smallest value of a number.
    pub min: Option<Number>,
    /// Largest value of a number.
    pub max: Option<Number>,
    /// Fewest and most characters of a string, bytes of a base64, items of an array.
    pub length: Option<(u64, u64)>,
    /// Regular expression that a string must match as a whole.
    pub pattern: Option<String>,
    /// What the receiver takes for an absent optional field; documented, not sent.
    pub default: Option<Scalar>,
    /// Where the decoder is lenient.
    pub quirks: Vec<Quirk>,
    /// Other wire keys the decoder accepts for it.
    pub also: Vec<String>,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    pub since: Option<String>,
    /// Withdrawn.
    pub deprecated: Option<Deprecation>,
}

static NO_DETAILS: FieldDetails = FieldDetails {
    note: None,
    unit: None,
    min: None,
    max: None,
    length: None,
    pattern: None,
    default: None,
    quirks: Vec::new(),
    also: Vec::new(),
    since: None,
    deprecated: None,
};

/// What composed examples show for a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Example {
    /// Given in the spec, in wire form.
    Given(Value),
    /// Composed from the type: enums show their first value, structs their fields, arrays one item,
    /// bools true, timestamps and base64 a fixed value.
    Derived,
    /// An optional field that examples leave out.
    Absent,
}

/// A choice of named values.
#[derive(Clone, Debug)]
pub struct EnumType {
    /// What travels.
    pub repr: EnumRepr,
    /// `closed: true`: an unknown value is a fault. Otherwise it is kept.
    pub closed: bool,
    /// Values in the order written.
    pub values: Vec<EnumValue>,
}

/// What an enum value is on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnumRepr {
    /// An integer.
    Int(IntKind),
    /// A string.
    String,
}

/// A value of an enum.
#[derive(Clone, Debug)]
pub struct EnumValue {
    /// On the wire: `Scalar::Number(Number::Int)` or `Scalar::String`.
    pub wire: Scalar,
    /// `snake_case` name.
    pub name: String,
    /// What it means.
    pub text: Text,
    /// `YYYY-MM` or `YYYY-MM-DD`.
    pub since: Option<String>,
}

/// A choice of structs. A variant is taken when all its required keys are present, in the order
/// written; a checked model has no variant that an earlier one always hides.
#[derive(Clone, Debug)]
pub struct OneOf {
    /// Variants in the order written.
    pub variants: Vec<Variant>,
}

/// A variant of a one-of.
#[derive(Clone, Debug)]
pub struct Variant {
    /// `snake_case` name.
    pub name: String,
    /// What it means.
    pub text: Text,
    /// Name of its struct type.
    pub ty: String,
}
