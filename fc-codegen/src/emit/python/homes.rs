//! Which file holds which types, and what each imports.
//!
//! Python cannot import names in a circle: groups whose types use each other share the file of the first of them.

use super::source::Python;
use crate::emit::stub::context::Context;
use crate::emit::stub::source::Source;
use crate::surface::name::free;
use crate::surface::package::{Item, Module, Package, Shape};
use fc_spec::model::{Direction, Type, TypeRef};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The modules that have a file, and whose types stand in it.
pub struct Homes<'p> {
    package: &'p Package<'p>,
    /// The module whose file holds the types of a module, by their ids.
    of_module: HashMap<&'p str, &'p Module<'p>>,
    /// The modules whose types stand in the file of a module, by its id.
    members: HashMap<&'p str, Vec<&'p Module<'p>>>,
}

impl<'p> Homes<'p> {
    /// Of a package.
    pub fn of(package: &'p Package<'p>) -> Self {
        let uses = package.modules.iter().map(|module| {
            let mut found = Used::default();
            for item in &module.items {
                item.fields().iter().for_each(|it| found.all_in(&it.of.ty));
                if let Shape::Choice(_, variants) = &item.shape {
                    found.types.extend(variants.iter().map(|it| &*it.of.ty));
                }
            }
            let others = found.types.iter().map(|ty| &*package.module_of(ty).id);
            (&*module.id, others.collect())
        });
        let uses: HashMap<&str, BTreeSet<&str>> = uses.collect();
        let reached = package.modules.iter();
        let reached = reached.map(|module| (&*module.id, reached_from(&uses, &module.id)));
        let reached: HashMap<&str, HashSet<&str>> = reached.collect();
        let leads_to =
            |one: &str, other: &str| reached.get(one).is_some_and(|it| it.contains(other));

        let mut of_module = HashMap::new();
        let mut members: HashMap<&str, Vec<&Module<'_>>> = HashMap::new();
        for module in &package.modules {
            let mut modules = package.modules.iter();
            let is_home =
                |it: &&Module<'_>| leads_to(&it.id, &module.id) && leads_to(&module.id, &it.id);
            let home = modules.find(is_home).unwrap_or(module);
            of_module.insert(&*module.id, home);
            members.entry(&home.id).or_default().push(module);
        }
        Self {
            package,
            of_module,
            members,
        }
    }

    /// The module whose file holds the types of this one.
    fn home(&self, module: &'p Module<'p>) -> &'p Module<'p> {
        self.of_module.get(&*module.id).copied().unwrap_or(module)
    }

    /// The module with the types of ids.
    pub fn ids(&self) -> String {
        let modules = &self.package.modules;
        free(&["ids", "entity_ids"], |name| {
            modules.iter().any(|it| it.name == name)
        })
    }

    /// The modules that have a file.
    pub fn modules(&self) -> impl Iterator<Item = &'p Module<'p>> {
        let modules = self.package.modules.iter();
        modules.filter(|module| self.members.contains_key(&*module.id))
    }

    /// The modules whose types stand in the file of this one.
    pub fn members(&self, module: &Module<'_>) -> &[&'p Module<'p>] {
        let members = self.members.get(&*module.id);
        members.map(Vec::as_slice).unwrap_or_default()
    }

    /// The types that stand in the file of a module.
    pub fn items(&self, module: &Module<'_>) -> Vec<&'p Item<'p>> {
        let members = self.members(module).iter();
        members.flat_map(|it| &it.items).collect()
    }

    /// What a module has to show: its types, and the errors of its commands.
    pub fn names<'n>(&'n self, context: &'n Context<'_>, module: &Module<'_>) -> Vec<&'n str> {
        let items = self.items(module).into_iter();
        let names = items.flat_map(|item| {
            let request = item
                .body_of()
                .filter(|(_, side)| *side == Direction::Request);
            let error = request.and_then(|(command, _)| context.package.error_type(command));
            std::iter::once(&*item.ty.name).chain(error)
        });
        names.collect()
    }
}

/// A module and all that it uses, also by way of others.
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

/// What a module of message types has to import.
#[derive(Default)]
pub struct Used<'m> {
    library: BTreeMap<&'static str, BTreeSet<&'static str>>,
    types: BTreeSet<&'m TypeRef>,
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

    /// Writes the imports of the file of a module.
    pub fn imports(
        &self,
        out: &mut Source,
        context: &Context<'_>,
        homes: &Homes<'_>,
        module: &Module<'_>,
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
        let ids_module = homes.ids();
        if !self.ids.is_empty() {
            modules.insert(&ids_module, self.ids.iter().map(String::as_str).collect());
        }
        for named in &self.types {
            let home = homes.home(context.package.module_of(named));
            if home.id != module.id {
                let names = modules.entry(&home.name).or_default();
                names.push(context.name_of(named));
            }
        }
        for (from, names) in modules {
            out.import_from(&format!(".{from}"), &names);
        }
    }
}
