//! The streams of the data port on both sides.

use super::client::for_java;
use super::group::{heading, part_name, part_of, parts, wrapper};
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::group::Group;
use crate::package::items::Spelled;
use crate::package::source::Source;
use fc_spec::model::{Operation, Side};

/// Writes the app's side, if there are streams.
pub fn for_app(out: &mut Source, groups: &[Group<'_, '_>]) {
    let parts = parts(groups, "Streams", |it| !it.streams.is_empty());
    if parts.is_empty() {
        return;
    }
    out.documented(&Docs::said([
        "数据端口上的数据流：订阅机器人的数据流，发送 app 的数据流。",
        "The streams of the data port. Subscribe to those of the robot, and send those of the app.",
    ]));
    wrapper(out, "Streams", DATA, DATA_DOCS, &parts);
    out.line(heading(")", &parts));
}

/// Writes the robot's side, if it sends any stream.
pub fn for_robot(out: &mut Source, groups: &[Group<'_, '_>]) {
    let parts = parts(groups, "Streamer", |it| it.subscribed().next().is_some());
    if parts.is_empty() {
        return;
    }
    out.documented(&Docs::said(["机器人发送的数据流：每个数据流一个方法，返回收下它的数据连接数。", "Sends the streams of the robot: one method per stream, which returns the number of data connections that took it."]));
    wrapper(out, "Streamer", SERVER, SERVER_DOCS, &parts);
    out.line(heading(")", &parts));
}

const DATA: &str = "data: DataConnection";

const DATA_DOCS: [&str; 2] = [
    "数据连接。",
    "The data connection: its state, and frames without a subscription.",
];

/// The property that sends the robot's reports and streams.
pub const SERVER: &str = "server: Server";

/// The comment on that property.
pub const SERVER_DOCS: [&str; 2] = ["由它发送。", "The server that sends them."];

/// Writes the streams of a group.
pub fn part(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    if group.streams.is_empty() {
        return;
    }
    part_of(out, group, "Streams", &part_name(group, "Streams"), |out| {
        out.docs(&Docs::line(DATA_DOCS));
        out.line(format!("public val {DATA}"));
        for stream in &group.streams {
            app(out, context, stream);
        }
    });
    if group.subscribed().next().is_none() {
        return;
    }
    part_of(
        out,
        group,
        "Streamer",
        &part_name(group, "Streamer"),
        |out| {
            out.docs(&Docs::line(SERVER_DOCS));
            out.line(format!("public val {SERVER}"));
            for stream in group.subscribed() {
                robot(out, context, stream);
            }
        },
    );
}

fn app(out: &mut Source, context: &Context<'_>, stream: &Spelled<'_, Operation>) {
    let (name, code) = (super::method_of(stream), &stream.code.spelling);
    let carried = context.content(stream);
    out.documented(&facts::method_docs(context, stream.of, |_| ()));
    if stream.sender == Side::Robot {
        let (ty, more) = carried.map_or(("ByteArray", String::new()), |ty| (ty, format!(", {ty}")));
        let head = format!("public fun subscribe{name}(): Subscription<{ty}> =");
        out.line(format!("{head} data.subscribe({code}{more})"));
    } else {
        let ty = carried.unwrap_or("ByteArray");
        out.line("@JvmSynthetic");
        out.line(format!(
            "public suspend fun send{name}(id: Long, content: {ty}): Unit = data.send({code}, id, content)"
        ));
        out.documented(&for_java(&format!("send{name}")));
        out.line(format!(
            "public fun send{name}Async(id: Long, content: {ty}): CompletableFuture<Void?> ="
        ));
        out.line(format!("    data.sendAsync({code}, id, content)"));
    }
}

fn robot(out: &mut Source, context: &Context<'_>, stream: &Spelled<'_, Operation>) {
    let (name, code) = (super::method_of(stream), &stream.code.spelling);
    let ty = context.content(stream).unwrap_or("ByteArray");
    out.documented(&facts::method_docs(context, stream.of, |_| ()));
    out.line("@JvmSynthetic");
    out.line(format!(
        "public suspend fun send{name}(audience: Audience, id: Long, content: {ty}): Int ="
    ));
    out.line(format!(
        "    server.sendStream(audience, {code}, id, content)"
    ));
    out.documented(&for_java(&format!("send{name}")));
    out.line(format!(
        "public fun send{name}Async(audience: Audience, id: Long, content: {ty}): CompletableFuture<Int> ="
    ));
    out.line(format!(
        "    server.sendStreamAsync(audience, {code}, id, content)"
    ));
}
