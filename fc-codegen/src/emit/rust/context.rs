//! What the files of the crate ask beyond those of any package: Rust's types, and what they import.

use crate::surface::package::Item;
use fc_spec::model::{Field, Type, TypeRef};
use std::collections::{BTreeMap, BTreeSet};

pub use crate::emit::stub::context::{Context, page_of};

impl Context<'_> {
    /// Types that the module `home` does not hold, by the module that does.
    pub fn imports<'a>(
        &'a self,
        home: &str,
        types: impl IntoIterator<Item = &'a TypeRef>,
    ) -> BTreeMap<&'a str, BTreeSet<&'a str>> {
        let mut imports: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for named in types {
            let module = self.package.module_of(named);
            if module.id != home {
                let names = imports.entry(&module.name).or_default();
                names.insert(self.name_of(named));
            }
        }
        imports
    }

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
