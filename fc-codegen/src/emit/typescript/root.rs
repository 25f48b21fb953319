//! `index.ts`: the package as a program imports it.

use super::context::Context;
use super::source::named;
use crate::package::about;
use crate::package::docs::Docs;
use fc_spec::model::Side;

/// The values of the runtime that apps and robots need.
const RUNTIME: &str = "\
    AppStreams BodyError CallError ConditionError ConnectError DataConnection DataError FollowError \
    Following PushError Refusal Reports Server Subscription TransportError acceptedIn checked \
    defaultBackoff fromJson isError isFinal isInOrder isKnown lossText mayFollow nameOf redacted toJson \
    withDefaults";

/// The types of the runtime that apps and robots need.
const RUNTIME_TYPES: &str = "\
    AckOutcome Acknowledgement Answer AppStream Audience Backoff CallErrorKind CallOptions ClientConfig \
    ClientCounters Clock ConnectionId ConnectionState Context DataErrorKind Effect EndedCall \
    Extra ExtraKey FollowableCall Followed Gzip JsonText Limits Log LogFields LogLevel Loss MessageOf \
    Platform PushErrorKind RawRequest RawResponse ServerConfig ServerCounters ServerPlatform StreamFrame \
    StreamItem Transport UnknownReport";

/// Returns `true` if the root exports a runtime item with this name.
pub fn has(name: &str) -> bool {
    let names = [RUNTIME, RUNTIME_TYPES].into_iter();
    names
        .flat_map(str::split_whitespace)
        .any(|known| known == name)
}

pub fn file(context: &Context<'_>) -> String {
    let mut out = context.source();
    let protocol = &context.model().protocol;
    let mut docs = Docs::titled(&protocol.title);
    docs.text(&protocol.about);
    about::version(&mut docs, context.model());
    docs.raw("An app starts with {@link Client}, a robot with {@link PartialRobot} or {@link Robot} and {@link serve}.");
    docs.raw("@module");
    out.docs(&docs);
    out.blank();
    // A type of the spec takes precedence over a runtime item with the same name.
    let free = |names: &'static str| -> Vec<&'static str> {
        let names = names.split_whitespace();
        names
            .filter(|name| !context.package.has_type(name))
            .collect()
    };
    let package = &context.package;
    let has_streams = !package.streams.is_empty();
    named(&mut out, "export", free(RUNTIME), "../src/runtime.ts");
    named(
        &mut out,
        "export type",
        free(RUNTIME_TYPES),
        "../src/runtime.ts",
    );
    let mut client = vec!["Client"];
    client.extend(has_streams.then_some("Streams"));
    named(&mut out, "export", client, "./client.ts");
    out.line("export type { AnyReport } from './client.ts'");
    out.line("export * as commands from './commands.ts'");
    out.line("export * as defaults from './defaults.ts'");
    out.line("export * from './messages.ts'");
    out.line(format!(
        "export {{ {} }} from './operations.ts'",
        package.name
    ));
    out.line("export * as reports from './reports.ts'");
    let mut robot = vec!["PartialRobot", "serve"];
    robot.extend((!context.commands().is_empty()).then_some("ExampleRobot"));
    robot.extend((!context.reports().is_empty()).then_some("Reporter"));
    robot.extend(
        package
            .streams
            .iter()
            .any(|it| it.sender == Side::Robot)
            .then_some("Streamer"),
    );
    named(&mut out, "export", robot, "./robot.ts");
    out.line("export type { Robot } from './robot.ts'");
    out.line("export * as schemas from './schemas.ts'");
    out.line("export * as streams from './streams.ts'");
    out.line("export * as tables from './tables.ts'");
    named(&mut out, "export", ["ResultCode"], "./wire.ts");
    named(
        &mut out,
        "export type",
        ["RequestEnvelope", "ResponseEnvelope"],
        "./wire.ts",
    );
    out.finish()
}
