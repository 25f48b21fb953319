//! What the files of the crate ask beyond those of any package: Rust's types, and what they import.

use crate::package::items::Item;
use fc_spec::model::{Field, Type};

pub use crate::package::context::{Context, page_of};

impl Context<'_> {
    /// The Rust type of a field without its optional mark: of ids their own, where they have one.
    pub fn field_type(&self, field: &Field) -> String {
        match self.package.id_of(field) {
            Some(id) => lists_of(&field.ty, &id.name),
            None => self.rust_type(&field.ty),
        }
    }

    /// The Rust type of a type of the spec.
    pub fn rust_type(&self, ty: &Type) -> String {
        match ty {
            Type::Bool | Type::Int(_) | Type::Float(_) => ty.to_string(),
            Type::String => "String".to_owned(),
            Type::TimestampMs | Type::TimestampS => "i64".to_owned(),
            Type::Base64 => "Bytes64".to_owned(),
            Type::Json => "Json".to_owned(),
            Type::Array(item) => format!("Vec<{}>", self.rust_type(item)),
            Type::Named(named) => self.name_of(named).to_owned(),
        }
    }
}

/// A type with `item` in the place of what its lists are of.
fn lists_of(ty: &Type, item: &str) -> String {
    match ty {
        Type::Array(inner) => format!("Vec<{}>", lists_of(inner, item)),
        _ => item.to_owned(),
    }
}

/// Where the stubs find a message type, whatever it is called.
pub fn message(item: &Item<'_>) -> String {
    format!("messages::{}", item.ty.name)
}
