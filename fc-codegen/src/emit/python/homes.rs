//! Which file holds which types, and what each imports.
//!
//! Python cannot import names in a circle: groups whose types use each other share the file of the first of them.

use super::source::Python;
use crate::emit::stub::context::Context;
use crate::emit::stub::source::Source;
use crate::surface::name::free;
use crate::surface::package::{Item, Module, Package, Shape};
use fc_spec::model::{Direction, Type, TypeRef};
use std::collections::{BTreeMap, BTreeSet};

/// Which modules use which, by their ids.
pub struct Homes<'p> {
    package: &'p Package<'p>,
    /// All that a module uses, also by way of others.
    uses: BTreeMap<&'p str, BTreeSet<&'p str>>,
}

impl<'p> Homes<'p> {
    /// Of a package.
    pub fn of(package: &'p Package<'_>) -> Self {
        let mut uses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for module in &package.modules {
            let mut found = Used::default();
            for item in &module.items {
                item.fields().iter().for_each(|it| found.all_in(&it.of.ty));
                if let Shape::Choice(_, variants) = &item.shape {
                    found.types.extend(variants.iter().map(|it| &*it.of.ty));
                }
            }
            let others = found.types.iter().map(|ty| &*package.module_of(ty).id);
            uses.insert(&module.id, others.collect());
        }
        for _ in &package.modules {
            let before = uses.clone();
            for used in uses.values_mut() {
                let further = used.iter().filter_map(|id| before.get(id)).flatten();
                let further: Vec<&str> = further.copied().collect();
                used.extend(further);
            }
        }
        Self { package, uses }
    }

    fn reaches(&self, one: &str, other: &str) -> bool {
        one == other || self.uses.get(one).is_some_and(|used| used.contains(other))
    }

    /// The module whose file holds the types of this one.
    fn home<'h>(&'h self, module: &'h Module<'p>) -> &'h Module<'p> {
        let mut modules = self.package.modules.iter();
        let shared =
            modules.find(|it| self.reaches(&it.id, &module.id) && self.reaches(&module.id, &it.id));
        shared.unwrap_or(module)
    }

    /// The module with the types of ids.
    pub fn ids(&self) -> String {
        let modules = &self.package.modules;
        free(&["ids", "entity_ids"], |name| {
            modules.iter().any(|it| it.name == name)
        })
    }

    /// The modules that have a file.
    pub fn modules(&self) -> impl Iterator<Item = &Module<'p>> {
        let modules = self.package.modules.iter();
        modules.filter(|module| self.home(module).id == module.id)
    }

    /// The modules whose types stand in the file of this one.
    pub fn members(&self, module: &Module<'_>) -> Vec<&Module<'p>> {
        let modules = self.package.modules.iter();
        modules.filter(|it| self.home(it).id == module.id).collect()
    }

    /// The types that stand in the file of a module.
    pub fn items(&self, module: &Module<'_>) -> Vec<&Item<'p>> {
        let members = self.members(module).into_iter();
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
