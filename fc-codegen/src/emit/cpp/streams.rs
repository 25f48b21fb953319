//! The streams of the data port on both sides.

use super::groups::{self, NamedGroup};
use crate::package::context::Context;
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
    out.blank();
    let values = [("class", &*whole(out, STREAMS, &parts))];
    out.template("streams", &values);
}

/// Writes the robot's side, if it sends any stream.
pub fn for_robot(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let parts = groups::parts(groups, STREAMER, |it| it.subscribed().next().is_some());
    if parts.is_empty() {
        return;
    }
    out.template("streamer", &[]);
    sender(out, STREAMER, &parts, ["数据流", "streams"]);
}

/// Writes a class that sends something of the robot.
pub fn sender(out: &mut Source, name: &str, parts: &[String], [zh, en]: [&str; 2]) {
    let class = &*whole(out, name, parts);
    let values = [("class", class), ("name", name), ("zh", zh), ("en", en)];
    out.template("sender", &values);
}

/// Returns the head of a class whose methods are in a part for each group.
pub fn whole(out: &Source, name: &str, parts: &[String]) -> String {
    let bases = parts.iter().map(|it| format!("public {it}<{name}>"));
    out.class(name, &bases.collect::<Vec<_>>())
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
    out.template("stream_part", &[("name", name)]);
    group.mixin(out, name, methods);
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
