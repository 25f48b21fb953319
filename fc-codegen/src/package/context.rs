//! The package, its style, and links from comments to the spec and to the pages.

use super::source::Source;
use super::style::Style;
use crate::package::items::{Call, Item, Package, Shape, Spelled};
use crate::package::joined::Joined;
use crate::package::language::Language;
use crate::sample::{Profile, Samples};
use fc_spec::model::{
    Accepted, Direction, Entity, EnumType, EnumValue, Kind, Lang, Languages, Location, Model,
    Operation, StructRef, Type, TypeRef,
};
use std::collections::{BTreeMap, BTreeSet};

/// The package, its style and languages, and the location of its documentation.
pub struct Context<'m> {
    pub package: Package<'m>,
    pub style: &'static Style,
    /// The languages of the comments.
    languages: Languages,
    /// The folder of the pages in each language; empty if the project has no pages.
    docs: Vec<(Lang, String)>,
}

impl<'m> Context<'m> {
    /// Creates a context whose comments are in both languages and link to no pages.
    pub fn new(model: &'m Model, language: &Language, style: &'static Style) -> Self {
        Self {
            package: Package::build(model, language),
            style,
            languages: Languages::All,
            docs: Vec::new(),
        }
    }

    /// Sets the languages of the comments, and the folder of the pages in each language.
    #[must_use]
    pub fn commented(self, languages: Languages, docs: Vec<(Lang, String)>) -> Self {
        let docs = docs.into_iter();
        Self {
            languages,
            docs: docs.filter(|(it, _)| languages.include(*it)).collect(),
            ..self
        }
    }

    /// Creates an empty file, or a part of one.
    pub fn source(&self) -> Source {
        Source::new(self.style, self.languages)
    }

    /// Returns the protocol.
    pub fn model(&self) -> &'m Model {
        self.package.model
    }

    /// Returns the source of example values: from the spec, or invented for it.
    pub fn samples(&self) -> Samples<'m> {
        Samples::new(self.model())
    }

    /// Returns the spec's example of a message type, as JSON.
    pub fn example(&self, item: &Item<'_>) -> String {
        self.samples()
            .named(item.ty.of, Profile::Example)
            .to_string()
    }

    /// Returns the last paragraph of a comment: links to the spec and to the page in each language.
    pub fn links(&self, location: &Location, page: &str) -> String {
        let spec = format!("Spec: `{}` in `{}`", location.name, location.file);
        match self.page(page) {
            Some(pages) => format!("- {spec}\n{pages}"),
            None => format!("{spec}."),
        }
    }

    /// Returns links to a page in each language; `None` if the project has no pages.
    pub fn page(&self, page: &str) -> Option<String> {
        let link = |(language, folder): &(Lang, String)| match language {
            Lang::Zh => format!("- 文档：`{folder}/{page}`"),
            Lang::En => format!("- Docs: `{folder}/{page}`"),
        };
        let links = self.docs.iter().map(link).joined("\n");
        (!links.is_empty()).then_some(links)
    }

    /// Returns the commands that have a code.
    pub fn commands(&self) -> Vec<Call<'_>> {
        self.package.calls(Kind::Command)
    }

    /// Returns the reports that have a code.
    pub fn reports(&self) -> Vec<Call<'_>> {
        self.package.calls(Kind::Report)
    }

    /// Returns the id types of the package, each with the type of its value.
    pub fn ids(&self) -> impl Iterator<Item = (&Spelled<'m, Entity>, &'m Type)> {
        let ids = self.package.ids.iter();
        ids.filter_map(|id| Some((id, self.model().id_type(id)?)))
    }

    /// Returns the name of a message type.
    pub fn name_of(&self, named: &TypeRef) -> &str {
        &self.package.item(named).ty.name
    }

    /// Returns the message type that a stream carries; `None` for raw bytes.
    pub fn content(&self, stream: &Operation) -> Option<&str> {
        Some(self.name_of(&stream.body(Direction::Request)?.ty))
    }

    /// Returns the fields along the path `keys`, which starts at `body`.
    pub fn steps(&self, body: &StructRef, keys: &[String]) -> Vec<Step<'_>> {
        let mut holder = self.package.item(body);
        let way = self.model().way(body, keys).into_iter();
        let steps = way.map(|field| {
            let mut fields = holder.fields().iter();
            let spelled = fields.find(|known| known.wire == field.wire);
            let step = Step {
                holder: &holder.ty.name,
                name: spelled.map_or(&field.name, |known| &known.name),
                optional: field.optional,
            };
            if let Type::Named(named) = &field.ty {
                holder = self.package.item(named);
            }
            step
        });
        steps.collect()
    }

    /// Returns the enums that decide if a command is accepted.
    pub fn accepted_states<'a>(&'a self, command: &'a Operation) -> Vec<AcceptedStates<'a, 'm>> {
        let accepted = command.accepted().into_iter();
        let sets = accepted.flat_map(Accepted::state_sets);
        let states = sets.filter_map(|set| {
            let item = self.package.item(&set.ty);
            let Shape::Enum(shape, known) = &item.shape else {
                return None;
            };
            let known = known.iter();
            let values = known.filter(|value| set.values.contains(&value.wire));
            Some(AcceptedStates {
                ty: &set.ty,
                item,
                shape,
                values: values.collect(),
            })
        });
        states.collect()
    }

    /// Returns the types that are not in the module `home`, grouped by their module.
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
}

/// A field on the path from a body to one of its values.
pub struct Step<'p> {
    /// The type of the struct that has the field.
    pub holder: &'p str,
    /// The name of the field.
    pub name: &'p str,
    /// `true` if the field may be absent.
    pub optional: bool,
}

/// An enum, with the values that allow a command.
pub struct AcceptedStates<'p, 'm> {
    /// The enum as a type of the spec.
    pub ty: &'p TypeRef,
    /// The enum.
    pub item: &'p Item<'m>,
    /// Its shape.
    pub shape: &'m EnumType,
    /// The values.
    pub values: Vec<&'p Spelled<'m, EnumValue>>,
}

/// Returns the path of an operation's page, relative to the documentation's root.
pub fn page_of(operation: &Operation) -> String {
    let folder = match operation.kind() {
        Kind::Command => "commands",
        Kind::Report => "reports",
        Kind::Stream => "streams",
    };
    format!("reference/{folder}/{}.md", operation.name)
}
