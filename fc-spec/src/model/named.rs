//! The names of declared things that a model uses, other than those of types and operations.

use super::types::Unlinked;
use super::{Available, Model, TypeShape};
use std::collections::HashSet;

/// A kind of thing that a model declares and uses by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Thing {
    Group,
    Entity,
    Store,
    CoordinateSystem,
    Audience,
    Machine,
    Series,
}

impl Thing {
    /// The name of the kind in a message.
    fn word(self) -> &'static str {
        match self {
            Self::Group => "group",
            Self::Entity => "entity",
            Self::Store => "store",
            Self::CoordinateSystem => "coordinate system",
            Self::Audience => "audience",
            Self::Machine => "hardware",
            Self::Series => "releases",
        }
    }
}

/// A name of a thing, with its user.
struct Named<'m> {
    thing: Thing,
    name: &'m str,
    user: String,
}

impl Model {
    /// Checks that every thing that the model uses by name is declared.
    pub(super) fn check_names(&self) -> Result<(), Unlinked> {
        let declared = self.declared();
        let named = self.named().into_iter();
        let mut unknown = named.filter(|it| !declared.contains(&(it.thing, it.name)));
        match unknown.next() {
            Some(Named { thing, name, user }) => Err(Unlinked {
                missing: format!("the {} `{name}`", thing.word()),
                user: format!("`{user}`"),
            }),
            None => Ok(()),
        }
    }

    fn declared(&self) -> HashSet<(Thing, &str)> {
        let words = &self.availability;
        let groups = self.groups.iter().map(|it| (Thing::Group, &it.id));
        let entities = self.entities.iter().map(|it| (Thing::Entity, &it.name));
        let stores = self.stores.iter().map(|it| (Thing::Store, &it.name));
        let systems = self.coordinates.iter();
        let systems = systems.map(|it| (Thing::CoordinateSystem, &it.name));
        let audiences = words.audiences.iter().map(|it| (Thing::Audience, &it.name));
        let machines = words.hardware.iter().map(|it| (Thing::Machine, &it.name));
        let series = words.releases.iter().map(|it| (Thing::Series, &it.name));
        let things = groups.chain(entities).chain(stores).chain(systems);
        let things = things.chain(audiences).chain(machines).chain(series);
        things.map(|(thing, name)| (thing, name.as_str())).collect()
    }

    /// Removes the groups, entities, coordinate systems and stores that the model does not use.
    pub(super) fn retain_named(&mut self) {
        let named = self.named().into_iter();
        let named: HashSet<_> = named.map(|it| (it.thing, it.name.to_owned())).collect();
        let is_named = |thing, name: &String| named.contains(&(thing, name.clone()));
        self.groups.retain(|it| is_named(Thing::Group, &it.id));
        for range in &mut self.ranges {
            range.groups.retain(|it| is_named(Thing::Group, it));
        }
        self.entities.retain(|it| is_named(Thing::Entity, &it.name));
        self.coordinates
            .retain(|it| is_named(Thing::CoordinateSystem, &it.name));
        self.stores.retain(|it| is_named(Thing::Store, &it.name));
    }

    /// Returns every name of a declared thing.
    fn named(&self) -> Vec<Named<'_>> {
        let mut all = Names(Vec::new());
        for operation in &self.operations {
            let user = || operation.name.clone();
            all.add(Thing::Group, [&operation.group], user);
            all.add(Thing::Store, &operation.kept, user);
            all.available(operation.available.as_ref(), user);
        }
        for table in &self.tables {
            all.add(Thing::Store, &table.kept, || table.id.clone());
        }
        for ty in &self.types {
            all.add(Thing::Group, &ty.group, || ty.name.clone());
            let user = |part: &str| format!("{}.{part}", ty.name);
            match &ty.shape {
                TypeShape::Struct(shape) => {
                    let system = &shape.coordinates;
                    all.add(Thing::CoordinateSystem, system, || ty.name.clone());
                    for field in &shape.fields {
                        let (details, user) = (field.details(), || user(&field.wire));
                        all.add(Thing::Entity, &details.refers, user);
                        all.add(Thing::CoordinateSystem, &details.coordinates, user);
                        all.add(Thing::Store, &details.kept, user);
                        all.available(details.available.as_ref(), user);
                    }
                }
                TypeShape::Enum(shape) => {
                    for value in &shape.values {
                        all.available(value.available.as_ref(), || user(&value.name));
                    }
                }
                TypeShape::OneOf(choice) => {
                    for variant in &choice.variants {
                        all.available(variant.available.as_ref(), || user(&variant.name));
                    }
                }
            }
        }
        all.0
    }
}

struct Names<'m>(Vec<Named<'m>>);

impl<'m> Names<'m> {
    fn add(
        &mut self,
        thing: Thing,
        names: impl IntoIterator<Item = &'m String>,
        user: impl Fn() -> String,
    ) {
        self.0.extend(names.into_iter().map(|name| Named {
            thing,
            name,
            user: user(),
        }));
    }

    fn available(&mut self, available: Option<&'m Available>, user: impl Fn() -> String) {
        if let Some(it) = available {
            self.add(Thing::Audience, &it.audiences, &user);
            self.add(Thing::Machine, &it.hardware, &user);
            self.add(Thing::Series, it.from.keys().chain(it.until.keys()), &user);
        }
    }
}
