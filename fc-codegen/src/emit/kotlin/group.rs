//! The file of a group: all that the package has of its operations, so that a command more is a change of this file alone.
//!
//! What users name, such as `Client`, is made of parts, one of each group. The files of the wholes list groups and know no
//! operation.

use super::text::STYLE;
use super::{client, messages, operations, robot, streams};
use crate::emit::stub::context::Context;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::source::Source;
use crate::sample::Samples;
use crate::surface::language::{KOTLIN, Role};
use crate::surface::package::{Call, Module, Spelled};
use fc_spec::model::{self, Operation};

/// A group with what of it has a code.
pub struct Group<'p> {
    /// As the names of its types begin: `UpperBody`.
    pub name: String,
    of: &'p model::Group,
    /// Its commands.
    pub commands: Vec<Call<'p>>,
    /// Its reports.
    pub reports: Vec<Call<'p>>,
    /// Its streams.
    pub streams: Vec<&'p Spelled<'p, Operation>>,
    types: Option<&'p Module<'p>>,
}

/// All groups, in the order of the spec.
pub fn all<'p>(context: &'p Context<'_>) -> Vec<Group<'p>> {
    let (commands, reports) = (context.commands(), context.reports());
    let calls = |all: &[Call<'p>], of: &model::Group| {
        let all = all.iter().copied();
        all.filter(|it| it.operation.group == of.id).collect()
    };
    let groups = context.model().groups.iter().map(|of| {
        let (Ok(name) | Err(name)) = KOTLIN.spelling(Role::Type, &of.id);
        let streams = context.package.streams.iter();
        let mut modules = context.package.modules.iter();
        Group {
            name: name.into_owned(),
            of,
            commands: calls(&commands, of),
            reports: calls(&reports, of),
            streams: streams.filter(|it| it.group == of.id).collect(),
            types: modules.find(|it| it.group.is_some_and(|group| group.id == of.id)),
        }
    });
    groups.collect()
}

impl<'p> Group<'p> {
    /// Its part of a class of the package: `UpperBodyClient` of `Client`.
    pub fn part(&self, whole: &str) -> String {
        [&self.name, whole].concat()
    }

    /// The comment on such a part.
    pub fn docs(&self, whole: &str) -> Docs<'p> {
        let title = &self.of.title;
        let mut docs = Docs::default();
        docs.paragraph(format!("{}：`{whole}` 中的一部分。", title.zh));
        docs.paragraph(format!("{}: its part of `{whole}`.", title.en));
        docs
    }
}

/// Its file.
pub fn file(context: &Context<'_>, samples: &Samples<'_>, group: &Group<'_>) -> Source {
    let mut out = Source::new(&STYLE);
    operations::part(&mut out, context, group);
    client::part(&mut out, context, group);
    robot::part(&mut out, context, group);
    streams::part(&mut out, context, group);
    if let Some(types) = group.types {
        messages::module(&mut out, context, samples, types);
    }
    out
}

/// The parts of a class that those groups have for which it is not empty.
pub fn parts(groups: &[Group<'_>], whole: &str, has: impl Fn(&Group<'_>) -> bool) -> Vec<String> {
    let groups = groups.iter().filter(|group| has(group));
    groups.map(|group| group.part(whole)).collect()
}

/// A class and what it extends, each on a line of its own, so that what a group adds is a line.
pub fn heading(head: &str, supers: &[String]) -> String {
    if supers.is_empty() {
        return head.to_owned();
    }
    let gap = if head == ")" { " : " } else { " :\n    " };
    [head, gap, &supers.join(",\n    ")].concat()
}

/// A class that wraps what its parts work on, up to its body.
pub fn wrapper(out: &mut Source, name: &str, property: &str, docs: &str, parts: &[String]) {
    let modifier = if parts.is_empty() {
        "public"
    } else {
        "override"
    };
    out.enclose(&format!("public class {name}("), "", |out| {
        out.line(docs);
        out.line(format!("{modifier} val {property},"));
    });
}
