//! The robot's side: complete, partial, by example; typed reports and streams.

use super::client::{content, stream_docs};
use super::messages::both;
use super::text::STYLE;
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::ranges::{UNKNOWN, pass_through};
use crate::emit::stub::source::Source;
use crate::surface::language::{KOTLIN, Role};
use crate::surface::package::Call;
use fc_spec::model::{Effect, Exchange, Side};
use std::borrow::Cow;

/// The file.
pub fn file(context: &Context<'_>) -> Source {
    let mut out = Source::new(&STYLE);
    let commands = context.commands();
    let ranges = pass_through(context).into_iter();
    let ranges: Vec<_> = ranges
        .map(|(words, range)| (method(&words).into_owned(), range))
        .collect();
    let unknown = method(UNKNOWN);
    out.docs(&Docs::said(&[
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。只实现了一部分指令的机器人，改为实现 `PartialRobot`。",
        "A complete robot: it handles all commands of the spec. When the spec gains one, a method is missing, and the compiler says so. A robot that has some of them so far implements `PartialRobot` instead: what it leaves out is refused as not implemented.",
        "处理超时或断线之后不再有人等待应答。会引起动作的指令，以及作用不详的指令，处理程序仍运行到结束，`Context.isAbandoned` 让它知道；其他指令的处理程序被取消。",
        "After a timeout or a loss nobody waits for the answer any more. The handler of a command that sets something in motion, or whose effect is unknown, still runs to its end, and `Context.isAbandoned` tells it; that of any other command is cancelled.",
    ]));
    out.block("public interface Robot", |out| {
        for command in &commands {
            let mut docs = facts::operation_docs(command.operation);
            facts::operation_end(&STYLE, &mut docs, command.operation);
            docs.paragraph(context.links(&command.operation.location, &page_of(command.operation)));
            docs.raw("@throws fc.runtime.Refusal to answer with another result than success");
            out.blank();
            out.docs(&docs);
            out.line(signature("public suspend fun", command));
        }
        for (name, range) in &ranges {
            let mut docs = Docs::of(&range.text);
            let (first, last) = (&range.first_spelling, &range.last_spelling);
            docs.paragraph(format!(
                "Codes {first} to {last} that have no method of their own."
            ));
            raw(out, name, docs);
        }
        let said = [
            "功能码不在规范中的指令。",
            "Commands whose code is not in the spec.",
        ];
        raw(out, &unknown, Docs::said(&said));
    });
    out.blank();
    out.docs(&both(
        "实现了一部分指令的机器人：没有写的指令以“未实现”拒绝。",
        "A robot that has some of the commands so far: what it leaves out is refused as not implemented.",
    ));
    out.block("public interface PartialRobot : Robot", |out| {
        for command in &commands {
            out.blank();
            let head = signature("override suspend fun", command);
            out.enclose(&[&head, " ="].concat(), "", |out| {
                out.line("throw context.notImplemented()");
            });
        }
    });
    out.blank();
    example(&mut out, &commands);
    out.blank();
    out.docs(&both(
        "由此机器人处理的全部指令，供 [Server.bind] 使用。",
        "The commands of the spec, carried out by this robot, for [Server.bind].",
    ));
    out.enclose("public fun Robot.service(): Service =", "", |out| {
        out.line("Service()");
        for Call { method, .. } in &commands {
            out.line(format!(
                "    .on(Operations.{method}) {{ context, request -> {method}(context, request) }}"
            ));
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
    out.blank();
    reporter(&mut out, context);
    if context
        .package
        .streams
        .iter()
        .any(|stream| stream.sender == Side::Robot)
    {
        out.blank();
        streamer(&mut out, context);
    }
    out
}

/// The method for what has no type, from words that a language joins in its own way.
fn method(words: &str) -> Cow<'_, str> {
    let (Ok(name) | Err(name)) = KOTLIN.spelling(Role::Function, words);
    name
}

/// A method for requests without a type, which refuses them unless a robot has it.
fn raw(out: &mut Source, name: &str, mut docs: Docs<'_>) {
    docs.paragraph("不实现此方法时，按未知指令拒绝。");
    docs.paragraph("Refused as an unknown command unless the robot has this method.");
    out.blank();
    out.docs(&docs);
    out.line(format!(
        "public suspend fun {name}(context: Context, request: RawRequest): Json ="
    ));
    out.line("    throw context.unknown()");
}

fn example(out: &mut Source, commands: &[Call<'_>]) {
    out.docs(&Docs::said(&[
        "用规范中的示例回答指令，只用于演示和测试；自己的机器人从 `PartialRobot` 开始。",
        "Answers with the spec's examples, for demos and tests alone; a robot of your own starts with `PartialRobot`.",
        "会引起动作的指令，以及作用不详的指令，它并不执行，因此以“未实现”拒绝，除非用 `pretendMotion` 要求它假装。",
        "It does not carry out what sets something in motion, or may do so: such commands are refused as not implemented, unless \
         `pretendMotion` tells it to pretend.",
    ]));
    out.block(
        "public open class ExampleRobot(private val pretendMotion: Boolean = false) : Robot",
        |out| {
            for command in commands {
                let Exchange::Command { effect, .. } = &command.operation.exchange else {
                    continue;
                };
                let moves = matches!(effect, Effect::Motion | Effect::Unknown);
                let response = format!("{}.example()", command.response.ty.name);
                out.blank();
                let head = signature("override suspend fun", command);
                out.enclose(&[&head, " ="].concat(), "", |out| {
                    out.line(if moves {
                        format!("if (pretendMotion) {response} else throw context.notImplemented()")
                    } else {
                        response
                    });
                });
            }
        },
    );
}

fn signature(head: &str, command: &Call<'_>) -> String {
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    format!(
        "{head} {}(context: Context, request: {request}): {response}",
        command.method
    )
}

fn reporter(out: &mut Source, context: &Context<'_>) {
    out.docs(&both(
        "带类型的主动上报：每个上报一个方法，等到每个 app 应答，或者不会再应答。",
        "Typed reports: one method each, which waits until each app has acknowledged it or will not.",
    ));
    out.block("public class Reporter(private val server: Server)", |out| {
        for report in context.reports() {
            let mut docs = facts::operation_docs(report.operation);
            facts::operation_end(&STYLE, &mut docs, report.operation);
            docs.paragraph(context.links(&report.operation.location, &page_of(report.operation)));
            docs.raw("@throws fc.runtime.PushError if it was not even queued");
            let (method, ty) = (report.method, &report.request.ty.name);
            out.blank();
            out.docs(&docs);
            out.line("@JvmSynthetic");
            out.line(format!("public suspend fun {method}(audience: Audience, report: {ty}): List<Acknowledgement> ="));
            out.line(format!("    server.push(audience, Operations.{method}, report)"));
            let mut docs = Docs::default();
            docs.raw(format!("[{method}]，供 Java 使用。[{method}] for Java."));
            out.blank();
            out.docs(&docs);
            out.line(format!("public fun {method}Async(audience: Audience, report: {ty}): CompletableFuture<List<Acknowledgement>> ="));
            out.line(format!("    server.pushAsync(audience, Operations.{method}, report)"));
        }
    });
}

fn streamer(out: &mut Source, context: &Context<'_>) {
    out.docs(&both(
        "机器人发送的数据流：每个数据流一个方法，返回收下它的数据连接数。",
        "Sends the robot's streams: one method each, which gives how many data connections took it.",
    ));
    out.block("public class Streamer(private val server: Server)", |out| {
        for stream in &context.package.streams {
            if stream.sender != Side::Robot {
                continue;
            }
            let ty = content(context, stream).unwrap_or("ByteArray");
            let (name, code) = (super::method_of(stream), &stream.code.spelling);
            out.blank();
            out.docs(&stream_docs(context, stream));
            out.line("@JvmSynthetic");
            out.line(format!(
                "public suspend fun send{name}(audience: Audience, id: Long, content: {ty}): Int ="
            ));
            out.line(format!(
                "    server.sendStream(audience, {code}, id, content)"
            ));
        }
    });
}
