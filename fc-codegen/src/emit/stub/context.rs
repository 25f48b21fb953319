//! The package, its style, and links from comments to the spec and to the pages.

use super::style::Style;
use crate::surface::language::Language;
use crate::surface::package::{Call, Package};
use crate::target::Targets;
use fc_spec::model::{Field, Kind, Lang, Location, Model, Operation, TypeRef};

/// The package, and where its documentation is.
pub struct Context<'m> {
    pub package: Package<'m>,
    pub style: &'static Style,
    /// The folder of the pages in each language, if the project has them.
    docs: Vec<(Lang, String)>,
}

impl<'m> Context<'m> {
    /// A package whose comments link to the pages of these targets.
    pub fn new(
        model: &'m Model,
        language: &Language,
        style: &'static Style,
        targets: Option<&Targets>,
    ) -> Self {
        Self {
            package: Package::of(model, language),
            style,
            docs: targets.map_or_else(Vec::new, Targets::docs),
        }
    }

    /// The protocol.
    pub fn model(&self) -> &'m Model {
        self.package.model
    }

    /// The end of a comment: links to the spec and to the page in each language.
    pub fn links(&self, location: &Location, page: &str) -> String {
        let spec = format!("Spec: `{}` in `{}`", location.name, location.file);
        match self.page(page) {
            Some(pages) => format!("- {spec}\n{pages}"),
            None => format!("{spec}."),
        }
    }

    /// Links to a page in each language, if the project has the pages.
    pub fn page(&self, page: &str) -> Option<String> {
        let link = |(language, folder): &(Lang, String)| match language {
            Lang::Zh => format!("- 文档：`{folder}/{page}`"),
            Lang::En => format!("- Docs: `{folder}/{page}`"),
        };
        let links: Vec<String> = self.docs.iter().map(link).collect();
        (!links.is_empty()).then(|| links.join("\n"))
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
