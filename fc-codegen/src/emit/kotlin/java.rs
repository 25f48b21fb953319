//! The robot's side for Java: interfaces whose handlers return futures.
//!
//! Java cannot implement the suspending methods of `Robot`.

use super::client::for_java;
use super::group::{heading, part_name, part_of, parts};
use super::robot::{has_commands, registration};
use crate::package::docs::Docs;
use crate::package::group::Group;
use crate::package::items::Call;
use crate::package::source::Source;
use fc_spec::model::CodeRange;

/// Writes the complete robot and the partial one. `ranges` are the codes with a shared method, `unknown` is the method
/// of all other codes.
pub fn robots(
    out: &mut Source,
    groups: &[Group<'_, '_>],
    ranges: &[(String, &CodeRange)],
    unknown: &str,
) {
    out.template("async_robot", &[]);
    let handlers = parts(groups, "AsyncHandlers", has_commands);
    out.block(heading("public interface AsyncRobot", &handlers), |out| {
        for name in ranges.iter().map(|it| &*it.0).chain([unknown]) {
            out.documented(&Docs::linked(format!("[Robot.{name}]")));
            out.line(format!(
                "public fun {name}(context: Context, request: RawRequest): CompletionStage<Json> ="
            ));
            out.line("    throw context.unknown()");
        }
    });
    for_java(out, "PartialRobot");
    let partial = parts(groups, "AsyncPartial", has_commands);
    let supers: Vec<String> = [vec!["AsyncRobot".to_owned()], partial].concat();
    out.line(heading("public interface PartialAsyncRobot", &supers));
    for_java(out, "Robot.service");
    out.enclose("public fun AsyncRobot.service(): Service =", "", |out| {
        out.line("Service()");
        for group in groups.iter().filter(|it| has_commands(it)) {
            out.line(format!("    .{}(this)", registration(group)));
        }
        for (name, range) in ranges {
            let (first, last) = (&range.first_spelling, &range.last_spelling);
            out.line(format!("    .onRangeAsync({first}, {last}, ::{name})"));
        }
        out.line(format!("    .onUnknownAsync(::{unknown})"));
    });
}

/// Writes a group's part of both robots, and the registration of its handlers.
pub fn part(out: &mut Source, group: &Group<'_, '_>) {
    let [name, partial, of] =
        ["AsyncHandlers", "AsyncPartial", "Handlers"].map(|it| part_name(group, it));
    part_of(out, group, "AsyncRobot", &name, |out| {
        for command in &group.commands {
            for_java(out, &format!("{of}.{}", command.method));
            out.line(signature("public fun", command));
        }
    });
    let head = format!("{partial} : {name}");
    part_of(out, group, "PartialAsyncRobot", &head, |out| {
        for command in &group.commands {
            out.blank();
            let head = signature("override fun", command);
            out.enclose(&[&head, " ="].concat(), "", |out| {
                out.line("throw context.notImplemented()");
            });
        }
    });
    out.blank();
    out.line("@JvmSynthetic");
    let head = format!(
        "internal fun Service.{}(robot: {name}): Service = apply",
        registration(group)
    );
    out.block(head, |out| {
        for Call { method, .. } in &group.commands {
            out.line(format!("onAsync(Operations.{method}, robot::{method})"));
        }
    });
}

fn signature(head: &str, command: &Call<'_>) -> String {
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    format!(
        "{head} {}(context: Context, request: {request}): CompletionStage<{response}>",
        command.method
    )
}
