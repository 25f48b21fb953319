//! The groups of a protocol. Whatever the package has of an operation is in the file of its group; all other files name
//! groups alone, so that they stay as they are when an operation is added.

use super::layout::Includes;
use super::types::{Header, namespace};
use super::{client, protocol, robot};
use crate::emit::stub::context::Context;
use crate::emit::stub::source::Source;
use crate::surface::language::Case;
use crate::surface::name::free;
use crate::surface::package::Call;
use fc_spec::model::{Kind, Operation};
use std::collections::BTreeMap;

/// A group with its operations.
pub struct Group<'p> {
    /// Its id.
    pub id: &'p str,
    /// Its id as types of its own begin: `Identity`.
    stem: String,
    /// The namespace that the parts of all groups are in.
    space: String,
    /// All of its operations.
    pub operations: Vec<&'p Operation>,
    /// The commands among them that have a code.
    pub commands: Vec<Call<'p>>,
    /// The reports among them that have a code.
    pub reports: Vec<Call<'p>>,
    /// Names of its parts that a message type has already.
    taken: Vec<&'p str>,
}

impl Group<'_> {
    /// The name of a type of its own: `IdentityCalls`.
    pub fn name(&self, part: &str) -> String {
        let name = [&self.stem, part].concat();
        free(&[&name], |name| self.taken.contains(&name))
    }

    /// The same as it is named outside: `groups::IdentityCalls`.
    pub fn named(&self, part: &str) -> String {
        format!("{}::{}", self.space, self.name(part))
    }

    /// A function of its own as it is named outside: `groups::serve_identity`.
    pub fn function(&self, verb: &str) -> String {
        format!("{}::{verb}_{}", self.space, self.id)
    }
}

/// The groups that have operations, in the order of the spec.
pub fn groups<'p>(context: &'p Context<'_>) -> Vec<Group<'p>> {
    let package = &context.package;
    let model = context.model();
    let is_table = |name: &str| package.tables.iter().any(|table| table.name == name);
    let space = free(&["groups", "command_groups"], is_table);
    let mut groups: Vec<Group<'p>> = Vec::new();
    for group in &model.groups {
        let operations: Vec<&Operation> = model
            .operations
            .iter()
            .filter(|operation| operation.group == group.id)
            .collect();
        if operations.is_empty() {
            continue;
        }
        let calls = |kind: Kind| {
            let operations = operations.iter().filter(|it| it.kind() == kind);
            operations.filter_map(|it| package.call(it)).collect()
        };
        let stem = Case::Pascal.apply(&group.id);
        let stem = free(&[&stem], |stem| groups.iter().any(|it| it.stem == stem));
        groups.push(Group {
            id: &group.id,
            stem,
            space: space.clone(),
            commands: calls(Kind::Command),
            reports: calls(Kind::Report),
            operations,
            taken: package.items().map(|item| &*item.ty.name).collect(),
        });
    }
    groups
}

/// The groups whose operations are in a header.
pub fn of_header<'g, 'p>(
    groups: &'g [Group<'p>],
    header: &Header<'_, '_>,
    homes: &BTreeMap<&str, &str>,
) -> Vec<&'g Group<'p>> {
    let is_here = |group: &&Group<'_>| homes.get(group.id) == Some(&header.id);
    groups.iter().filter(is_here).collect()
}

/// What the header has of its groups beside their messages.
pub fn declare(
    out: &mut Source,
    includes: &mut Includes,
    context: &Context<'_>,
    groups: &[&Group<'_>],
) {
    let Some(first) = groups.first() else {
        return;
    };
    includes.standard("vector");
    includes.own("fc_runtime/protocol.hpp");
    let space = &namespace(context);
    out.blank();
    out.namespace(&format!("{space}::{}", first.space), |out| {
        for group in groups {
            out.blank();
            if !group.commands.is_empty() {
                includes.standard("optional");
                includes.standard("string_view");
                includes.own("fc_runtime/typed.hpp");
                includes.own("fc_runtime/types.hpp");
                client::calls(out, context, group);
                out.blank();
                robot::handlers(out, context, group);
                out.blank();
                robot::defaults(out, group);
                out.blank();
            }
            if !group.reports.is_empty() {
                includes.standard("optional");
                includes.own("fc_runtime/push.hpp");
                includes.own("fc_runtime/types.hpp");
                robot::reporters(out, context, group);
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

/// What the source has of them.
pub fn define(out: &mut Source, context: &Context<'_>, groups: &[&Group<'_>]) {
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
