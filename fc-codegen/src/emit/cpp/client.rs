//! The app's stub: a class with the methods of its groups, one per command.
//!
//! The stub also contains one variant over all reports.

use super::groups::{NamedGroup, with_commands, with_reports};
use super::layout::{Includes, header_file, literal, source_file};
use super::streams;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::source::Source;

/// Generates `client.hpp`.
pub fn header(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let includes = Includes::new(
        context,
        &["chrono", "memory", "optional", "utility", "variant"],
        &["messages", "protocol"],
        &["client", "following", "types"],
    );
    header_file(context, &includes, |out| {
        reports(out, groups);
        out.blank();
        client(out, groups);
        out.blank();
        for calls in with_commands(groups, "Calls") {
            out.line(format!("extern template class {calls}<Client>;"));
        }
        out.blank();
        streams::for_app(out, groups);
        out.blank();
        each(out, groups);
    })
}

fn reports(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    out.docs(&Docs::said([
        "任意一个上报；功能码不在规范中的，原样保留。",
        "Any report. A report with a code that is not in the spec is kept unchanged.",
    ]));
    let mut lists = with_reports(groups, "Reports");
    lists.push("fc_runtime::Types<fc_runtime::RawReport>".to_owned());
    out.alias("AnyReport", "fc_runtime::VariantOf", &lists);
    out.blank();
    out.docs(&Docs::written([
        "收到的上报，按到达的先后。",
        "Reports in the order of arrival. A report is acknowledged when at least one receiver has it in its\n\
         queue. Every receiver of a connection gets all reports. A report with an invalid body is refused,\n\
         counted as `reports_invalid`, and not delivered.",
    ]));
    out.line("class Reports {\n public:");
    out.enclose("", "", |out| {
        out.line("explicit Reports(std::shared_ptr<fc_runtime::ReportQueue> queue) : queue_(std::move(queue)) {}");
        out.documented(&Docs::written([
            "返回下一个上报；超过 `wait` 没有收到，或者连接已经结束且队列为空时，没有返回值。",
            "Returns the next report. Returns nothing after `wait`, or if the connection has ended and the queue\n\
             is empty.",
        ]));
        out.line("[[nodiscard]] std::optional<AnyReport> next(std::chrono::milliseconds wait) const;");
        out.docs(&Docs::written([
            "返回上次调用以来错过的上报数：自己的队列已满。",
            "Returns the number of reports that this receiver missed since the last call: its queue was full.",
        ]));
        out.line("[[nodiscard]] std::uint64_t missed() const { return queue_->take_missed(); }");
        out.docs(&Docs::written([
            "连接是否已经结束，且队列为空。",
            "Returns `true` if the connection has ended and the queue is empty.",
        ]));
        out.line("[[nodiscard]] bool is_over() const { return queue_->is_over(); }");
    });
    out.blank();
    out.line(" private:\n  std::shared_ptr<fc_runtime::ReportQueue> queue_;\n};");
}

fn client(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    out.docs(&Docs::written([
        "一个机器人，从 app 一侧看：每条指令一个方法，等到响应才返回。",
        "A robot as seen from the app: one method per command, which waits for the response. Cheap to copy; all\n\
         copies share one connection. Any thread can use it. To call without waiting, use\n\
         `connection().call_async`.",
    ]));
    let bases = with_commands(groups, "Calls").into_iter();
    let bases: Vec<String> = bases.map(|it| format!("public {it}<Client>")).collect();
    out.class("Client", &bases);
    out.line(" public:");
    out.enclose("", "", |out| {
        out.docs(&Docs::written([
            "连接机器人；`config` 中没有设置的项使用规范的默认值。",
            "Connects to a robot. Settings missing from `config` have the defaults of the spec.",
        ]));
        out.line(
            "\
[[nodiscard]] static fc_runtime::Result<Client, fc_runtime::Loss> connect(
    const fc_runtime::ClientConfig& config = {});",
        );
        out.docs(&Docs::written([
            "立即返回，在后台连接机器人；其间发起的调用在各自的时限内等待连接。",
            "Returns at once and connects in the background. Calls made before that wait within their timeout.",
        ]));
        out.line(
            "\
[[nodiscard]] static Client connect_lazy(const fc_runtime::ClientConfig& config = {});
explicit Client(fc_runtime::Connection connection) : robot_connection_(std::move(connection)) {}",
        );
        out.documented(&Docs::written([
            "此刻的连接状态；没有连接时说明原因。",
            "Returns the present state of the connection, with the reason if there is none.",
        ]));
        out.line("[[nodiscard]] fc_runtime::ConnectionState state() const { return robot_connection_.state(); }");
        out.docs(&Docs::written([
            "连接状态的变化：先是此刻的状态，之后是每一次变化。",
            "The states of the connection: the present one first, then each change.",
        ]));
        out.line("[[nodiscard]] fc_runtime::ConnectionStates states() const { return robot_connection_.states(); }");
        out.docs(&Docs::written([
            "返回此后全部上报的接收端。没有接收端时，上报不会得到应答。",
            "Returns a receiver of all reports from now on. Without a receiver, reports are not acknowledged.",
        ]));
        out.line("[[nodiscard]] Reports reports() const { return Reports(robot_connection_.reports()); }");
        out.docs(&Docs::written([
            "连接数据端口：在后台建立，断线后重连，随指令连接一起结束。",
            "Connects to the data port in the background and reconnects after a loss. It ends with this\n\
             connection.",
        ]));
        out.line("[[nodiscard]] fc_runtime::DataConnection data() const { return robot_connection_.data(); }");
        out.docs(&Docs::written([
            "永久关闭连接。",
            "Closes the connection for good.",
        ]));
        out.line("void close() const { robot_connection_.close(); }");
        out.docs(&Docs::written([
            "底层连接：原始指令、不等待的调用、计数。",
            "The underlying connection: raw commands, calls that do not wait, counters.",
        ]));
        out.line("[[nodiscard]] const fc_runtime::Connection& connection() const { return robot_connection_; }");
        out.documented(&Docs::written([
            "发出指令，先返回响应，再逐个返回它引起的 `Message`，直到终态、失败或连接结束。",
            "Calls a command and returns its response, then each `Message` that it sets off. It ends at a final\n\
             state, at a failure or with the connection.",
        ]));
        out.line(
            "\
template <class Message, class Request>
[[nodiscard]] fc_runtime::Called<fc_runtime::Following<Request, Message>> follow(
    const Request& request, const fc_runtime::CallOptions& options = {}) const {
  return fc_runtime::follow<Message>(robot_connection_, request, options);
}",
        );
    });
    out.blank();
    out.line(" private:\n  fc_runtime::Connection robot_connection_;\n};");
}

/// Writes the commands of a group as methods of the client.
pub fn calls(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    out.docs(&Docs::said([
        "一组指令，是 `Client`（`Self`）的方法。",
        "The commands of a group as methods of `Client` (`Self`).",
    ]));
    out.line("template <class Self>");
    out.line(format!("class {} {{", group.part("Calls")));
    out.line(" public:");
    out.enclose("", "};", |out| {
        for command in &group.commands {
            out.blank();
            call(out, context, command);
        }
    });
    out.blank();
    out.line(
        "// Not in the class: inline functions would be compiled in spite of `extern template`.",
    );
    out.line("// clang-format off");
    for command in &group.commands {
        let (request, response) = (&command.request.ty.name, &command.response.ty.name);
        out.line("template <class Self>");
        out.line(format!(
            "fc_runtime::Called<{response}> {}<Self>::{}(const {request}& request, const fc_runtime::CallOptions& options) const {{",
            group.part("Calls"),
            command.method
        ));
        out.line("  return static_cast<const Self*>(this)->connection().call(request, options);");
        out.line("}");
    }
    out.line("// clang-format on");
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let docs = facts::call_docs(context, command.operation, |error| {
        format!("`fc_runtime::declared` returns the `{error}` of a refused call.")
    });
    out.docs(&docs);
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    let parameters = [
        format!("const {request}& request"),
        "const fc_runtime::CallOptions& options = {}".to_owned(),
    ];
    let (result, method) = (format!("fc_runtime::Called<{response}>"), command.method);
    let open = format!("{result} {method}(");
    let deprecation = command.operation.deprecated.as_ref();
    if let Some(deprecation) = deprecation {
        // The formatter would break the reason.
        let reason = literal(&facts::withdrawn_note(deprecation));
        out.line("// clang-format off");
        out.line(format!("[[deprecated({reason})]]"));
    }
    out.parameters(&open, &parameters, ") const;");
    if deprecation.is_some() {
        out.line("// clang-format on");
    }
}

/// Writes the types of a group's requests and of its reports.
pub fn lists(out: &mut Source, group: &NamedGroup<'_, '_>) {
    for (part, zh, en, calls) in [
        (
            "Commands",
            "这一组指令的请求。",
            "The requests of the group.",
            &group.commands,
        ),
        (
            "Reports",
            "这一组的上报。",
            "The reports of the group.",
            &group.reports,
        ),
    ] {
        if calls.is_empty() {
            continue;
        }
        out.docs(&Docs::line([zh, en]));
        out.line(format!("using {} = fc_runtime::Types<", group.part(part)));
        // The comments and the end marker keep each type on a separate line. A new type therefore changes no other
        // line.
        for call in calls {
            out.line(format!("    // {}", call.operation.code.spelling));
            out.line(format!("    {},", call.request.ty.name));
        }
        out.line("    // No more.");
        out.line("    fc_runtime::End>;");
    }
}

/// Writes a function over the types of all commands, and one over the types of all reports.
fn each(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let commands = with_commands(groups, "Commands");
    let reports = with_reports(groups, "Reports");
    for (what, zh, lists) in [("command", "请求", commands), ("report", "上报", reports)] {
        let zh = format!("对每一种{zh}调用一次 `visit`，参数是该类型的一个值。");
        let en = format!("Calls `visit` once for each {what}, with a value of its type.");
        out.documented(&Docs::said([zh, en]));
        out.line("template <class Visitor>");
        let visit = if lists.is_empty() {
            "/*visit*/"
        } else {
            "visit"
        };
        out.enclose(
            &format!("void for_each_{what}(Visitor&& {visit}) {{"),
            "}",
            |out| {
                for list in &lists {
                    out.line(format!("fc_runtime::visit_each(visit, {list}());"));
                }
            },
        );
    }
}

/// Generates `client.cpp`.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let before = "#include \"fc_runtime/any_report.hpp\"\n\n";
    source_file(context, "client.hpp", before, |out| {
        out.line(
            "\
std::optional<AnyReport> Reports::next(std::chrono::milliseconds wait) const {
  auto raw = queue_->next(wait);
  if (!raw) return std::nullopt;
  // Reports are read before they are acknowledged.
  return fc_runtime::any_report<AnyReport>(protocol(), *std::move(raw));
}

fc_runtime::Result<Client, fc_runtime::Loss> Client::connect(const fc_runtime::ClientConfig& config) {
  auto connection = fc_runtime::Connection::connect(protocol(), config);
  if (!connection) return std::move(connection).error();
  return Client(*std::move(connection));
}

Client Client::connect_lazy(const fc_runtime::ClientConfig& config) {
  return Client(fc_runtime::Connection::connect_lazy(protocol(), config));
}",
        );
        out.blank();
        for calls in with_commands(groups, "Calls") {
            out.line(format!("template class {calls}<Client>;"));
        }
    })
}
