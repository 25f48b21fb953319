//! What the package has of a group of the spec: a folder with a file for each kind of thing. A command, a report or a
//! stream is in the files of its group alone; the files that all groups share name groups.

use super::context::{Context, own, spelled};
use super::root;
use super::source::{Source, head, nothing};
use crate::package::items::{Item, Spelled};
use crate::package::language::{Role, TYPESCRIPT};
use crate::package::process::set_off;
use fc_spec::model::{Direction, Field, TypeRef};

pub use crate::package::group::Group;

/// What a group may have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// Commands that have a code.
    Commands,
    /// Types of which a field may be absent and means something then.
    Defaults,
    /// Anything that a program names.
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

    /// What a type of the package is called that has a part of the stubs: `IdentityCalls` of `calls`.
    pub fn part(&self, context: &Context<'_>, word: &str) -> String {
        match TYPESCRIPT.spelling(Role::Type, &format!("{}_{word}", self.id)) {
            Ok(name) if !root::has(&name) => own(context, &name),
            Ok(name) | Err(name) => [&*name, "$"].concat(),
        }
    }

    /// What a file calls what it imports of it: `identityCommands` of `commands`.
    pub fn variable(&self, word: &str) -> String {
        spelled(Role::Method, &format!("{}_{word}", self.id))
    }

    /// Its part of something that a user names: an interface with a member for each of these, if there are any.
    pub fn interface<T>(
        &self,
        out: &mut Source,
        context: &Context<'_>,
        [word, about]: [&str; 2],
        members: &[T],
        member: impl Fn(&mut Source, &T),
    ) {
        if members.is_empty() {
            return;
        }
        out.blank();
        out.line(about);
        let name = self.part(context, word);
        out.block(format!("export interface {name}"), |out| {
            for one in members {
                out.blank();
                member(out, one);
            }
        });
    }

    /// The types that its operations name.
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

/// Whether the absence of a field means something.
pub fn has_default(field: &Spelled<'_, Field>) -> bool {
    field.details().default.is_some()
}

/// The files of one kind of all groups that have one, as one module.
pub fn index(about: [&str; 2], groups: &[Group<'_, '_>], file: &str, what: What) -> String {
    let mut out = head(about);
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

/// What stands behind the name of an interface that has the parts of groups, with those groups that have it.
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

/// The beginning of an interface that extends these, up to its brace.
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

/// An interface that gives the class of the same name the methods of these.
pub fn merged(out: &mut Source, name: &str, about: &str, parts: &[String]) {
    out.blank();
    out.line(about);
    out.line([&extending(out, name, parts), " {}"].concat());
    out.blank();
}
