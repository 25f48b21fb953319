//! `groups/….py`: the types of a group, its operations as values, and its part of each stub.

use super::client;
use super::messages;
use super::modules::{GroupPart, ModulePlan, NamedGroup, Used};
use super::operations::{self, constant};
use super::robot;
use super::source::{Python, exported};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::group::Group;
use crate::package::source::Source;

/// Generates the file of a group, and of the groups that share the file because of an import cycle.
pub fn group_file(
    context: &Context<'_>,
    plan: &ModulePlan<'_, '_>,
    home: &Group<'_, '_>,
) -> String {
    let groups = plan.members(home);
    let items: Vec<_> = groups.iter().flat_map(|group| group.types).collect();
    let mut used = Used::default();
    let mut body = context.source();
    messages::types(&mut body, &mut used, context, &items);
    if groups.iter().any(|group| !group.operations.is_empty()) {
        operations::values(&mut body, context, &groups);
    }
    for group in &groups {
        client::any_report(&mut body, group);
    }
    for group in &groups {
        stubs(&mut body, context, group);
        uses(&mut used, context, group);
    }

    let operations = groups.iter().flat_map(|group| &group.operations);
    let operations: Vec<String> = operations.map(|it| constant(context, it)).collect();
    let mut names = messages::names(context, &items);
    names.extend(operations.iter().map(String::as_str));
    let mut docs = Docs::default();
    for group in &groups {
        about::group(&mut docs, group.of);
    }
    let mut out = context.source();
    out.docstring(&docs);
    used.imports(&mut out, context, plan, home);
    out.blank();
    exported(&mut out, &names);
    out.blank();
    out.append(&body);
    out.finish()
}

/// Writes the group's part of each public class.
fn stubs(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    client::calls(out, context, group);
    client::sync_calls(out, context, group);
    client::streams(out, context, group);
    robot::handlers(out, context, group);
    robot::partial_handlers(out, group);
    robot::reporter(out, context, group);
    robot::streamer(out, context, group);
}

/// Adds the imports of the stubs and of the operations.
fn uses<'p>(used: &mut Used<'p>, context: &'p Context<'_>, group: &NamedGroup<'_, 'p>) {
    for operation in &group.operations {
        used.library("typing", "Final");
        used.operation(context, operation);
    }
    if group.part(GroupPart::AnyReport).is_some() {
        used.library("typing", "TypeAlias");
    }
    if group.part(GroupPart::Handlers).is_some() {
        used.library("abc", "ABC");
        used.library("abc", "abstractmethod");
    }
}

/// Writes a class with the group's part of another class, if the group has the part.
///
/// `about` contains the name of that class and its members in both languages: `["Client", "指令", "commands"]`.
pub fn part_of(
    out: &mut Source,
    group: &NamedGroup<'_, '_>,
    part: GroupPart,
    base: &str,
    about: [&str; 3],
    body: impl FnOnce(&mut Source),
) {
    let Some(name) = group.part(part) else {
        return;
    };
    let (id, [class, zh, en]) = (group.id, about);
    let zh = format!("`{class}` 的一部分：`{id}` 组的{zh}。");
    let en = format!("Part of `{class}`: the {en} of the group `{id}`.");
    let docs = Docs::said([zh, en]);
    out.gap();
    out.suite(&format!("class {name}({base})"), |out| {
        out.docstring(&docs);
        body(out);
    });
}
