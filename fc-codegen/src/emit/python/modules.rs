//! The modules of the groups, the names of a group's parts, and the imports of a module.
//!
//! Python cannot import names in a cycle. Groups that use each other's types or reports therefore share the file of the
//! first of them.

use super::operations::constant;
use super::source::Python;
use crate::package::context::Context;
use crate::package::cycles::{Needs, first_of_circle, reached};
use crate::package::group::Group;
use crate::package::items::Package;
use crate::package::language::Case;
use crate::package::name::free;
use crate::package::process::set_off;
use crate::package::source::Source;
use crate::package::types::parts;
use fc_spec::model::{Accepted, Kind, Operation, Type, TypeRef};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::ops::Deref;

/// A group, and the names of its parts.
pub struct NamedGroup<'p, 'm> {
    group: Group<'p, 'm>,
    names: HashMap<GroupPart, String>,
}

impl<'p, 'm> Deref for NamedGroup<'p, 'm> {
    type Target = Group<'p, 'm>;

    fn deref(&self) -> &Group<'p, 'm> {
        &self.group
    }
}

/// A part of a group's module. A file of the package combines this part of all groups.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroupPart {
    /// The methods of the client.
    Calls,
    /// The methods of the client without `async`.
    SyncCalls,
    /// The methods of a complete robot.
    Handlers,
    /// The methods of a partial robot, which implements only some of them.
    PartialHandlers,
    /// The methods that push reports.
    Reporter,
    /// The app's methods for streams.
    Streams,
    /// The robot's methods for streams.
    Streamer,
    /// The union of the reports.
    AnyReport,
    /// All operations of a kind.
    All(Kind),
}

impl GroupPart {
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

    fn preferred_name(self, group: &str) -> String {
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

impl NamedGroup<'_, '_> {
    /// Returns the name of a part, if the group has it.
    pub fn part(&self, part: GroupPart) -> Option<&str> {
        let has_it = match part {
            GroupPart::Calls
            | GroupPart::SyncCalls
            | GroupPart::Handlers
            | GroupPart::PartialHandlers => !self.commands.is_empty(),
            GroupPart::Reporter | GroupPart::AnyReport => !self.reports.is_empty(),
            GroupPart::Streams => !self.streams.is_empty(),
            GroupPart::Streamer => self.subscribed().next().is_some(),
            GroupPart::All(kind) => self.operations.iter().any(|it| it.kind() == kind),
        };
        let name = self.names.get(&part).filter(|_| has_it)?;
        Some(name)
    }
}

/// The modules that have a file, and the groups in each.
pub struct ModulePlan<'p, 'm> {
    package: &'p Package<'m>,
    /// The groups, sorted by id.
    groups: Vec<NamedGroup<'p, 'm>>,
    /// The group whose file contains a group, by the id of the latter.
    homes: HashMap<&'p str, &'p str>,
    ids: String,
}

impl<'p, 'm> ModulePlan<'p, 'm> {
    /// Plans the modules of a package.
    pub fn build(context: &'p Context<'m>) -> Self {
        let groups = named_groups(context);
        let uses = groups.iter().map(|group| {
            let mut found = Used::default();
            for item in group.types {
                found.types.extend(parts(item));
            }
            for operation in &group.operations {
                found.operation(context, operation);
            }
            let types = found.types.iter();
            let types = types.map(|ty| &*context.package.module_of(ty).id);
            let reports = found.reports.values().map(|it| it.group.as_str());
            (group.id, types.chain(reports).collect())
        });
        let reached = reached(&uses.collect::<Needs<'_>>());
        let homes = groups.iter();
        let homes = homes.map(|group| (group.id, first_of_circle(&reached, group.id)));
        Self {
            package: &context.package,
            homes: homes.collect(),
            ids: free(&["ids", "entity_ids"], |name| {
                groups.iter().any(|it| it.name == name)
            }),
            groups,
        }
    }

    /// Returns the module with the id types.
    pub fn ids(&self) -> &str {
        &self.ids
    }

    /// Returns the groups that have a file, sorted by id.
    pub fn files(&self) -> impl Iterator<Item = &NamedGroup<'p, 'm>> {
        let groups = self.groups.iter();
        groups.filter(|group| self.homes.get(group.id) == Some(&group.id))
    }

    /// Returns the groups in the file of `home`.
    pub fn members(&self, home: &Group<'_, '_>) -> Vec<&NamedGroup<'p, 'm>> {
        let groups = self.groups.iter();
        let members = groups.filter(|group| self.homes.get(group.id) == Some(&home.id));
        members.collect()
    }

    /// Returns the names of one part of all groups, in the order of the spec.
    pub fn parts(&self, part: GroupPart) -> Vec<&str> {
        let groups = self.package.model.groups.iter();
        let names = groups.filter_map(|group| self.group(&group.id)?.part(part));
        names.collect()
    }

    /// Writes imports of these parts of all groups.
    pub fn import(&self, out: &mut Source, parts: &[GroupPart]) {
        let mut modules: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for group in &self.groups {
            let names = parts.iter().filter_map(|part| group.part(*part));
            modules
                .entry(self.module(group.id))
                .or_default()
                .extend(names);
        }
        for (module, names) in modules {
            out.import_from(&format!(".groups.{module}"), &names);
        }
    }

    fn group(&self, id: &str) -> Option<&NamedGroup<'p, 'm>> {
        self.groups.iter().find(|group| group.id == id)
    }

    /// Returns the module whose file contains a group.
    fn module(&self, group: &str) -> &str {
        let home = self.homes.get(group).and_then(|id| self.group(id));
        home.map_or(&self.ids, |home| home.name)
    }
}

/// Returns the groups, sorted by id.
fn named_groups<'p, 'm>(context: &'p Context<'m>) -> Vec<NamedGroup<'p, 'm>> {
    let package = &context.package;
    let operations = context.model().operations.iter();
    let mut taken: HashSet<String> = operations.map(|it| constant(context, it)).collect();
    let groups = Group::all(package).into_iter().map(|group| {
        let parts = GroupPart::ALL.into_iter().filter(|_| group.of.is_some());
        let names = parts.map(|part| {
            let is_taken = |name: &str| package.has_type(name) || taken.contains(name);
            let name = free(&[&part.preferred_name(group.id)], is_taken);
            taken.insert(name.clone());
            (part, name)
        });
        let names = names.collect();
        NamedGroup { group, names }
    });
    let mut groups: Vec<_> = groups.collect();
    groups.sort_by(|one, other| one.id.cmp(other.id));
    groups
}

/// The imports of a module.
#[derive(Default)]
pub struct Used<'m> {
    library: BTreeMap<&'static str, BTreeSet<&'static str>>,
    types: BTreeSet<&'m TypeRef>,
    /// The reports that commands set off, by the names of their constants.
    reports: BTreeMap<String, &'m Operation>,
    ids: BTreeSet<String>,
}

impl<'m> Used<'m> {
    /// Adds a name of the standard library.
    pub fn library(&mut self, module: &'static str, name: &'static str) {
        self.library.entry(module).or_default().insert(name);
    }

    /// Adds a message type.
    pub fn named(&mut self, named: &'m TypeRef) {
        self.types.insert(named);
    }

    /// Adds the message type in the type of a field, if there is one.
    pub fn all_in(&mut self, ty: &'m Type) {
        self.types.extend(ty.innermost());
    }

    /// Adds an id type.
    pub fn id(&mut self, name: &str) {
        self.ids.insert(name.to_owned());
    }

    /// Adds the names that an operation and its methods use.
    pub fn operation(&mut self, context: &'m Context<'_>, operation: &'m Operation) {
        self.types.extend(operation.bodies().map(|it| &*it.ty));
        let accepted = operation.accepted().into_iter();
        let sets = accepted.flat_map(Accepted::state_sets);
        self.types.extend(sets.map(|set| &set.ty));
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
        plan: &ModulePlan<'_, '_>,
        home: &Group<'_, '_>,
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
            modules.insert(plan.ids(), self.ids.iter().map(String::as_str).collect());
        }
        let types = self.types.iter().map(|ty| {
            let part = &context.package.module_of(ty).id;
            (part.as_str(), context.name_of(ty))
        });
        let reports = self.reports.iter();
        let reports = reports.map(|(name, report)| (report.group.as_str(), name.as_str()));
        for (part, name) in types.chain(reports) {
            let module = plan.module(part);
            if module != home.name {
                modules.entry(module).or_default().push(name);
            }
        }
        for (from, names) in modules {
            out.import_from(&format!(".{from}"), &names);
        }
    }
}
