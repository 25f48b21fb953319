//! The robot's side: complete, partial and example robots, and typed reports and streams.

use super::group::{heading, part_name, part_of, parts, wrapper};
use super::java;
use super::streams::{self, SERVER, SERVER_DOCS};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::group::Group;
use crate::package::items::Call;
use crate::package::language::{KOTLIN, Role};
use crate::package::ranges::{UNKNOWN, pass_through};
use crate::package::source::Source;

/// Generates `Robot.kt`.
pub fn robot_file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> Source {
    let mut out = context.source();
    let handlers = parts(groups, "Handlers", has_commands);
    let ranges = pass_through(context).into_iter();
    let ranges: Vec<_> = ranges
        .map(|(words, range)| (KOTLIN.spelled(Role::Function, &words).into_owned(), range))
        .collect();
    let unknown = KOTLIN.spelled(Role::Function, UNKNOWN);
    let mut docs = Docs::said([
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。只实现了一部分指令的机器人，改为实现 `PartialRobot`。",
        "A complete robot, which handles all commands of the spec. When the spec gains a command, the compiler reports a missing method. A robot with some of the commands implements `PartialRobot`, which refuses the others as not implemented.",
    ]);
    docs.both([
        "处理超时或断线之后，调用方不再等待响应。运动指令和影响不详的指令，处理程序仍运行到结束，可以查看 `Context.isAbandoned`；其他指令的处理程序被取消。",
        "After a timeout or a loss, the caller does not wait for the response any more. The handler of a command that moves the robot, or with an unknown effect, runs to its end and can check `Context.isAbandoned`. The handler of any other command is cancelled.",
    ]);
    out.docs(&docs);
    out.block(heading("public interface Robot", &handlers), |out| {
        for (name, range) in &ranges {
            raw(out, name, &about::refused(Some(range)));
        }
        raw(out, &unknown, &about::refused(None));
    });
    let partial = robot_and(parts(groups, "Partial", has_commands).into_iter());
    let partial = heading("public interface PartialRobot", &partial);
    let values = [("partial", &*partial), ("example", &example(groups))];
    out.template("robots", &values);
    out.enclose("public fun Robot.service(): Service =", "", |out| {
        out.line("Service()");
        for group in groups.iter().filter(|it| has_commands(it)) {
            out.line(format!("    .{}(this)", registration(group)));
        }
        for (name, range) in &ranges {
            let (first, last) = (&range.first_spelling, &range.last_spelling);
            out.line(format!(
                "    .onRange({first}, {last}) {{ context, request -> {name}(context, request) }}"
            ));
        }
        out.line(format!(
            "    .onUnknown {{ context, request -> {unknown}(context, request) }}"
        ));
    });
    java::robots(&mut out, groups, &ranges, &unknown);
    reporter(&mut out, groups);
    streams::for_robot(&mut out, groups);
    out
}

/// Returns `true` for a group with commands.
pub fn has_commands(group: &Group<'_, '_>) -> bool {
    !group.commands.is_empty()
}

/// Returns `Robot` and these parts, as supertypes.
fn robot_and(parts: impl Iterator<Item = String>) -> Vec<String> {
    let robot = "Robot".to_owned();
    std::iter::once(robot).chain(parts).collect()
}

/// Returns the name of the function that registers a group's commands with a service.
pub fn registration(group: &Group<'_, '_>) -> String {
    ["on", &*part_name(group, "")].concat()
}

/// Writes a group's part of the robot's side.
pub fn part(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    if has_commands(group) {
        handlers(out, context, group);
        served(out, group);
        answers(out, group);
        java::part(out, group);
    }
    if !group.reports.is_empty() {
        reports(out, context, group);
    }
}

fn handlers(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    let name = part_name(group, "Handlers");
    part_of(out, group, "Robot", &name, |out| {
        for command in &group.commands {
            let mut docs = facts::method_docs(context, command.operation, |_| ());
            docs.raw("@throws fc.runtime.Refusal to respond with a result other than success");
            out.documented(&docs);
            out.line(signature("public suspend fun", command));
        }
    });
    let head = format!("{} : {name}", part_name(group, "Partial"));
    part_of(out, group, "PartialRobot", &head, |out| {
        for command in &group.commands {
            out.blank();
            let head = signature("override suspend fun", command);
            out.enclose(&[&head, " ="].concat(), "", |out| {
                out.line("throw context.notImplemented()");
            });
        }
    });
}

fn served(out: &mut Source, group: &Group<'_, '_>) {
    out.blank();
    let (registration, handlers) = (registration(group), part_name(group, "Handlers"));
    out.line("@JvmSynthetic");
    let head = format!("internal fun Service.{registration}(robot: {handlers}): Service = apply");
    out.block(head, |out| {
        for Call { method, .. } in &group.commands {
            let open = format!("on(Operations.{method}) {{ context, request ->");
            let body = format!("robot.{method}(context, request)");
            out.line_or([&open, " ", &body, " }"], |out| {
                out.enclose(&open, "}", |out| out.line(&body));
            });
        }
    });
}

/// Writes a method for requests without a type. The default refuses them.
fn raw(out: &mut Source, name: &str, docs: &Docs<'_>) {
    out.documented(docs);
    out.line(format!(
        "public suspend fun {name}(context: Context, request: RawRequest): Json ="
    ));
    out.line("    throw context.unknown()");
}

/// Returns the head of the robot that responds with the spec's examples.
fn example(groups: &[Group<'_, '_>]) -> String {
    let groups = groups.iter().filter(|it| has_commands(it));
    let answers = groups.map(|group| {
        let [handlers, example] = ["Handlers", "Example"].map(|whole| part_name(group, whole));
        format!("{handlers} by {example}(pretendMotion)")
    });
    let head = "public open class ExampleRobot(pretendMotion: Boolean = false)";
    heading(head, &robot_and(answers))
}

/// Writes the class that responds to a group's commands with the spec's examples.
fn answers(out: &mut Source, group: &Group<'_, '_>) {
    let name = part_name(group, "Example");
    let head = format!("internal class {name}(pretendMotion: Boolean)");
    let supers = [
        "ExampleAnswers(pretendMotion)".to_owned(),
        part_name(group, "Handlers"),
    ];
    out.blank();
    out.block(heading(&head, &supers), |out| {
        for command in &group.commands {
            let response = &command.response.ty.name;
            out.blank();
            let head = signature("override suspend fun", command);
            out.enclose(&[&head, " ="].concat(), "", |out| {
                out.line(if command.may_move() {
                    format!("pretended(context, {response})")
                } else {
                    format!("{response}.example()")
                });
            });
        }
    });
}

fn signature(head: &str, command: &Call<'_>) -> String {
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    format!(
        "{head} {}(context: Context, request: {request}): {response}",
        command.method
    )
}

fn reporter(out: &mut Source, groups: &[Group<'_, '_>]) {
    let parts = parts(groups, "Reporter", |it| !it.reports.is_empty());
    out.template("reporter", &[]);
    wrapper(out, "Reporter", SERVER, SERVER_DOCS, &parts);
    out.line(heading(")", &parts));
}

fn reports(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    part_of(
        out,
        group,
        "Reporter",
        &part_name(group, "Reporter"),
        |out| {
            out.docs(&Docs::line(SERVER_DOCS));
            out.line(format!("public val {SERVER}"));
            for report in &group.reports {
                let mut docs = facts::method_docs(context, report.operation, |_| ());
                docs.raw("@throws fc.runtime.PushError if it could not be queued");
                let (method, ty) = (report.method, &report.request.ty.name);
                out.documented(&docs);
                out.template("push", &[("method", method), ("ty", ty)]);
            }
        },
    );
}
