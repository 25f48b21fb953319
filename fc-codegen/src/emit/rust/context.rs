//! Rust types of fields and messages.

use crate::package::items::Item;
use crate::package::types::in_lists;
use fc_spec::model::{Field, Type};

pub use crate::package::context::{Context, page_of};

impl Context<'_> {
    /// Returns the Rust type of a field without its `Option`. An id field has its id type, if one exists.
    pub fn field_type(&self, field: &Field) -> String {
        match self.package.id_of(field) {
            Some(id) => in_lists(&field.ty, &id.name, |item| format!("Vec<{item}>")),
            None => self.rust_type(&field.ty),
        }
    }

    /// Returns the Rust type of a type of the spec.
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

/// Returns the path to a message type in the stubs. The path avoids clashes with other names.
pub fn message(item: &Item<'_>) -> String {
    format!("messages::{}", item.ty.name)
}
