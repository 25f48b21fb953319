//! The package with what every file of it asks: how it is written, and where the spec and the pages tell of a thing.

use super::style::Style;
use crate::surface::language::Language;
use crate::surface::package::{Call, Package};
use fc_spec::model::{Field, Kind, Location, Model, Operation, TypeRef};

/// The package, and where its documentation is.
pub struct Context<'m> {
    pub package: Package<'m>,
    pub style: &'static Style,
    /// Where the docs are, from the project's root, if it has them.
    docs: Option<&'m str>,
}

impl<'m> Context<'m> {
    pub fn new(
        model: &'m Model,
        language: &Language,
        style: &'static Style,
        docs: Option<&'m str>,
    ) -> Self {
        Self {
            package: Package::of(model, language),
            style,
            docs,
        }
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
