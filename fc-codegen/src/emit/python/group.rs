//! `groups/….py`: all that there is of a group. Its types, its operations as values, and its part of each stub.

use super::client;
use super::homes::{Group, Homes, Part, Piece, Used};
use super::messages;
use super::operations::{self, constant};
use super::robot;
use super::source::{PYTHON, Python, exported};
use crate::emit::stub::about;
use crate::emit::stub::context::Context;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::source::Source;
use crate::sample::Samples;

/// The file that is the home of this part, and of those that cannot be parted from it.
pub fn file(
    context: &Context<'_>,
    samples: &Samples<'_>,
    homes: &Homes<'_>,
    home: &Part<'_>,
) -> String {
    let parts = homes.members(home);
    let items: Vec<_> = parts.iter().flat_map(|part| part.items).collect();
    let groups: Vec<_> = parts.iter().filter_map(|it| it.group.as_ref()).collect();
    let mut used = Used::default();
    let mut body = Source::new(&PYTHON);
    messages::types(&mut body, &mut used, context, samples, &items);
    if groups.iter().any(|group| !group.operations.is_empty()) {
        operations::values(&mut body, context, samples, &groups);
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
    for part in &parts {
        about::group(&mut docs, part.group.as_ref().map(|group| group.of));
    }
    let mut out = Source::new(&PYTHON);
    out.docstring(&docs);
    used.imports(&mut out, context, homes, home);
    out.blank();
    exported(&mut out, &names);
    out.blank();
    out.append(&body);
    out.finish()
}

/// What a group has of the classes that a user names.
fn stubs(out: &mut Source, context: &Context<'_>, group: &Group<'_>) {
    client::calls(out, context, group);
    client::sync_calls(out, context, group);
    client::streams(out, context, group);
    robot::handlers(out, context, group);
    robot::partial_handlers(out, group);
    robot::reporter(out, context, group);
    robot::streamer(out, context, group);
}

/// What these and the operations of the group have to import.
fn uses<'m>(used: &mut Used<'m>, context: &'m Context<'_>, group: &Group<'m>) {
    for operation in &group.operations {
        used.library("typing", "Final");
        used.operation(context, operation);
    }
    if group.name(Piece::AnyReport).is_some() {
        used.library("typing", "TypeAlias");
    }
    if group.name(Piece::Handlers).is_some() {
        used.library("abc", "ABC");
        used.library("abc", "abstractmethod");
    }
}

/// A class with what a group has of another.
pub fn part_of(
    out: &mut Source,
    name: &str,
    base: &str,
    about: [String; 2],
    body: impl FnOnce(&mut Source),
) {
    let [zh, en] = about;
    let mut docs = Docs::default();
    docs.paragraph(zh);
    docs.paragraph(en);
    out.gap();
    out.suite(&format!("class {name}({base})"), |out| {
        out.docstring(&docs);
        body(out);
    });
}
