//! A group as a folder of the package, with one file for each kind of content.
//!
//! A command, a report or a stream appears only in the files of its group. The files above the groups list only groups.

use super::context::{Context, own, spelled};
use super::root;
use super::source::{Source, head, nothing};
use crate::package::items::{Item, Spelled};
use crate::package::language::{Role, TYPESCRIPT};
use crate::package::process::set_off;
use fc_spec::model::{Direction, Field, TypeRef};

pub use crate::package::group::Group;

/// The kinds of content that a group may have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// Commands that have a code.
    Commands,
    /// Types with an optional field whose absence has a meaning.
    Defaults,
    /// Any content that a program names.
    Messages,
    /// Reports that have a code.
    Reports,
    /// Streams that the robot sends.
    RobotStreams,
    /// Streams that have a code.
    Streams,
    Types,
}

impl<'p, 'm> Group<'p, 'm> {
    pub fn items(&self) -> &'p [Item<'m>] {
        self.types
    }

    pub fn has(&self, what: What) -> bool {
        match what {
            What::Commands => !self.commands.is_empty(),
            What::Defaults => self.items().iter().flat_map(Item::fields).any(has_default),
            What::Messages => {
                let others = [What::Types, What::Commands, What::Reports, What::Streams];
                others.into_iter().any(|other| self.has(other))
            }
            What::Reports => !self.reports.is_empty(),
            What::RobotStreams => self.subscribed().next().is_some(),
            What::Streams => !self.streams.is_empty(),
            What::Types => !self.types.is_empty(),
        }
    }

    /// Returns the name of the type for a part of the stubs: `IdentityCalls` for `calls`.
    pub fn part(&self, context: &Context<'_>, word: &str) -> String {
        match TYPESCRIPT.spelling(Role::Type, &format!("{}_{word}", self.id)) {
            Ok(name) if !root::has(&name) => own(context, &name),
            Ok(name) | Err(name) => [&*name, "$"].concat(),
        }
    }

    /// Returns the local name of an import from the group: `identityCommands` for `commands`.
    pub fn variable(&self, word: &str) -> String {
        spelled(Role::Method, &format!("{}_{word}", self.id))
    }

    /// Writes the group's part of a class as an interface with these members. Without members it writes no interface.
    ///
    /// The template with the name of the part is its comment.
    pub fn interface<T>(
        &self,
        out: &mut Source,
        context: &Context<'_>,
        word: &str,
        members: &[T],
        member: impl Fn(&mut Source, &T),
    ) {
        if members.is_empty() {
            return;
        }
        out.template(word, &[]);
        let name = self.part(context, word);
        out.block(format!("export interface {name}"), |out| {
            for one in members {
                out.blank();
                member(out, one);
            }
        });
    }

    /// Returns the types that the operations of the group name.
    pub fn bodies(&self, context: &'p Context<'m>) -> Vec<&'p TypeRef> {
        let calls = self.commands.iter().chain(&self.reports);
        let calls = calls.flat_map(|call| {
            let messages = call.operation.messages().into_iter();
            let bodies = messages.flat_map(|it| [&*it.request.ty, &*it.response.ty]);
            let reports = set_off(context, call.operation);
            bodies.chain(reports.map(|(_, _, messages)| &*messages.request.ty))
        });
        let streams = self.streams.iter();
        let streams = streams.filter_map(|it| Some(&*it.of.body(Direction::Request)?.ty));
        calls.chain(streams).collect()
    }
}

/// Returns `true` if the absence of a field has a meaning.
pub fn has_default(field: &Spelled<'_, Field>) -> bool {
    field.details().default.is_some()
}

/// Generates a module that re-exports the files of one kind from all groups.
pub fn index(
    context: &Context<'_>,
    about: [&str; 2],
    groups: &[Group<'_, '_>],
    file: &str,
    what: What,
) -> String {
    let mut out = head(context, about);
    let mut names: Vec<&str> = groups
        .iter()
        .filter(|it| it.has(what))
        .map(|it| it.name)
        .collect();
    if names.is_empty() {
        return nothing(out);
    }
    names.sort_unstable();
    for name in names {
        out.line(format!("export * from './groups/{name}/{file}.ts'"));
    }
    out.finish()
}

/// Returns the names of the groups' interfaces for one part. Groups without this part are omitted.
pub fn parts(
    context: &Context<'_>,
    groups: &[Group<'_, '_>],
    word: &str,
    what: What,
) -> Vec<String> {
    let groups = groups.iter().filter(|it| it.has(what));
    let parts = groups.map(|it| format!("messages.{}", it.part(context, word)));
    parts.collect()
}

/// Returns the start of an interface that extends `parts`, up to its brace.
pub fn extending(out: &Source, name: &str, parts: &[String]) -> String {
    let open = format!("export interface {name}");
    if parts.is_empty() {
        return open;
    }
    let flat = format!("{open} extends {}", parts.join(", "));
    if out.has_room([&flat, " {}"]) {
        return flat;
    }
    format!("{open}\n  extends {}", parts.join(",\n    "))
}

/// Writes an interface that gives the class with the same name the methods of `parts`.
pub fn merged(out: &mut Source, name: &str, [zh, en]: [&str; 2], parts: &[String]) {
    out.template("methods", &[("zh", zh), ("en", en)]);
    out.line([&extending(out, name, parts), " {}"].concat());
    out.blank();
}
