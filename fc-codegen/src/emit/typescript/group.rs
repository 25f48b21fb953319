//! What the package has of a group of the spec: a folder with a file for each kind of thing. A command, a report or a
//! stream is in the files of its group alone; the files that all groups share name groups.

use super::context::{Context, own, spelled};
use super::root;
use super::source::{Source, head, nothing};
use crate::emit::stub::process::set_off;
use crate::surface::language::{Role, TYPESCRIPT};
use crate::surface::package::{Call, Item, Module, Spelled};
use fc_spec::model::{self, Direction, Field, Operation, Side, TypeRef};
use std::borrow::Cow;

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

/// A group, or the types that several groups share.
pub struct Group<'p, 'm> {
    /// Id, of which names are made.
    pub id: &'p str,
    /// What its folder is called.
    pub name: Cow<'p, str>,
    /// The file of the spec.
    pub from: &'p str,
    /// Its message types, if it has any.
    pub module: Option<&'p Module<'m>>,
    /// The commands that have a code.
    pub commands: Vec<Call<'p>>,
    /// The reports that have a code.
    pub reports: Vec<Call<'p>>,
    /// The streams that have a code.
    pub streams: Vec<&'p Spelled<'m, Operation>>,
}

impl<'p, 'm> Group<'p, 'm> {
    /// Those of a package that have anything, in the order of the spec; what several share is the last.
    pub fn all(context: &'p Context<'m>) -> Vec<Self> {
        let package = &context.package;
        let modules = &package.modules;
        let groups = context.model().groups.iter().map(|group| {
            let module = modules
                .iter()
                .find(|it| it.group.is_some_and(|it| it.id == group.id));
            Self {
                id: &group.id,
                name: module.map_or_else(
                    || Cow::Owned(spelled(Role::Module, &group.id)),
                    |it| Cow::Borrowed(&*it.name),
                ),
                from: &group.location.file,
                module,
                commands: of_group(context.commands(), &group.id),
                reports: of_group(context.reports(), &group.id),
                streams: package
                    .streams
                    .iter()
                    .filter(|it| it.group == group.id)
                    .collect(),
            }
        });
        let shared = modules.iter().filter(|it| it.group.is_none());
        let shared = shared.map(|module| Self {
            id: &module.id,
            name: Cow::Borrowed(&*module.name),
            from: module
                .items
                .first()
                .map_or("the spec", |it| &it.ty.location.file),
            module: Some(module),
            commands: Vec::new(),
            reports: Vec::new(),
            streams: Vec::new(),
        });
        groups
            .chain(shared)
            .filter(|it| it.has(What::Messages))
            .collect()
    }

    /// What it is in the spec; `None` for what several groups share.
    pub fn titled(&self, context: &Context<'m>) -> Option<&'m model::Group> {
        let mut groups = context.model().groups.iter();
        let shared = self.module.is_some_and(|it| it.group.is_none());
        groups.find(|group| !shared && group.id == self.id)
    }

    pub fn items(&self) -> &'p [Item<'m>] {
        self.module.map_or(&[], |module| &module.items)
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
            What::RobotStreams => !self.robot_streams().is_empty(),
            What::Streams => !self.streams.is_empty(),
            What::Types => self.module.is_some(),
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

    pub fn robot_streams(&self) -> Vec<&'p Spelled<'m, Operation>> {
        let streams = self.streams.iter().copied();
        streams.filter(|it| it.sender == Side::Robot).collect()
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

fn of_group<'p>(mut calls: Vec<Call<'p>>, id: &str) -> Vec<Call<'p>> {
    calls.retain(|call| call.operation.group == id);
    calls
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
        .map(|it| &*it.name)
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
