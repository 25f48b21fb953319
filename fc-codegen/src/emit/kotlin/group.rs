//! The file of a group, which contains all of its operations. A new command changes only this file.
//!
//! Public classes such as `Client` combine one part from each group. Their files list groups and name no operation.

use super::{client, messages, operations, robot, streams};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::group::Group;
use crate::package::language::{KOTLIN, Role};
use crate::package::source::Source;

/// Returns the name of a group's part of a class: `UpperBodyClient` of `Client`.
pub fn part_name(group: &Group<'_, '_>, whole: &str) -> String {
    [&KOTLIN.spelled(Role::Type, group.id), whole].concat()
}

/// Writes an interface with a group's part of `whole`.
pub fn part_of(
    out: &mut Source,
    group: &Group<'_, '_>,
    whole: &str,
    head: &str,
    body: impl FnOnce(&mut Source),
) {
    let mut docs = Docs::default();
    if let Some(of) = group.of {
        docs.both([
            format!("{}：`{whole}` 中的一部分。", of.title.zh),
            format!("{}: its part of `{whole}`.", of.title.en),
        ]);
    }
    out.documented(&docs);
    out.block(["public interface ", head].concat(), body);
}

/// Generates the file of a group, or of the types that several groups share.
pub fn group_file(context: &Context<'_>, group: &Group<'_, '_>) -> Source {
    let mut out = context.source();
    operations::part(&mut out, context, group);
    client::part(&mut out, context, group);
    robot::part(&mut out, context, group);
    streams::part(&mut out, context, group);
    messages::types(&mut out, context, group.types);
    out
}

/// Returns the parts of a class from those groups that have such a part.
pub fn parts(
    groups: &[Group<'_, '_>],
    whole: &str,
    has: impl Fn(&Group<'_, '_>) -> bool,
) -> Vec<String> {
    let groups = groups.iter().filter(|group| has(group));
    groups.map(|group| part_name(group, whole)).collect()
}

/// Returns a class and its supertypes, each on a separate line.
///
/// A new group therefore adds one line.
pub fn heading(head: &str, supers: &[String]) -> String {
    if supers.is_empty() {
        return head.to_owned();
    }
    let gap = if head == ")" { " : " } else { " :\n    " };
    [head, gap, &supers.join(",\n    ")].concat()
}

/// Writes the head of a class with one property, which its parts use.
pub fn wrapper(out: &mut Source, name: &str, property: &str, about: [&str; 2], parts: &[String]) {
    let modifier = if parts.is_empty() {
        "public"
    } else {
        "override"
    };
    out.enclose(&format!("public class {name}("), "", |out| {
        out.docs(&Docs::line(about));
        out.line(format!("{modifier} val {property},"));
    });
}
