//! Samples that call and answer each operation, for the documentation's pages.
//!
//! `Samples.kt` among the tests of the package contains the same text, so no sample can become invalid.

use super::client::is_bare;
use super::expr::{Form, laid_out};
use super::method_of;
use super::text::{STYLE, literal};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::expr::{Expr, Record};
use crate::package::language::{KOTLIN, Role};
use crate::package::name::free;
use crate::package::samples::{BYTES, PAGE_WIDTH, Sample, SampleRun, SampleStep, SampleTab, Verb};
use crate::package::source::Source;
use crate::package::style::Style;
use fc_spec::model::Type;

/// The style of Kotlin on a page.
static ON_PAGES: Style = Style {
    width: PAGE_WIDTH,
    ..STYLE
};

/// The Kotlin samples on the pages.
pub const TAB: SampleTab = SampleTab {
    fence: "kotlin",
    file: "generated/src/test/kotlin/Samples.kt",
    language: &KOTLIN,
    style: &ON_PAGES,
    write,
};

/// The additional imports of the samples.
pub const IMPORTED: &[&str] = &[
    "kotlinx.coroutines.CoroutineStart.UNDISPATCHED",
    "kotlinx.coroutines.coroutineScope",
    "kotlinx.coroutines.flow.filterIsInstance",
    "kotlinx.coroutines.flow.map",
    "kotlinx.coroutines.launch",
];

fn write(out: &mut Source, context: &Context<'_>, sample: &Sample<'_, '_>) {
    match sample {
        Sample::Call(call, request) => {
            let method = call.method;
            let is_empty = request.members.iter().all(|(_, value)| value.is_none());
            if is_empty && is_bare(call.request) {
                out.line(format!("val answer = client.{method}()"));
            } else {
                assign(out, "val request = ", request);
                out.line(format!("val answer = client.{method}(request)"));
            }
            out.line("println(answer)");
        }
        Sample::Take(call) => {
            let ty = &call.request.ty.name;
            out.enclose("client.reports().use { reports ->", "}", |out| {
                out.enclose("reports.asFlow()", "", |out| {
                    out.line(format!(
                        ".map {{ it.message }}\n.filterIsInstance<{ty}>()\n.collect {{ println(it) }}"
                    ));
                });
            });
        }
        Sample::Answer(call, answer) => {
            let parameters = [
                "context: Context".to_owned(),
                format!("request: {}", call.request.ty.name),
            ];
            let open = format!("override suspend fun {}(", call.method);
            let close = format!("): {} {{", call.response.ty.name);
            out.list(&open, &parameters, &close);
            out.enclose("", "}", |out| {
                out.line("println(\"${context.peer} asks: $request\")");
                assign(out, "return ", answer);
            });
        }
        Sample::Push(call, report) => {
            assign(out, "val report = ", report);
            let push = format!("reporter.{}(Audience.ALL, report)", call.method);
            out.block(format!("for (acknowledgement in {push})"), |out| {
                out.line("println(acknowledgement)");
            });
        }
        Sample::Subscribe(stream) => {
            let shown = match context.content(stream) {
                Some(_) => "${item.content}",
                None => "${item.content.size} bytes",
            };
            let name = method_of(stream);
            let open = format!("streams.subscribe{name}().use {{ items ->");
            out.enclose(&open, "}", |out| {
                out.line(format!(
                    "items.asFlow().collect {{ item -> println(\"${{item.id}}: {shown}\") }}"
                ));
            });
        }
        Sample::Send(stream, value) => {
            assign_content(out, value.as_ref());
            out.line(format!("streams.send{}(1, content)", method_of(stream)));
        }
        Sample::Stream(stream, value) => {
            assign_content(out, value.as_ref());
            let name = method_of(stream);
            out.line(format!(
                "val taken = streamer.send{name}(Audience.ALL, 1, content)"
            ));
            out.line("println(\"$taken data connections took it\")");
        }
    }
}

/// Writes `val content = …`.
fn assign_content(out: &mut Source, value: Option<&Record<'_>>) {
    match value {
        Some(value) => assign(out, "val content = ", value),
        None => out.line(format!("val content = {}.toByteArray()", literal(BYTES))),
    }
}

/// Writes `before` and a message in the form of handwritten code.
fn assign(out: &mut Source, before: &str, message: &Record<'_>) {
    let message = Expr::Record(message.clone());
    laid_out(out, before, &message, &Type::Json, "", Form::Block);
}

/// Writes a robot that responds with the samples.
fn robot(out: &mut Source, context: &Context<'_>, run: &SampleRun<'_, '_>) {
    let is_there = |name: &str| context.package.has_type(name);
    let name = free(&["SampleRobot", "RobotOfTheSamples"], is_there);
    out.docs(&Docs::said([
        "用文档中的示例响应全部指令。",
        "Responds to every command with the samples of the documentation.",
    ]));
    let head = format!("internal class {name} : Robot");
    if !run.has(Verb::Call) {
        out.line(head);
        return;
    }
    out.block(head, |out| {
        for answer in run.answers() {
            out.blank();
            write(out, context, &answer);
        }
    });
}

/// Generates all samples, and a function that runs them.
#[must_use]
pub fn samples_file(context: &Context<'_>) -> Source {
    let run = &SampleRun::build(context);
    let mut out = context.source();
    robot(&mut out, context, run);
    for (step, sample) in run.samples() {
        let [name, ty] = step.parameter();
        let function = function_name(step);
        let head = format!("private suspend fun {function}({name}: {ty})");
        out.blank();
        out.block(head, |out| write(out, context, &sample));
    }
    out.documented(&Docs::said([
        "运行全部示例，最后关闭 `client`；`server` 是它连接的机器人。",
        "Runs all samples, and closes `client` at the end. `server` is the robot of the connection.",
    ]));
    let parameters = "client: Client, server: Server";
    out.block(
        format!("internal suspend fun runSamples({parameters}): Unit = coroutineScope"),
        |out| {
            for step in run.that(Verb::Call) {
                out.line(call(step));
            }
            if run.has(Verb::Take) {
                for step in run.that(Verb::Take) {
                    out.line(launched(step));
                }
                out.line("val reporter = Reporter(server)");
                for step in run.that(Verb::Push) {
                    out.line(call(step));
                }
            }
            if run.has_streams() {
                out.line("val data = client.data()\ndata.connected()\nval streams = Streams(data)");
            }
            if run.has(Verb::Subscribe) {
                let subscribed: Vec<String> = run.that(Verb::Subscribe).map(launched).collect();
                out.lines("val subscribed = listOf(", &subscribed, ")");
                out.line("val streamer = Streamer(server)");
            }
            for step in run.that(Verb::Stream).chain(run.that(Verb::Send)) {
                out.line(call(step));
            }
            if run.has(Verb::Subscribe) {
                out.line("subscribed.forEach { it.cancel() }");
            }
            out.line("client.close()");
        },
    );
    out
}

fn call(step: SampleStep<'_>) -> String {
    let [parameter, _] = step.parameter();
    format!("{}({parameter})", function_name(step))
}

fn launched(step: SampleStep<'_>) -> String {
    format!("launch(start = UNDISPATCHED) {{ {} }}", call(step))
}

fn function_name(step: SampleStep<'_>) -> String {
    KOTLIN.spelled(Role::Function, &step.name()).into_owned()
}
