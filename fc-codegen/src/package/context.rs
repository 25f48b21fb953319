//! The package, its style, and links from comments to the spec and to the pages.

use super::style::Style;
use crate::package::items::{Call, Item, Package, Shape, Spelled};
use crate::package::language::Language;
use crate::sample::{Profile, Samples};
use crate::target::Targets;
use fc_spec::model::{
    Accepted, Direction, EnumType, EnumValue, Kind, Lang, Location, Model, Operation, StructRef,
    Type, TypeRef,
};
use std::collections::{BTreeMap, BTreeSet};

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
            package: Package::build(model, language),
            style,
            docs: targets.map_or_else(Vec::new, Targets::docs),
        }
    }

    /// The protocol.
    pub fn model(&self) -> &'m Model {
        self.package.model
    }

    /// The values that the spec gives as examples, or that are made up for it.
    pub fn samples(&self) -> Samples<'m> {
        Samples::new(self.model())
    }

    /// The spec's example of a message type, as JSON.
    pub fn example(&self, item: &Item<'_>) -> String {
        self.samples()
            .named(item.ty.of, Profile::Example)
            .to_string()
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

    /// The message type that a stream carries; `None` for raw bytes.
    pub fn content(&self, stream: &Operation) -> Option<&str> {
        Some(self.name_of(&stream.body(Direction::Request)?.ty))
    }

    /// The fields on the way that keys lead from a body.
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

    /// The enums that decide if a command is accepted.
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
}

/// A field on the way from a body to one of its values.
pub struct Step<'p> {
    /// The type of the struct that holds it.
    pub holder: &'p str,
    /// Its name there.
    pub name: &'p str,
    /// `true` if it may be absent.
    pub optional: bool,
}

/// An enum with the values in which a command is accepted.
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

/// Path of an operation's page below the documentation's root.
pub fn page_of(operation: &Operation) -> String {
    let folder = match operation.kind() {
        Kind::Command => "commands",
        Kind::Report => "reports",
        Kind::Stream => "streams",
    };
    format!("reference/{folder}/{}.md", operation.name)
}
