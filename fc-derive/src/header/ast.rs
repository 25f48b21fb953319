//! A header with its attributes.

use crate::attr::{self, Item, Slot};
use crate::errors::Errors;
use crate::item;
use syn::parse::ParseStream;
use syn::{DeriveInput, Fields, Ident, LitInt, LitStr, Path, Type, TypeArray};

/// A struct with `#[derive(Header)]`.
pub struct Header<'a> {
    /// Its name.
    pub ident: &'a Ident,
    /// Path of the runtime crate.
    pub runtime: Path,
    /// `byte_order`.
    pub byte_order: ByteOrder,
    /// Fields in the order in which they are sent.
    pub fields: Vec<Field<'a>>,
}

/// The byte order of integers.
#[derive(Clone, Copy)]
pub enum ByteOrder {
    /// Most significant byte first.
    Big,
    /// Least significant byte first.
    Little,
}

/// A field of a header.
pub struct Field<'a> {
    /// Its name.
    pub ident: &'a Ident,
    /// Its type.
    pub ty: &'a Type,
    /// Width and kind, or `None` if the type is invalid.
    pub shape: Option<Shape>,
    /// Offset in bytes.
    pub offset: usize,
    /// `role`.
    pub role: Slot<(LitStr, Role)>,
    /// `value`.
    pub value: Slot<LitInt>,
    /// `algorithm`.
    pub algorithm: Slot<(LitStr, Algorithm)>,
}

/// The width and kind of a field.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// An integer of this many bytes.
    Int(usize),
    /// A byte array.
    Bytes(usize),
}

impl Field<'_> {
    /// Returns the digest algorithm; MD5 by default.
    pub fn algorithm(&self) -> Algorithm {
        self.algorithm
            .get()
            .map_or(Algorithm::Md5, |(_, algorithm)| *algorithm)
    }
}

impl Shape {
    /// Returns the width in bytes.
    pub fn size(self) -> usize {
        match self {
            Self::Int(size) | Self::Bytes(size) => size,
        }
    }
}

/// The role of a field in the runtime.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The first bytes of a frame.
    Head,
    /// Kind of the data.
    Kind,
    /// Command code.
    Code,
    /// Message id.
    Id,
    /// Encoding of the data.
    Encoding,
    /// Length of the whole frame.
    TotalLength,
    /// Length of the data before compression.
    PlainLength,
    /// Digest of the data as sent.
    Digest,
    /// Sent but never interpreted.
    Status,
}

/// A digest algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// 16 bytes.
    Md5,
    /// An integer of 32 bits.
    Crc32,
}

/// The algorithms by name.
pub const ALGORITHMS: [(&str, Algorithm); 2] =
    [("md5", Algorithm::Md5), ("crc32", Algorithm::Crc32)];

impl Algorithm {
    /// Returns the type in the runtime, the type of the field, and its shape.
    pub fn facts(self) -> (&'static str, &'static str, Shape) {
        match self {
            Self::Md5 => ("Md5", "[u8; 16]", Shape::Bytes(16)),
            Self::Crc32 => ("Crc32", "u32", Shape::Int(4)),
        }
    }
}

/// The roles by name.
pub const ROLES: [(&str, Role); 9] = [
    ("head", Role::Head),
    ("kind", Role::Kind),
    ("code", Role::Code),
    ("id", Role::Id),
    ("encoding", Role::Encoding),
    ("total_length", Role::TotalLength),
    ("plain_length", Role::PlainLength),
    ("digest", Role::Digest),
    ("status", Role::Status),
];

impl<'a> Header<'a> {
    /// Reads the struct and its attributes.
    pub fn read(input: &'a DeriveInput, errors: &mut Errors) -> Self {
        let mut byte_order = Slot::default();
        let runtime = item::read_attributes(input, errors, "a header", &mut |key, input| {
            if key == "byte_order" {
                byte_order.set(key, read_byte_order(input))
            } else {
                Ok(Item::Unknown)
            }
        });
        let message = "the byte order is missing: `#[fc(byte_order = \"big\")]`";
        let byte_order = byte_order.required(errors, &input.ident, message).copied();
        item::forbid_parameters(&input.generics, errors, "a header");
        let mut header = Self {
            ident: &input.ident,
            runtime,
            byte_order: byte_order.unwrap_or(ByteOrder::Big),
            fields: Vec::new(),
        };
        match item::fields(input, errors, "a header is a struct", "") {
            Some(Fields::Named(fields)) => {
                for field in &fields.named {
                    header.add(field, errors);
                }
            }
            Some(Fields::Unnamed(fields)) => errors.on(fields, "the fields of a header have names"),
            Some(Fields::Unit) => errors.on(&input.ident, "a header has fields"),
            None => {}
        }
        header
    }

    fn add(&mut self, field: &'a syn::Field, errors: &mut Errors) {
        let Some(ident) = &field.ident else { return };
        let mut role = Slot::default();
        let mut value = Slot::default();
        let mut algorithm = Slot::default();
        attr::read(
            &field.attrs,
            errors,
            "a header's field",
            &mut |key, input| match key.to_string().as_str() {
                "role" => role.set(key, attr::word(input, &ROLES)),
                "value" => value.set(key, read_value(input)),
                "algorithm" => algorithm.set(key, attr::word(input, &ALGORITHMS)),
                _ => Ok(Item::Unknown),
            },
        );
        let shape = errors.ok(read_shape(&field.ty));
        let offset = self.len();
        self.fields.push(Field {
            ident,
            ty: &field.ty,
            shape,
            offset,
            role,
            value,
            algorithm,
        });
    }

    /// Returns the length in bytes.
    pub fn len(&self) -> usize {
        self.fields
            .iter()
            .filter_map(|field| field.shape)
            .map(Shape::size)
            .sum()
    }
}

fn read_byte_order(input: ParseStream<'_>) -> syn::Result<ByteOrder> {
    const ORDERS: [(&str, ByteOrder); 2] = [("big", ByteOrder::Big), ("little", ByteOrder::Little)];
    attr::word(input, &ORDERS).map(|(_, order)| order)
}

/// Reads `= 0`.
fn read_value(input: ParseStream<'_>) -> syn::Result<LitInt> {
    let literal: LitInt = attr::value(input)?;
    attr::plain_integer::<u64>(&literal)?;
    Ok(literal)
}

fn read_shape(ty: &Type) -> syn::Result<Shape> {
    const MESSAGE: &str = "a header's field is `u8`, `u16`, `u32`, `u64` or `[u8; N]`";
    let error = || syn::Error::new_spanned(ty, MESSAGE);
    match ty {
        Type::Path(path) => match path.path.get_ident().map(ToString::to_string).as_deref() {
            Some("u8") => Ok(Shape::Int(1)),
            Some("u16") => Ok(Shape::Int(2)),
            Some("u32") => Ok(Shape::Int(4)),
            Some("u64") => Ok(Shape::Int(8)),
            _ => Err(error()),
        },
        Type::Array(array) => read_bytes(array).ok_or_else(error),
        _ => Err(error()),
    }
}

/// Reads a byte array. Its length must be a literal, because it is needed for offsets.
fn read_bytes(array: &TypeArray) -> Option<Shape> {
    let Type::Path(element) = &*array.elem else {
        return None;
    };
    if !element.path.is_ident("u8") {
        return None;
    }
    let length = &array.len;
    let literal: LitInt = syn::parse2(quote::quote!(#length)).ok()?;
    let length = literal.base10_parse().ok()?;
    (length > 0).then_some(Shape::Bytes(length))
}
