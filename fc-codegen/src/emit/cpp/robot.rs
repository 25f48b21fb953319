//! The robot's stub: a base class with the methods of its groups, one per command.
//!
//! The stub also contains a robot that responds with the spec's examples, and a typed sender of reports.

use super::groups::{NamedGroup, with_commands, with_reports};
use super::layout::{Includes, header_file, source_file};
use super::streams;
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::ranges::{UNKNOWN, pass_through};
use crate::package::source::Source;

/// Generates `robot.hpp`.
pub fn header(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let includes = Includes::new(
        context,
        &["memory", "string_view"],
        &["messages", "protocol"],
        &["server", "stacked"],
    );
    header_file(context, &includes, |out| {
        robot(out, context, groups);
        out.blank();
        partial(out, groups);
        out.blank();
        example(out, groups);
        out.blank();
        out.docs(&Docs::written([
            "包装一个机器人，交给 `fc_runtime::Server::bind`。",
            "Wraps a robot for `fc_runtime::Server::bind`.",
        ]));
        out.line("[[nodiscard]] fc_runtime::Service service(std::shared_ptr<Robot> robot);");
        out.blank();
        reporter(out, groups);
        out.blank();
        streams::for_robot(out, groups);
    })
}

fn robot(out: &mut Source, context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) {
    let mut docs = Docs::two_lines([
        "完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，编译器会指出。",
        "A complete robot, which handles all commands of the spec. When the spec gains a command, the compiler\n\
         reports a missing method.",
    ]);
    docs.raw_both([
        "只实现了一部分指令的机器人，先继承 `PartialRobot`：没有写的指令以“未实现”拒绝。指令齐全之后，改为继承 `Robot`。",
        "A robot with some of the commands derives from `PartialRobot`, which refuses the others as not\n\
         implemented. Once the robot has all commands, change `PartialRobot` to `Robot`.",
    ]);
    docs.raw_both([
        "各个方法可能同时被多个线程调用。处理超时后，机器人替它返回超时，方法仍运行到结束；\n\
         方法用 `Context::is_abandoned` 得知调用方不再等待。",
        "Several threads can call methods at the same time. After a timeout, the robot responds with a timeout,\n\
         and the method runs to its end. It can check `Context::is_abandoned`: the caller does not wait any\n\
         more.",
    ]);
    out.docs(&docs);
    let bases = with_commands(groups, "Robot").into_iter();
    let bases: Vec<String> = bases.map(|it| format!("public {it}")).collect();
    out.class("Robot", &bases);
    out.line(
        " public:
  Robot() = default;
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  virtual ~Robot() = default;",
    );
    out.enclose("", "};", |out| {
        for (name, range) in pass_through(context) {
            raw(out, &about::range(range), &name);
        }
        raw(out, &about::unknown(), UNKNOWN);
    });
}

/// Writes the class with the handlers of a group's commands.
pub fn handlers(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let name = group.part("Robot");
    out.docs(&Docs::said([
        "一组指令，由 `Robot` 处理。",
        "The commands of a group as `Robot` handles them.",
    ]));
    out.line(format!("class {name} {{"));
    out.line(" public:");
    out.enclose("", "", |out| {
        for command in &group.commands {
            out.documented(&facts::method_docs(context, command.operation, |_| ()));
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
    });
    out.blank();
    out.line(" protected:");
    out.line("  // Only `Robot` derives from a part.");
    out.line(format!("  ~{name}() = default;"));
    out.line("};");
}

/// Writes the class with the responses of `PartialRobot` and `ExampleRobot` to a group's commands.
pub fn defaults(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.docs(&Docs::said([
        "一组指令，`PartialRobot` 和 `ExampleRobot` 由 `Base` 响应。",
        "The commands of a group in `PartialRobot` and `ExampleRobot`. `Base` responds to them.",
    ]));
    out.line("template <class Base>");
    out.line(format!("class {} : public Base {{", group.part("Defaults")));
    out.line(" public:");
    out.enclose("", "};", |out| {
        for command in &group.commands {
            let open = format!(
                "fc_runtime::Replied<{}> {}(",
                command.response.ty.name, command.method
            );
            let parameters = [
                "const fc_runtime::Context& /*context*/".to_owned(),
                format!("const {}& request", command.request.ty.name),
            ];
            let method = command.method;
            out.docs(&Docs::line([
                format!("见 `Robot::{method}`。"),
                format!("See `Robot::{method}`."),
            ]));
            out.parameters(&open, &parameters, ") override {");
            out.line("  return Base::answer_(request);");
            out.line("}");
        }
    });
}

/// Writes a method for commands without a type, which a robot may omit.
fn raw(out: &mut Source, docs: &Docs<'_>, name: &str) {
    out.documented(docs);
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

/// Returns the statement that calls such a method.
fn serve_raw(name: &str) -> String {
    format!(
        "return fc_runtime::serve_raw(protocol(), context, text, [&robot](const fc_runtime::Context& known, std::string_view whole) {{ return robot->{name}(known, whole); }});"
    )
}

/// Writes a robot class with a part for each group, one per line.
fn of_parts(
    out: &mut Source,
    about: [&str; 2],
    name: &str,
    answers: &str,
    constructor: &str,
    groups: &[NamedGroup<'_, '_>],
) {
    let answers = format!("fc_runtime::{answers}<Robot, protocol>");
    let parts = with_commands(groups, "Defaults");
    let parts: Vec<String> = [answers].into_iter().chain(parts).collect();
    // The formatter would fill the lines, and a new group would change all of them.
    out.line("// clang-format off");
    out.docs(&Docs::two_lines(about));
    out.line(format!("class {name} : public fc_runtime::Stacked<"));
    out.line(format!("    {}> {{", parts.join(",\n    ")));
    out.line(" public:");
    out.line(format!("  {constructor};"));
    out.line(format!("  ~{name}() override;"));
    out.line("};");
    out.line("// clang-format on");
}

fn partial(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    of_parts(
        out,
        [
            "只实现了一部分指令的机器人：其余的以“未实现”拒绝。它是一个 `Robot`。",
            "A robot with some of the commands. It refuses the others as not implemented. It is a `Robot`.",
        ],
        "PartialRobot",
        "Refusing",
        "PartialRobot()",
        groups,
    );
}

fn example(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    of_parts(
        out,
        [
            "用规范中的示例响应指令，只用于演示和测试。它不执行运动指令和影响不详的指令，以“未实现”拒绝；\n\
             `pretend_motion` 为真时假装成功。它是一个 `Robot`。",
            "Responds with the examples of the spec, only for demos and tests. It does not execute commands that move\n\
             the robot or have an unknown effect, and refuses them as not implemented. With `pretend_motion`, it\n\
             pretends success. It is a `Robot`.",
        ],
        "ExampleRobot",
        "Exemplary",
        "explicit ExampleRobot(bool pretend_motion = false)",
        groups,
    );
}

fn reporter(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    out.docs(&Docs::written([
        "发送上报：每种上报一个方法，等到每个 app 都有结果才返回。不指定连接时，发给此刻连接的全部 app。",
        "Pushes reports: one method per report, which waits for the outcome at each app. Without a connection,\n\
         the report goes to all connected apps. The server must outlive this object.",
    ]));
    let bases = with_reports(groups, "Reporter").into_iter();
    let bases: Vec<String> = bases.map(|it| format!("public {it}<Reporter>")).collect();
    out.class("Reporter", &bases);
    out.line(" public:");
    out.enclose("", "", |out| {
        out.line("explicit Reporter(const fc_runtime::Server& server) : robot_server_(&server) {}");
        out.documented(&Docs::line([
            "发送上报的服务端。",
            "The server that sends the reports.",
        ]));
        out.line(
            "[[nodiscard]] const fc_runtime::Server& server() const { return *robot_server_; }",
        );
    });
    out.blank();
    out.line(" private:\n  const fc_runtime::Server* robot_server_;\n};");
}

/// Writes the reports of a group as methods of the reporter.
pub fn reporters(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    out.docs(&Docs::said([
        "一组主动上报，是 `Reporter` 的方法；`Self` 就是它。",
        "The reports of a group as methods of `Reporter` (`Self`).",
    ]));
    out.line("template <class Self>");
    out.line(format!("class {} {{", group.part("Reporter")));
    out.line(" public:");
    out.enclose("", "};", |out| {
        for report in &group.reports {
            out.documented(&facts::method_docs(context, report.operation, |_| ()));
            let parameters = [
                format!("const {}& report", report.request.ty.name),
                "std::optional<fc_runtime::ConnectionId> to = std::nullopt".to_owned(),
            ];
            out.parameters(
                &format!("fc_runtime::Acknowledged {}(", report.method),
                &parameters,
                ") const {",
            );
            out.line("  return static_cast<const Self*>(this)->server().push(report, to);");
            out.line("}");
        }
    });
}

/// Declares the function that passes a request to its method.
pub fn declare_serve(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.docs(&Docs::said([
        "由机器人处理这一组的指令；其他指令没有结果。",
        "Has a robot handle a command of the group; none if it is of another.",
    ]));
    let open = format!(
        "[[nodiscard]] std::optional<fc_runtime::Handled> serve_{}(",
        group.id
    );
    let parameters = [
        format!("{}& robot", group.part("Robot")),
        "const fc_runtime::Context& context".to_owned(),
        "std::string_view text".to_owned(),
    ];
    out.parameters(&open, &parameters, ");");
}

/// Defines the function that passes a request to its method.
pub fn serve(out: &mut Source, group: &NamedGroup<'_, '_>) {
    let open = format!(
        "std::optional<fc_runtime::Handled> serve_{}({}& robot, const fc_runtime::Context& context, std::string_view text) {{",
        group.id,
        group.part("Robot")
    );
    out.enclose(&open, "}", |out| {
        out.enclose("switch (context.code) {", "}", |out| {
            for command in &group.commands {
                let (request, response) = (&command.request.ty.name, &command.response.ty.name);
                out.line(format!("case fc_runtime::Command<{request}>::code:"));
                out.line(format!(
                    "  return fc_runtime::serve<{request}, {response}>(protocol(), context, text, [&robot](const fc_runtime::Context& known, const {request}& request) {{ return robot.{}(known, request); }});",
                    command.method
                ));
            }
            out.line("default: return std::nullopt;");
        });
    });
}

/// Generates `robot.cpp`.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let ranges = pass_through(context);
    let before = "#include <utility>\n\n";
    source_file(context, "robot.hpp", before, |out| {
        let unknown = UNKNOWN.to_owned();
        for name in ranges.iter().map(|(name, _)| name).chain([&unknown]) {
            out.blank();
            let open = format!(
                "fc_runtime::RawReplied Robot::{name}(const fc_runtime::Context& /*context*/, std::string_view /*text*/) {{"
            );
            out.enclose(&open, "}", |out| {
                out.line("return fc_runtime::unknown_command(protocol());");
            });
        }
        out.blank();
        out.line(
            "\
PartialRobot::PartialRobot() = default;
PartialRobot::~PartialRobot() = default;

ExampleRobot::ExampleRobot(bool pretend_motion) { pretend_motion_ = pretend_motion; }
ExampleRobot::~ExampleRobot() = default;",
        );
        out.blank();
        out.enclose("fc_runtime::Service service(std::shared_ptr<Robot> robot) {", "}", |out| {
            let open = "return [robot = std::move(robot)](const fc_runtime::Context& context, std::string_view text) -> fc_runtime::Handled {";
            out.enclose(open, "};", |out| {
                for group in groups.iter().filter(|it| !it.commands.is_empty()) {
                    let serve = group.function("serve");
                    out.line(format!(
                        "if (auto handled = {serve}(*robot, context, text)) return *std::move(handled);"
                    ));
                }
                for (name, range) in &ranges {
                    let (first, last) = (&range.first_spelling, &range.last_spelling);
                    // Compilers warn of a comparison that is always true.
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
    })
}
