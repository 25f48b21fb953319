//! The package with what every file of the crate asks of it: links, Rust's types.

use crate::surface::language::Language;
use crate::surface::package::{Call, Item, Package};
use fc_spec::model::{Field, Kind, Location, Model, Operation, Type, TypeRef};
use std::collections::{BTreeMap, BTreeSet};

/// The package, and where its documentation is.
pub struct Context<'m> {
    pub package: Package<'m>,
    /// Where the docs are, from the project's root, if it has them.
    docs: Option<&'m str>,
}

impl<'m> Context<'m> {
    pub fn new(model: &'m Model, rust: &Language, docs: Option<&'m str>) -> Self {
        let package = Package::of(model, rust);
        Self { package, docs }
    }

    /// The protocol.
    pub fn model(&self) -> &'m Model {
        self.package.model
    }

    /// The end of a comment: where the spec and the documentation tell of it.
    pub fn links(&self, location: &Location, page: &str) -> String {
        let spec = format!("Spec: `{}` in `{}`", location.name, location.file);
        match self.docs {
            Some(docs) => format!("- {spec}\n- Docs: `{docs}/{page}`"),
            None => format!("{spec}."),
        }
    }

    /// Where the documentation tells of it, if there is one.
    pub fn page(&self, page: &str) -> Option<String> {
        self.docs.map(|docs| format!("Docs: `{docs}/{page}`."))
    }

    /// Commands that have a code.
    pub fn commands(&self) -> Vec<Call<'_>> {
        self.package.calls(Kind::Command)
    }

    /// Reports that have a code.
    pub fn reports(&self) -> Vec<Call<'_>> {
        self.package.calls(Kind::Report)
    }

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

    /// Name of a message type.
    pub fn name_of(&self, named: &TypeRef) -> &str {
        &self.package.item(named).ty.name
    }

    /// Name of a field of a struct.
    pub fn field_name<'a>(&'a self, holder: &TypeRef, field: &'a Field) -> &'a str {
        let mut fields = self.package.item(holder).fields().iter();
        let spelled = fields.find(|known| known.wire == field.wire);
        spelled.map_or(&field.name, |known| &known.name)
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

/// Path of an operation's page below the documentation's root.
pub fn page_of(operation: &Operation) -> String {
    let folder = match operation.kind() {
        Kind::Command => "commands",
        Kind::Report => "reports",
        Kind::Stream => "streams",
    };
    format!("reference/{folder}/{}.md", operation.name)
}
