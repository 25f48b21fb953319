//! The robot's stub: a class with one method per command to derive from, one that answers with the spec's examples,
//! and typed pushing of reports.

use super::layout::Includes;
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::ranges::{UNKNOWN, pass_through};
use crate::emit::stub::source::Source;
use crate::surface::package::Call;
use fc_spec::model::Effect;

/// The header.
pub fn header(context: &Context<'_>) -> String {
    let space = &context.model().protocol.id;
    let mut out = Source::cpp();
    out.line("#pragma once");
    out.blank();
    let mut includes = Includes::default();
    for name in ["memory", "optional", "string_view", "vector"] {
        includes.standard(name);
    }
    includes.own(format!("{space}/messages.hpp"));
    includes.own(format!("{space}/protocol.hpp"));
    includes.own("fc_runtime/server.hpp");
    includes.lines(&mut out);
    out.blank();
    let commands = context.commands();
    out.namespace(space, |out| {
        robot(out, context, &commands);
        out.blank();
        partial(out, &commands);
        out.blank();
        example(out, &commands);
        out.blank();
        out.line(
            "\
/// 由一个机器人处理规范中的指令，交给 `fc_runtime::Server::bind`。
///
/// Has a robot handle the commands of the spec, for `fc_runtime::Server::bind`.
[[nodiscard]] fc_runtime::Service service(std::shared_ptr<Robot> robot);",
        );
        out.blank();
        reporter(out, context);
    });
    out.finish()
}

fn robot(out: &mut Source, context: &Context<'_>, commands: &[Call<'_>]) {
    out.line(
        "\
/// 完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。
/// A complete robot: it handles all commands of the spec. When the spec gains one, a method is missing
/// here, and the compiler says so.
///
/// 只实现了一部分指令的机器人，先继承 `PartialRobot`：没有写的指令以“未实现”拒绝。
///
/// A robot that has some of them so far derives from `PartialRobot`: what is left out is refused as not
/// implemented. That one word is all that changes once nothing is missing.
///
/// 各个方法可能同时被多个线程调用。处理超时后，机器人替它应答超时，方法仍运行到结束；
/// `Context::is_abandoned` 让它知道没有人等待了。
///
/// Methods may be called by several threads at once. When one takes too long, the robot answers with a
/// timeout in its place, and it still runs to its end: `Context::is_abandoned` tells it that nobody
/// waits any more.
class Robot {
 public:
  Robot() = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  virtual ~Robot() = default;",
    );
    out.enclose("", "};", |out| {
        for command in commands {
            let mut docs = facts::operation_docs(command.operation);
            facts::operation_end(context.style, &mut docs, command.operation);
            docs.paragraph(context.links(&command.operation.location, &page_of(command.operation)));
            out.blank();
            out.docs(&docs);
            let open = format!(
                "virtual fc_runtime::Replied<{}> {}(",
                command.response.ty.name, command.method
            );
            let parameters = [
                "const fc_runtime::Context& context".to_owned(),
                format!("const {}& request", command.request.ty.name),
            ];
            out.parameters(&open, &parameters, ") = 0;");
        }
        for (name, range) in pass_through(context) {
            let mut docs = Docs::of(&range.text);
            docs.paragraph(format!(
                "Codes {} to {} that have no method of their own.",
                range.first_spelling, range.last_spelling
            ));
            raw(out, docs, &name);
        }
        let other = [
            "功能码不在规范中的指令。",
            "Commands whose code is not in the spec.",
        ];
        raw(out, Docs::said(&other), UNKNOWN);
    });
}

/// A method for commands without a type, which a robot need not have.
fn raw(out: &mut Source, mut docs: Docs<'_>, name: &str) {
    docs.paragraph("不实现此方法时，按未知指令拒绝。");
    docs.paragraph("Refused as an unknown command unless the robot has this method.");
    out.blank();
    out.docs(&docs);
    let parameters = [
        "const fc_runtime::Context& context",
        "std::string_view text",
    ];
    out.parameters(
        &format!("virtual fc_runtime::RawReplied {name}("),
        &parameters.map(str::to_owned),
        ");",
    );
}

/// What calls such a method.
fn serve_raw(name: &str) -> String {
    format!(
        "return fc_runtime::serve_raw(protocol(), context, text, [&robot](const fc_runtime::Context& known, std::string_view whole) {{ return robot->{name}(known, whole); }});"
    )
}

/// A method of a robot as a class declares it that overrides it.
fn overriding(out: &mut Source, command: &Call<'_>) {
    let open = format!(
        "fc_runtime::Replied<{}> {}(",
        command.response.ty.name, command.method
    );
    let parameters = [
        "const fc_runtime::Context& context".to_owned(),
        format!("const {}& request", command.request.ty.name),
    ];
    out.parameters(&open, &parameters, ") override;");
}

fn partial(out: &mut Source, commands: &[Call<'_>]) {
    out.line(
        "\
/// 只实现了一部分指令的机器人：其余的以“未实现”拒绝。
/// A robot that has some of the commands: the others are refused as not implemented.
class PartialRobot : public Robot {
 public:",
    );
    out.enclose("", "};", |out| {
        for command in commands {
            overriding(out, command);
        }
    });
}

fn example(out: &mut Source, commands: &[Call<'_>]) {
    out.line(
        "\
/// 用规范中的示例回答指令，只用于演示和测试。会引起动作的指令，以及作用不详的指令，它并不执行，因此以“未实现”拒绝，
/// 除非要求它假装。
/// Answers with the spec's examples, for demos and tests alone. It does not carry out what sets something
/// in motion, or may do so: such commands are refused as not implemented, unless it is told to pretend.
class ExampleRobot : public Robot {
 public:
  explicit ExampleRobot(bool pretend_motion = false) : pretend_motion_(pretend_motion) {}",
    );
    out.enclose("", "", |out| {
        out.blank();
        for command in commands {
            overriding(out, command);
        }
    });
    out.blank();
    out.line(" private:");
    out.line("  bool pretend_motion_;");
    out.line("};");
}

fn reporter(out: &mut Source, context: &Context<'_>) {
    out.line(
        "\
/// 主动上报：每种上报一个方法，等到每个 app 都有结果才返回。不指定连接时，发给此刻连接的全部 app。
///
/// Pushes reports: one method per report, which waits until it has ended at each app. Without a connection
/// it goes to all apps connected at the moment. The server has to outlive it.
class Reporter {
 public:
  explicit Reporter(const fc_runtime::Server& server) : server_(&server) {}",
    );
    out.enclose("", "", |out| {
        for report in &context.reports() {
            let mut docs = facts::operation_docs(report.operation);
            facts::operation_end(context.style, &mut docs, report.operation);
            docs.paragraph(context.links(&report.operation.location, &page_of(report.operation)));
            out.blank();
            out.docs(&docs);
            let parameters = [
                format!("const {}& report", report.request.ty.name),
                "std::optional<fc_runtime::ConnectionId> to = std::nullopt".to_owned(),
            ];
            out.parameters(
                &format!("fc_runtime::Acknowledged {}(", report.method),
                &parameters,
                ") const;",
            );
        }
    });
    out.blank();
    out.line(" private:");
    out.line("  const fc_runtime::Server* server_;");
    out.line("};");
}

/// Whether a command sets something in motion, as far as anybody knows.
fn may_move(command: &Call<'_>) -> bool {
    match command.operation.effect() {
        Some(Effect::Read | Effect::Config) => false,
        Some(Effect::Motion | Effect::Unknown) | None => true,
    }
}

/// The source.
pub fn source(context: &Context<'_>) -> String {
    let space = &context.model().protocol.id;
    let commands = context.commands();
    let ranges = pass_through(context);
    let mut out = Source::cpp();
    out.line(format!("#include \"{space}/robot.hpp\""));
    out.blank();
    out.line("#include <utility>");
    out.blank();
    out.line("// clang-format off");
    out.blank();
    out.namespace(space, |out| {
        let unknown = UNKNOWN.to_owned();
        for name in ranges.iter().map(|(name, _)| name).chain([&unknown]) {
            out.blank();
            let open = format!(
                "fc_runtime::RawReplied Robot::{name}(const fc_runtime::Context& /*context*/, std::string_view /*text*/) {{"
            );
            out.enclose(&open, "}", |out| out.line("return fc_runtime::unknown_command(protocol());"));
        }
        for command in &commands {
            let (request, response) = (&command.request.ty.name, &command.response.ty.name);
            let open = format!(
                "fc_runtime::Replied<{response}> PartialRobot::{}(const fc_runtime::Context& /*context*/, const {request}& /*request*/) {{",
                command.method
            );
            out.blank();
            out.enclose(&open, "}", |out| {
                out.line("return fc_runtime::not_implemented(protocol());");
            });
        }
        for command in &commands {
            let (request, response) = (&command.request.ty.name, &command.response.ty.name);
            let open = format!(
                "fc_runtime::Replied<{response}> ExampleRobot::{}(const fc_runtime::Context& /*context*/, const {request}& /*request*/) {{",
                command.method
            );
            out.blank();
            out.enclose(&open, "}", |out| {
                if may_move(command) {
                    out.line("if (!pretend_motion_) return fc_runtime::not_implemented(protocol());");
                }
                out.line(format!("return fc_runtime::example<{response}>();"));
            });
        }
        out.blank();
        out.enclose("fc_runtime::Service service(std::shared_ptr<Robot> robot) {", "}", |out| {
            let open = "return [robot = std::move(robot)](const fc_runtime::Context& context, std::string_view text) -> fc_runtime::Handled {";
            out.enclose(open, "};", |out| {
                out.enclose("switch (context.code) {", "}", |out| {
                    for command in &commands {
                        let (request, response) = (&command.request.ty.name, &command.response.ty.name);
                        out.line(format!("case fc_runtime::Command<{request}>::code:"));
                        out.line(format!(
                            "  return fc_runtime::serve<{request}, {response}>(protocol(), context, text, [&robot](const fc_runtime::Context& known, const {request}& request) {{ return robot->{}(known, request); }});",
                            command.method
                        ));
                    }
                    out.line("default: break;");
                });
                for (name, range) in &ranges {
                    let (first, last) = (&range.first_spelling, &range.last_spelling);
                    // What every code is, compilers warn of.
                    let bounds: Vec<String> = [
                        (range.first > 0).then(|| format!("context.code >= {first}")),
                        (range.last < u16::MAX).then(|| format!("context.code <= {last}")),
                    ]
                    .into_iter()
                    .flatten()
                    .collect();
                    let is_in = if bounds.is_empty() {
                        "true".to_owned()
                    } else {
                        bounds.join(" && ")
                    };
                    out.line(format!("if ({is_in}) {}", serve_raw(name)));
                }
                out.line(serve_raw(UNKNOWN));
            });
        });
        for report in &context.reports() {
            let name = &report.request.ty.name;
            out.blank();
            let open = format!(
                "fc_runtime::Acknowledged Reporter::{}(const {name}& report, std::optional<fc_runtime::ConnectionId> to) const {{",
                report.method
            );
            out.enclose(&open, "}", |out| out.line("return server_->push(report, to);"));
        }
    });
    out.finish()
}
