//! How each operation is called and answered, as the pages of the documentation show it. The same text stands in
//! `Samples.kt` among the tests of the package, so no sample can rot.

use super::client::is_bare;
use super::expr::{Form, laid_out};
use super::method_of;
use super::streams::content;
use super::text::{STYLE, literal};
use crate::emit::stub::context::Context;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::samples as stub;
use crate::emit::stub::source::Source;
use crate::emit::stub::style::Style;
use crate::sample::Samples;
use crate::surface::expr::{Expr, Record};
use crate::surface::language::{KOTLIN, Role};
use crate::surface::name::free;
use crate::surface::package::{Call, Spelled};
use fc_spec::model::{Direction, Kind, Operation, Side, Type};

/// Kotlin as it stands on a page.
static ON_PAGES: Style = Style {
    width: stub::PAGE_WIDTH,
    ..STYLE
};

/// How the pages show the package.
pub const SHOWN: stub::Shown = stub::Shown {
    fence: "kotlin",
    file: "generated/src/test/kotlin/Samples.kt",
    language: |_| &KOTLIN,
    style: &ON_PAGES,
    snippets: |context, samples| Box::new(Snippets::new(context, samples)),
};

/// What the samples have from elsewhere besides.
pub const IMPORTED: &[&str] = &[
    "kotlinx.coroutines.CoroutineStart.UNDISPATCHED",
    "kotlinx.coroutines.coroutineScope",
    "kotlinx.coroutines.flow.filterIsInstance",
    "kotlinx.coroutines.flow.map",
    "kotlinx.coroutines.launch",
];

/// What makes the samples of a package.
pub struct Snippets<'p, 'm> {
    context: &'p Context<'m>,
    samples: &'p Samples<'m>,
}

impl stub::Snippets for Snippets<'_, '_> {
    fn app(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_app(&mut out, operation)?;
        Some(out.finish())
    }

    fn robot(&self, operation: &Operation) -> Option<String> {
        let mut out = Source::new(self.context.style);
        self.write_robot(&mut out, operation)?;
        Some(out.finish())
    }
}

impl<'p, 'm> Snippets<'p, 'm> {
    /// Of the Kotlin package, with values from `samples`.
    #[must_use]
    pub fn new(context: &'p Context<'m>, samples: &'p Samples<'m>) -> Self {
        Self { context, samples }
    }

    fn write_app(&self, out: &mut Source, operation: &Operation) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_app_stream(out, operation);
        }
        let Call {
            method, request, ..
        } = self.context.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let example = self.example(operation, Direction::Request)?;
            let is_empty = example.members.iter().all(|(_, value)| value.is_none());
            if is_empty && is_bare(request) {
                out.line(format!("val answer = client.{method}()"));
            } else {
                assign(out, "val request = ", example);
                out.line(format!("val answer = client.{method}(request)"));
            }
            out.line("println(answer)");
        } else {
            let ty = &request.ty.name;
            out.enclose("client.reports().use { reports ->", "}", |out| {
                out.enclose("reports.asFlow()", "", |out| {
                    out.line(format!(
                        ".map {{ it.message }}\n.filterIsInstance<{ty}>()\n.collect {{ println(it) }}"
                    ));
                });
            });
        }
        Some(())
    }

    fn write_robot(&self, out: &mut Source, operation: &Operation) -> Option<()> {
        if operation.kind() == Kind::Stream {
            return self.write_robot_stream(out, operation);
        }
        let Call {
            method,
            request,
            response,
            ..
        } = self.context.package.call(operation)?;
        if operation.kind() == Kind::Command {
            let answer = self.example(operation, Direction::Response)?;
            let parameters = [
                "context: Context".to_owned(),
                format!("request: {}", request.ty.name),
            ];
            let open = format!("override suspend fun {method}(");
            out.list(&open, &parameters, &format!("): {} {{", response.ty.name));
            out.enclose("", "}", |out| {
                out.line("println(\"${context.peer} asks: $request\")");
                assign(out, "return ", answer);
            });
        } else {
            let report = self.example(operation, Direction::Request)?;
            assign(out, "val report = ", report);
            let head = format!("for (acknowledgement in reporter.{method}(Audience.ALL, report))");
            out.block(head, |out| out.line("println(acknowledgement)"));
        }
        Some(())
    }

    fn write_app_stream(&self, out: &mut Source, stream: &Operation) -> Option<()> {
        let name = self.stream(stream)?;
        if stream.sender == Side::Robot {
            let shown = match content(self.context, stream) {
                Some(_) => "${item.content}",
                None => "${item.content.size} bytes",
            };
            let open = format!("streams.subscribe{name}().use {{ items ->");
            out.enclose(&open, "}", |out| {
                out.line(format!(
                    "items.asFlow().collect {{ item -> println(\"${{item.id}}: {shown}\") }}"
                ));
            });
        } else {
            self.content(out, stream);
            out.line(format!("streams.send{name}(1, content)"));
        }
        Some(())
    }

    fn write_robot_stream(&self, out: &mut Source, stream: &Operation) -> Option<()> {
        let name = self
            .stream(stream)
            .filter(|_| stream.sender == Side::Robot)?;
        self.content(out, stream);
        out.line(format!(
            "val taken = streamer.send{name}(Audience.ALL, 1, content)"
        ));
        out.line("println(\"$taken data connections took it\")");
        Some(())
    }

    /// What the package calls a stream within the name of a method; `None` without a code.
    fn stream(&self, stream: &Operation) -> Option<String> {
        let mut streams = self.context.package.streams.iter();
        let found: &Spelled<'_, Operation> = streams.find(|known| known.of.name == stream.name)?;
        Some(method_of(found))
    }

    /// `val content = …`.
    fn content(&self, out: &mut Source, stream: &Operation) {
        match self.example(stream, Direction::Request) {
            Some(content) => assign(out, "val content = ", content),
            None => out.line(format!(
                "val content = {}.toByteArray()",
                literal(stub::BYTES)
            )),
        }
    }

    fn example(&self, operation: &Operation, direction: Direction) -> Option<Record<'p>> {
        stub::example(&self.context.package, self.samples, operation, direction)
    }
}

/// `before`, and a message as it is written by hand.
fn assign(out: &mut Source, before: &str, message: Record<'_>) {
    laid_out(
        out,
        before,
        &Expr::Record(message),
        &Type::Json,
        "",
        Form::Block,
    );
}

/// A robot that answers by the samples.
fn robot(out: &mut Source, context: &Context<'_>, snippets: &Snippets<'_, '_>) {
    let is_there = |name: &str| context.package.has_type(name);
    let name = free(&["SampleRobot", "RobotOfTheSamples"], is_there);
    out.docs(&Docs::said(&[
        "用文档中的示例响应全部指令。",
        "Responds to every command with the samples of the documentation.",
    ]));
    let head = format!("internal class {name} : Robot");
    let commands = context.commands();
    if commands.is_empty() {
        out.line(head);
        return;
    }
    out.block(head, |out| {
        for command in &commands {
            out.blank();
            let _ = snippets.write_robot(out, command.operation);
        }
    });
}

/// All samples, and a function that runs them.
#[must_use]
pub fn file(context: &Context<'_>, samples: &Samples<'_>) -> Source {
    let snippets = Snippets::new(context, samples);
    let (commands, reports) = (context.commands(), context.reports());
    let mut out = Source::new(&STYLE);
    robot(&mut out, context, &snippets);
    let [from_robot, from_app] =
        [Side::Robot, Side::App].map(|side| stub::streams(&context.package, side));
    let mut calls = Vec::new();
    let mut function =
        |word: &str, operation: &Operation, [name, ty]: [&str; 2], is_robot: bool| {
            let called = function_name(word, operation);
            out.blank();
            out.block(
                format!("private suspend fun {called}({name}: {ty})"),
                |out| {
                    let _ = if is_robot {
                        snippets.write_robot(out, operation)
                    } else {
                        snippets.write_app(out, operation)
                    };
                },
            );
            format!("{called}({name})")
        };
    let client = ["client", "Client"];
    for command in &commands {
        calls.push(function("call", command.operation, client, false));
    }
    let launched = |call: &str| format!("launch(start = UNDISPATCHED) {{ {call} }}");
    let (mut takes, mut pushes) = (Vec::new(), Vec::new());
    for report in &reports {
        takes.push(function("take", report.operation, client, false));
        pushes.push(function(
            "push",
            report.operation,
            ["reporter", "Reporter"],
            true,
        ));
    }
    let (mut subscribes, mut sends) = (Vec::new(), Vec::new());
    for stream in &from_robot {
        subscribes.push(function("subscribe", stream, ["streams", "Streams"], false));
        sends.push(function("send", stream, ["streamer", "Streamer"], true));
    }
    for stream in &from_app {
        sends.push(function("send", stream, ["streams", "Streams"], false));
    }
    out.blank();
    out.docs(&Docs::said(&[
        "运行全部示例，最后关闭 `client`；`server` 是它连接的机器人。",
        "Runs all samples, and closes `client` at the end. `server` is the robot of the connection.",
    ]));
    let parameters = "client: Client, server: Server";
    out.block(
        format!("internal suspend fun runSamples({parameters}): Unit = coroutineScope"),
        |out| {
            for call in &calls {
                out.line(call);
            }
            if !reports.is_empty() {
                for take in &takes {
                    out.line(launched(take));
                }
                out.line("val reporter = Reporter(server)");
                for push in &pushes {
                    out.line(push);
                }
            }
            if !sends.is_empty() {
                out.line("val data = client.data()\ndata.connected()\nval streams = Streams(data)");
            }
            if !from_robot.is_empty() {
                let subscribes: Vec<String> = subscribes.iter().map(|it| launched(it)).collect();
                out.lines("val subscribed = listOf(", &subscribes, ")");
                out.line("val streamer = Streamer(server)");
            }
            for send in &sends {
                out.line(send);
            }
            if !from_robot.is_empty() {
                out.line("subscribed.forEach { it.cancel() }");
            }
            out.line("client.close()");
        },
    );
    out
}

/// What the function around a sample is called.
fn function_name(word: &str, operation: &Operation) -> String {
    let name = format!("{word}_{}", operation.name);
    let (Ok(name) | Err(name)) = KOTLIN.spelling(Role::Function, &name);
    name.into_owned()
}
