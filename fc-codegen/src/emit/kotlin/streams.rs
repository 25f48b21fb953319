//! The streams of the data port on both sides.

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
    out.template("app_streams", &[]);
    wrapper(out, "Streams", DATA, DATA_DOCS, &parts);
    out.line(heading(")", &parts));
}

/// Writes the robot's side, if it sends any stream.
pub fn for_robot(out: &mut Source, groups: &[Group<'_, '_>]) {
    let parts = parts(groups, "Streamer", |it| it.subscribed().next().is_some());
    if parts.is_empty() {
        return;
    }
    out.template("robot_streams", &[]);
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
        out.template("send", &[("name", &name), ("ty", ty), ("code", code)]);
    }
}

fn robot(out: &mut Source, context: &Context<'_>, stream: &Spelled<'_, Operation>) {
    let (name, code) = (super::method_of(stream), &stream.code.spelling);
    let ty = context.content(stream).unwrap_or("ByteArray");
    out.documented(&facts::method_docs(context, stream.of, |_| ()));
    out.template(
        "send_of_robot",
        &[("name", &name), ("ty", ty), ("code", code)],
    );
}
