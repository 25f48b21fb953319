//! The file of a group: all that the package has of its operations, so that a command more is a change of this file alone.
//!
//! What users name, such as `Client`, is made of parts, one of each group. The files of the wholes list groups and know no
//! operation.

use super::text::STYLE;
use super::{client, messages, operations, robot, streams};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::group::Group;
use crate::package::language::{KOTLIN, Role};
use crate::package::source::Source;

/// The part of a class that a group has: `UpperBodyClient` of `Client`.
pub fn part_name(group: &Group<'_, '_>, whole: &str) -> String {
    let (Ok(stem) | Err(stem)) = KOTLIN.spelling(Role::Type, group.id);
    [&stem, whole].concat()
}

/// An interface with the part of `whole` that a group has.
pub fn part_of(
    out: &mut Source,
    group: &Group<'_, '_>,
    whole: &str,
    head: &str,
    body: impl FnOnce(&mut Source),
) {
    let mut docs = Docs::default();
    if let Some(of) = group.of {
        docs.paragraph(format!("{}：`{whole}` 中的一部分。", of.title.zh));
        docs.paragraph(format!("{}: its part of `{whole}`.", of.title.en));
    }
    out.documented(&docs);
    out.block(["public interface ", head].concat(), body);
}

/// The file of a group, or of the types that several share.
pub fn group_file(context: &Context<'_>, group: &Group<'_, '_>) -> Source {
    let mut out = Source::new(&STYLE);
    operations::part(&mut out, context, group);
    client::part(&mut out, context, group);
    robot::part(&mut out, context, group);
    streams::part(&mut out, context, group);
    messages::types(&mut out, context, group.types);
    out
}

/// The parts of a class that those groups have for which it is not empty.
pub fn parts(
    groups: &[Group<'_, '_>],
    whole: &str,
    has: impl Fn(&Group<'_, '_>) -> bool,
) -> Vec<String> {
    let groups = groups.iter().filter(|group| has(group));
    groups.map(|group| part_name(group, whole)).collect()
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
