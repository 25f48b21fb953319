//! A group of the spec, with its operations and types in a package.

use super::items::{Call, Item, Package, Spelled};
use fc_spec::model::{self, Kind, Operation, Side};

/// A group, or the types that several groups share.
pub struct Group<'p, 'm> {
    /// The id, from which names are built.
    pub id: &'p str,
    /// The module name of the group in the language.
    pub name: &'p str,
    /// The group in the spec; `None` for the types that several groups share.
    pub of: Option<&'m model::Group>,
    /// All operations, in the order of the spec.
    pub operations: Vec<&'m Operation>,
    /// The commands that have a code.
    pub commands: Vec<Call<'p>>,
    /// The reports that have a code.
    pub reports: Vec<Call<'p>>,
    /// The streams that have a code.
    pub streams: Vec<&'p Spelled<'m, Operation>>,
    /// The message types.
    pub types: &'p [Item<'m>],
}

impl<'p, 'm> Group<'p, 'm> {
    /// Returns the groups that have operations or types, in the order of the spec. Shared types come last.
    #[must_use]
    pub fn all(package: &'p Package<'m>) -> Vec<Self> {
        let groups = package.group_names.iter();
        let groups = groups.map(|group| Self::of_spec(package, &group.name, group.of));
        let groups = groups.filter(|it| !(it.operations.is_empty() && it.types.is_empty()));
        let shared = package.modules.iter().filter(|it| it.group.is_none());
        let shared = shared.map(|module| Self {
            id: &module.id,
            name: &module.name,
            of: None,
            operations: Vec::new(),
            commands: Vec::new(),
            reports: Vec::new(),
            streams: Vec::new(),
            types: &module.items,
        });
        groups.chain(shared).collect()
    }

    fn of_spec(package: &'p Package<'m>, name: &'p str, of: &'m model::Group) -> Self {
        let operations = package.model.operations.iter();
        let operations: Vec<&Operation> = operations.filter(|it| it.group == of.id).collect();
        let calls = |kind: Kind| {
            let these = operations.iter().filter(|it| it.kind() == kind);
            these.filter_map(|it| package.call(it)).collect()
        };
        let streams = package.streams.iter();
        let mut modules = package.modules.iter();
        let module = modules.find(|it| it.group.is_some_and(|group| group.id == of.id));
        Self {
            id: &of.id,
            name,
            of: Some(of),
            commands: calls(Kind::Command),
            reports: calls(Kind::Report),
            streams: streams.filter(|it| it.group == of.id).collect(),
            types: module.map_or(&[], |module| &module.items),
            operations,
        }
    }

    /// Returns the streams that the robot sends and an app subscribes to.
    pub fn subscribed(&self) -> impl Iterator<Item = &'p Spelled<'m, Operation>> {
        let streams = self.streams.iter().copied();
        streams.filter(|it| it.sender == Side::Robot)
    }

    /// Returns the streams that an app sends.
    pub fn sent(&self) -> impl Iterator<Item = &'p Spelled<'m, Operation>> {
        let streams = self.streams.iter().copied();
        streams.filter(|it| it.sender == Side::App)
    }

    /// Returns the spec file that defines the group.
    #[must_use]
    pub fn file(&self) -> &'p str
    where
        'm: 'p,
    {
        let first = self.types.first();
        match self.of {
            Some(of) => &of.location.file,
            None => first.map_or("the spec", |item| &item.ty.of.location.file),
        }
    }
}
