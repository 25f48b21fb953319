//! The streams of the data port on both sides.

use super::groups::{self, NamedGroup};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Spelled;
use crate::package::source::Source;
use fc_spec::model::{Operation, Side};

const STREAMS: &str = "Streams";
const STREAMER: &str = "Streamer";

/// Writes the app's side, if there are streams.
pub fn for_app(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let parts = groups::parts(groups, STREAMS, |it| !it.streams.is_empty());
    if parts.is_empty() {
        return;
    }
    out.documented(&Docs::said([
        "数据端口上的数据流：订阅机器人的数据流，发送 app 的数据流。",
        "The streams of the data port. Subscribe to those of the robot, and send those of the app.",
    ]));
    whole(out, STREAMS, &parts);
    out.enclose("", "", |out| {
        out.line(
            "\
explicit Streams(fc_runtime::DataConnection data) : robot_data_(std::move(data)) {}",
        );
        out.documented(&Docs::line([
            "数据连接。",
            "The data connection: its state, and frames without a subscription.",
        ]));
        out.line(
            "[[nodiscard]] const fc_runtime::DataConnection& data() const { return robot_data_; }",
        );
    });
    out.blank();
    out.line(" private:\n  fc_runtime::DataConnection robot_data_;\n};");
}

/// Writes the robot's side, if it sends any stream.
pub fn for_robot(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let parts = groups::parts(groups, STREAMER, |it| it.subscribed().next().is_some());
    if parts.is_empty() {
        return;
    }
    out.documented(&Docs::written([
        "机器人发送的数据流：每个数据流一个方法，等到数据连接的队列有空位，返回收下的连接数。`to` 是一个\n\
         app 的连接；不指定时发给全部 app。",
        "Sends the streams of the robot: one method per stream, which waits for space in the queues of the data\n\
         connections. It returns how many took the frame. `to` is the connection of one app. Without it, the\n\
         frame goes to all apps. The server must outlive this object.",
    ]));
    whole(out, STREAMER, &parts);
    out.enclose("", "", |out| {
        out.line("explicit Streamer(const fc_runtime::Server& server) : robot_server_(&server) {}");
        out.documented(&Docs::line([
            "发送数据流的服务端。",
            "The server that sends the streams.",
        ]));
        out.line(
            "[[nodiscard]] const fc_runtime::Server& server() const { return *robot_server_; }",
        );
    });
    out.blank();
    out.line(" private:\n  const fc_runtime::Server* robot_server_;\n};");
}

/// Writes the head of a class whose methods are in a part for each group.
fn whole(out: &mut Source, name: &str, parts: &[String]) {
    let bases: Vec<String> = parts
        .iter()
        .map(|it| format!("public {it}<{name}>"))
        .collect();
    out.class(name, &bases);
    out.line(" public:");
}

/// Writes the streams of a group as methods of both sides.
pub fn parts(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    part(out, group, STREAMS, |out| {
        for stream in &group.streams {
            app(out, context, stream);
        }
    });
    if group.subscribed().next().is_some() {
        out.blank();
        part(out, group, STREAMER, |out| {
            for stream in group.subscribed() {
                robot(out, context, stream);
            }
        });
    }
}

fn part(
    out: &mut Source,
    group: &NamedGroup<'_, '_>,
    name: &str,
    methods: impl FnOnce(&mut Source),
) {
    out.docs(&Docs::said([
        format!("一组数据流，是 `{name}`（`Self`）的方法。"),
        format!("The streams of a group as methods of `{name}` (`Self`)."),
    ]));
    out.line("template <class Self>");
    out.line(format!("class {} {{", group.part(name)));
    out.line(" public:");
    out.enclose("", "};", methods);
}

fn app(out: &mut Source, context: &Context<'_>, stream: &Spelled<'_, Operation>) {
    let (name, code) = (&stream.of.name, &stream.code.spelling);
    let carried = context.content(stream);
    out.documented(&facts::method_docs(context, stream.of, |_| ()));
    let data = "return static_cast<const Self*>(this)->data().";
    if stream.sender == Side::Robot {
        let (ty, call) = match carried {
            Some(ty) => (
                format!("ContentSubscription<{ty}>"),
                format!("template subscribe_json<{ty}>"),
            ),
            None => ("Subscription".to_owned(), "subscribe".to_owned()),
        };
        let open = format!("[[nodiscard]] fc_runtime::{ty} subscribe_{name}(");
        out.parameters(&open, &[], ") const {");
        out.line(format!("  {data}{call}({code});"));
    } else {
        let (ty, call) = match carried {
            Some(ty) => (format!("const {ty}&"), "send_json"),
            None => ("std::string_view".to_owned(), "send"),
        };
        let open =
            format!("fc_runtime::Result<fc_runtime::Done, fc_runtime::DataError> send_{name}(");
        let parameters = ["std::uint32_t id".to_owned(), format!("{ty} content")];
        out.parameters(&open, &parameters, ") const {");
        out.line(format!("  {data}{call}({code}, id, content);"));
    }
    out.line("}");
}

fn robot(out: &mut Source, context: &Context<'_>, stream: &Spelled<'_, Operation>) {
    let (name, code) = (&stream.of.name, &stream.code.spelling);
    let (ty, call, value) = match context.content(stream) {
        Some(ty) => (format!("const {ty}&"), "send_stream_json", "content"),
        None => (
            "std::string".to_owned(),
            "send_stream",
            "std::move(content)",
        ),
    };
    out.documented(&facts::method_docs(context, stream.of, |_| ()));
    let open = format!("fc_runtime::Result<std::size_t, fc_runtime::PushError> send_{name}(");
    let parameters = [
        "std::optional<fc_runtime::ConnectionId> to".to_owned(),
        "std::uint32_t id".to_owned(),
        format!("{ty} content"),
    ];
    out.parameters(&open, &parameters, ") const {");
    out.line(format!(
        "  return static_cast<const Self*>(this)->server().{call}(to, {code}, id, {value});"
    ));
    out.line("}");
}
