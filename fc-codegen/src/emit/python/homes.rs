//! Which file holds which groups, what the parts of a group are called, and what a file imports of others.
//!
//! Python cannot import names in a circle: groups that use each other's types or reports share the file of the first of
//! them.

use super::operations::constant;
use super::source::Python;
use crate::emit::stub::context::Context;
use crate::emit::stub::process::set_off;
use crate::emit::stub::source::Source;
use crate::surface::language::{Case, PYTHON, Role};
use crate::surface::name::free;
use crate::surface::package::{Call, Item, Module, Package, Shape};
use fc_spec::model::{
    AcceptedIn, Exchange, Group as SpecGroup, Kind, Operation, Side, Type, TypeRef,
};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// A group, or the types that several groups share.
pub struct Part<'p> {
    id: &'p str,
    /// The module that would be its own.
    name: Cow<'p, str>,
    /// Its types.
    pub items: &'p [Item<'p>],
    /// The group, unless it is the types that several share.
    pub group: Option<Group<'p>>,
}

/// A group, and what its parts are called.
pub struct Group<'p> {
    /// What the spec says of it.
    pub of: &'p SpecGroup,
    /// Its operations, in the order of the spec.
    pub operations: Vec<&'p Operation>,
    /// Those that are methods of the stubs.
    pub commands: Vec<Call<'p>>,
    /// Those that can be pushed.
    pub reports: Vec<Call<'p>>,
    /// The streams that have a code.
    pub streams: Vec<&'p Operation>,
    names: HashMap<Piece, String>,
}

/// What the file of a group has for a file of the package to put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Piece {
    /// The methods of the client.
    Calls,
    /// Those of the client without `async`.
    SyncCalls,
    /// The methods of a complete robot.
    Handlers,
    /// Those of a robot that has some of them.
    PartialHandlers,
    /// The methods that push reports.
    Reporter,
    /// The app's methods for streams.
    Streams,
    /// The robot's methods for streams.
    Streamer,
    /// Any report.
    AnyReport,
    /// All operations of a kind.
    All(Kind),
}

impl Piece {
    const ALL: [Self; 11] = [
        Self::Calls,
        Self::SyncCalls,
        Self::Handlers,
        Self::PartialHandlers,
        Self::Reporter,
        Self::Streams,
        Self::Streamer,
        Self::AnyReport,
        Self::All(Kind::Command),
        Self::All(Kind::Report),
        Self::All(Kind::Stream),
    ];

    /// What a group would call it.
    fn wish(self, group: &str) -> String {
        let words = match self {
            Self::Calls => "Calls",
            Self::SyncCalls => "SyncCalls",
            Self::Handlers => "Handlers",
            Self::PartialHandlers => "PartialHandlers",
            Self::Reporter => "Reporter",
            Self::Streams => "Streams",
            Self::Streamer => "Streamer",
            Self::AnyReport => return format!("Any{}Report", Case::Pascal.apply(group)),
            Self::All(kind) => {
                return Case::Screaming
                    .apply(&format!("{group}_{}s", kind.name()))
                    .into_owned();
            }
        };
        [&Case::Pascal.apply(group), words].concat()
    }
}

impl Group<'_> {
    /// What a piece is called, if the group has it.
    pub fn name(&self, piece: Piece) -> Option<&str> {
        let is_robots = |it: &&Operation| it.sender == Side::Robot;
        let has_it = match piece {
            Piece::Calls | Piece::SyncCalls | Piece::Handlers | Piece::PartialHandlers => {
                !self.commands.is_empty()
            }
            Piece::Reporter | Piece::AnyReport => !self.reports.is_empty(),
            Piece::Streams => !self.streams.is_empty(),
            Piece::Streamer => self.streams.iter().any(is_robots),
            Piece::All(kind) => self.operations.iter().any(|it| it.kind() == kind),
        };
        let name = self.names.get(&piece).filter(|_| has_it)?;
        Some(name)
    }
}

/// The modules that have a file, and what stands in it.
pub struct Homes<'p> {
    package: &'p Package<'p>,
    parts: Vec<Part<'p>>,
    /// The part whose file holds a part, by their ids.
    of_part: HashMap<&'p str, &'p str>,
    ids: String,
}

impl<'p> Homes<'p> {
    /// Of a package.
    pub fn of(context: &'p Context<'_>) -> Self {
        let parts = parts(context);
        let uses = parts.iter().map(|part| {
            let mut found = Used::default();
            for item in part.items {
                item.fields().iter().for_each(|it| found.all_in(&it.of.ty));
                if let Shape::Choice(_, variants) = &item.shape {
                    found.types.extend(variants.iter().map(|it| &*it.of.ty));
                }
            }
            for operation in part.operations() {
                found.operation(context, operation);
            }
            let types = found.types.iter();
            let types = types.map(|ty| &*context.package.module_of(ty).id);
            let reports = found.reports.values().map(|it| it.group.as_str());
            (part.id, types.chain(reports).collect())
        });
        let uses: HashMap<&str, BTreeSet<&str>> = uses.collect();
        let reached = parts.iter().map(|it| (it.id, reached_from(&uses, it.id)));
        let reached: HashMap<&str, HashSet<&str>> = reached.collect();
        let leads_to =
            |one: &str, other: &str| reached.get(one).is_some_and(|it| it.contains(other));
        let homes = parts.iter().map(|part| {
            let mut parts = parts.iter();
            let home = parts.find(|it| leads_to(it.id, part.id) && leads_to(part.id, it.id));
            (part.id, home.unwrap_or(part).id)
        });
        Self {
            package: &context.package,
            of_part: homes.collect(),
            ids: free(&["ids", "entity_ids"], |name| {
                parts.iter().any(|it| it.name == name)
            }),
            parts,
        }
    }

    /// The module with the types of ids.
    pub fn ids(&self) -> &str {
        &self.ids
    }

    /// The parts that have a file, by the names of the files.
    pub fn files(&self) -> impl Iterator<Item = &Part<'p>> {
        let is_home = |part: &&Part<'_>| self.of_part.get(part.id) == Some(&part.id);
        self.parts.iter().filter(is_home)
    }

    /// The parts that stand in the file of this one.
    pub fn members(&self, home: &Part<'_>) -> Vec<&Part<'p>> {
        let is_in = |part: &&Part<'_>| self.of_part.get(part.id) == Some(&home.id);
        self.parts.iter().filter(is_in).collect()
    }

    /// The groups, in the order of the spec.
    fn groups(&self) -> impl Iterator<Item = &Group<'p>> {
        let groups = self.package.model.groups.iter();
        groups.filter_map(|group| self.part(&group.id)?.group.as_ref())
    }

    /// What all groups call one of their pieces, in the order of the spec.
    pub fn pieces(&self, piece: Piece) -> Vec<&str> {
        let names = self.groups().map(|group| group.name(piece));
        names.flatten().collect()
    }

    /// Imports these pieces of all groups.
    pub fn import(&self, out: &mut Source, pieces: &[Piece]) {
        let mut modules: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for part in &self.parts {
            let names = pieces.iter();
            let names = names.filter_map(|piece| part.group.as_ref()?.name(*piece));
            modules
                .entry(self.module(part.id))
                .or_default()
                .extend(names);
        }
        for (module, names) in modules {
            out.import_from(&format!(".groups.{module}"), &names);
        }
    }

    fn part(&self, id: &str) -> Option<&Part<'p>> {
        self.parts.iter().find(|part| part.id == id)
    }

    /// The module whose file holds a part.
    fn module(&self, part: &str) -> &str {
        let home = self.of_part.get(part).and_then(|id| self.part(id));
        home.map_or(&self.ids, |home| &home.name)
    }
}

impl Part<'_> {
    /// What its file is called.
    pub fn module(&self) -> &str {
        &self.name
    }

    /// Its operations.
    pub fn operations(&self) -> &[&Operation] {
        let group = self.group.as_ref();
        group.map_or(&[], |group| &group.operations)
    }
}

/// The groups that have anything, and the types that several share, by their ids.
fn parts<'p>(context: &'p Context<'_>) -> Vec<Part<'p>> {
    let package = &context.package;
    let module_of = |id: &str| {
        let mut modules = package.modules.iter();
        modules.find(|it| it.group.is_some_and(|group| group.id == id))
    };
    let items = |module: &'p Module<'p>| module.items.as_slice();
    let mut taken: HashSet<String> = HashSet::new();
    taken.extend(
        context
            .model()
            .operations
            .iter()
            .map(|it| constant(context, it)),
    );
    let groups = context.model().groups.iter().filter_map(|of| {
        let module = module_of(&of.id);
        let operations = context.model().operations.iter();
        let operations: Vec<&Operation> = operations.filter(|it| it.group == of.id).collect();
        if module.is_none() && operations.is_empty() {
            return None;
        }
        let names = Piece::ALL.into_iter().map(|piece| {
            let is_taken = |name: &str| package.has_type(name) || taken.contains(name);
            let name = free(&[&piece.wish(&of.id)], is_taken);
            taken.insert(name.clone());
            (piece, name)
        });
        let names = names.collect();
        let calls = |kind| {
            let these = operations.iter().filter(|it| it.kind() == kind);
            these.filter_map(|it| package.call(it)).collect()
        };
        let streams = package.streams.iter().map(|it| it.of);
        let (Ok(name) | Err(name)) = PYTHON.spelling(Role::Module, &of.id);
        Some(Part {
            id: &of.id,
            name,
            items: module.map(items).unwrap_or_default(),
            group: Some(Group {
                of,
                commands: calls(Kind::Command),
                reports: calls(Kind::Report),
                streams: streams.filter(|it| it.group == of.id).collect(),
                operations,
                names,
            }),
        })
    });
    let mut parts: Vec<Part<'p>> = groups.collect();
    let shared = package.modules.iter().filter(|it| it.group.is_none());
    parts.extend(shared.map(|module| Part {
        id: &module.id,
        name: Cow::Borrowed(&module.name),
        items: items(module),
        group: None,
    }));
    parts.sort_by(|one, other| one.id.cmp(other.id));
    parts
}

/// A part and all that it uses, also by way of others.
fn reached_from<'p>(uses: &HashMap<&'p str, BTreeSet<&'p str>>, from: &'p str) -> HashSet<&'p str> {
    let mut reached = HashSet::new();
    let mut open = vec![from];
    while let Some(id) = open.pop() {
        if reached.insert(id) {
            open.extend(uses.get(id).into_iter().flatten());
        }
    }
    reached
}

/// What the file of a group has to import.
#[derive(Default)]
pub struct Used<'m> {
    library: BTreeMap<&'static str, BTreeSet<&'static str>>,
    types: BTreeSet<&'m TypeRef>,
    /// The reports that commands set off, by what they are called.
    reports: BTreeMap<String, &'m Operation>,
    ids: BTreeSet<String>,
}

impl<'m> Used<'m> {
    /// A name of the standard library.
    pub fn library(&mut self, module: &'static str, name: &'static str) {
        self.library.entry(module).or_default().insert(name);
    }

    /// A message type.
    pub fn named(&mut self, named: &'m TypeRef) {
        self.types.insert(named);
    }

    /// The message type in the type of a field, if there is one.
    pub fn all_in(&mut self, ty: &'m Type) {
        self.types.extend(ty.innermost());
    }

    /// The type of an id.
    pub fn id(&mut self, name: &str) {
        self.ids.insert(name.to_owned());
    }

    /// What an operation and its methods name.
    pub fn operation(&mut self, context: &'m Context<'_>, operation: &'m Operation) {
        self.types.extend(operation.bodies().map(|it| &*it.ty));
        if let Exchange::Command {
            accepted: Some(accepted),
            ..
        } = &operation.exchange
            && let Some(AcceptedIn::States(sets)) = &accepted.states
        {
            self.types.extend(sets.iter().map(|set| &set.ty));
        }
        for (_, report, messages) in set_off(context, operation) {
            self.reports.insert(constant(context, report), report);
            if operation.code.value.is_some() {
                self.named(&messages.request.ty);
            }
        }
    }

    /// Writes the imports of a file.
    pub fn imports(
        &self,
        out: &mut Source,
        context: &Context<'_>,
        homes: &Homes<'_>,
        home: &Part<'_>,
    ) {
        out.blank();
        out.line("from __future__ import annotations");
        out.blank();
        for (from, names) in &self.library {
            out.import_from(from, &names.iter().copied().collect::<Vec<_>>());
        }
        out.blank();
        out.line("import fc_runtime as rt");
        out.blank();
        let mut modules: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        if !self.ids.is_empty() {
            modules.insert(homes.ids(), self.ids.iter().map(String::as_str).collect());
        }
        let types = self.types.iter().map(|ty| {
            let part = &context.package.module_of(ty).id;
            (part.as_str(), context.name_of(ty))
        });
        let reports = self.reports.iter();
        let reports = reports.map(|(name, report)| (report.group.as_str(), name.as_str()));
        for (part, name) in types.chain(reports) {
            let module = homes.module(part);
            if module != home.module() {
                modules.entry(module).or_default().push(name);
            }
        }
        for (from, names) in modules {
            out.import_from(&format!(".{from}"), &names);
        }
    }
}
