//! The groups of a protocol. The file of a group contains all parts of its operations.
//!
//! All other files name only groups, so that a new operation does not change them.

use super::layout::Includes;
use super::types::{Header, namespace};
use super::{client, protocol, robot, streams};
use crate::package::context::Context;
use crate::package::group::Group;
use crate::package::items::Package;
use crate::package::language::Case;
use crate::package::name::free;
use crate::package::source::Source;
use std::collections::BTreeMap;
use std::ops::Deref;

/// A group with operations, and the names of its parts.
pub struct NamedGroup<'p, 'm> {
    group: Group<'p, 'm>,
    /// The prefix of its type names: `Identity`.
    stem: String,
    /// The namespace of the parts of all groups.
    space: String,
    package: &'p Package<'m>,
}

impl<'p, 'm> Deref for NamedGroup<'p, 'm> {
    type Target = Group<'p, 'm>;

    fn deref(&self) -> &Group<'p, 'm> {
        &self.group
    }
}

impl NamedGroup<'_, '_> {
    /// Returns the name of a part inside the namespace: `IdentityCalls`.
    pub fn part(&self, part: &str) -> String {
        let name = [&self.stem, part].concat();
        let is_taken = |name: &str| self.package.items().any(|item| item.ty.name == name);
        free(&[&name], is_taken)
    }

    /// Writes a part whose methods are those of the class that derives from it.
    pub fn mixin(&self, out: &mut Source, part: &str, methods: impl FnOnce(&mut Source)) {
        let name = self.part(part);
        out.line(format!("template <class Self>\nclass {name} {{\n public:"));
        out.enclose("", "};", methods);
    }

    /// Returns the name of a part outside the namespace: `groups::IdentityCalls`.
    pub fn named(&self, part: &str) -> String {
        format!("{}::{}", self.space, self.part(part))
    }

    /// Returns the name of a function outside the namespace: `groups::serve_identity`.
    pub fn function(&self, verb: &str) -> String {
        format!("{}::{verb}_{}", self.space, self.id)
    }
}

/// Returns the groups that have operations, in the order of the spec.
pub fn groups<'p, 'm>(context: &'p Context<'m>) -> Vec<NamedGroup<'p, 'm>> {
    let package = &context.package;
    let is_table = |name: &str| package.tables.iter().any(|table| table.name == name);
    let space = free(&["groups", "command_groups"], is_table);
    let mut groups: Vec<NamedGroup<'p, 'm>> = Vec::new();
    let all = Group::all(package).into_iter();
    for group in all.filter(|it| !it.operations.is_empty()) {
        let stem = Case::Pascal.apply(group.id);
        let stem = free(&[&stem], |stem| groups.iter().any(|it| it.stem == stem));
        groups.push(NamedGroup {
            group,
            stem,
            space: space.clone(),
            package,
        });
    }
    groups
}

/// Returns the names of a part, for the groups that have commands.
pub fn with_commands(groups: &[NamedGroup<'_, '_>], part: &str) -> Vec<String> {
    parts(groups, part, |group| !group.commands.is_empty())
}

/// Returns the names of a part, for the groups that have reports.
pub fn with_reports(groups: &[NamedGroup<'_, '_>], part: &str) -> Vec<String> {
    parts(groups, part, |group| !group.reports.is_empty())
}

/// Returns the names of a part, for the groups that have it.
pub fn parts(
    groups: &[NamedGroup<'_, '_>],
    part: &str,
    has: impl Fn(&Group<'_, '_>) -> bool,
) -> Vec<String> {
    let groups = groups.iter().filter(|group| has(group));
    groups.map(|group| group.named(part)).collect()
}

/// Returns the groups whose operations are in a header.
pub fn of_header<'g, 'p, 'm>(
    groups: &'g [NamedGroup<'p, 'm>],
    header: &Header<'_, '_>,
    homes: &BTreeMap<&str, &str>,
) -> Vec<&'g NamedGroup<'p, 'm>> {
    let is_here = |group: &&NamedGroup<'_, '_>| homes.get(group.id) == Some(&header.id);
    groups.iter().filter(is_here).collect()
}

/// Declares the parts of the groups in their header, after the messages.
pub fn declare(
    out: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    groups: &[&NamedGroup<'_, '_>],
) {
    let Some(first) = groups.first() else {
        return;
    };
    includes.add(&["vector"], &["protocol"]);
    let space = &namespace(context);
    out.blank();
    out.namespace(&format!("{space}::{}", first.space), |out| {
        for group in groups {
            out.blank();
            if !group.commands.is_empty() {
                includes.add(&["optional", "string_view"], &["typed", "types"]);
                client::calls(out, context, group);
                out.blank();
                robot::handlers(out, context, group);
                out.blank();
                robot::defaults(out, group);
                out.blank();
            }
            if !group.reports.is_empty() {
                includes.add(&["optional"], &["push", "types"]);
                robot::reporters(out, context, group);
                out.blank();
            }
            if !group.streams.is_empty() {
                includes.add(&["cstddef", "cstdint", "optional"], &["data", "push"]);
                includes.add(&["string", "string_view", "utility"], &[]);
                streams::parts(out, context, group);
                out.blank();
            }
            client::lists(out, group);
            if !group.commands.is_empty() {
                robot::declare_serve(out, group);
            }
            protocol::declare_operations(out, group);
        }
    });
}

/// Defines the declared parts in the source.
pub fn define(out: &mut Source, context: &Context<'_>, groups: &[&NamedGroup<'_, '_>]) {
    let Some(first) = groups.first() else {
        return;
    };
    let space = &namespace(context);
    out.blank();
    out.namespace(&format!("{space}::{}", first.space), |out| {
        for group in groups {
            out.blank();
            if !group.commands.is_empty() {
                robot::serve(out, group);
                out.blank();
            }
            protocol::operations(out, context, group);
        }
    });
}
