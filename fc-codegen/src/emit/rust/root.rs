//! `lib.rs`, `prelude.rs` and `messages/mod.rs`: the modules of the crate and its re-exports.

use super::context::Context;
use super::source::Source;
use super::streams;
use crate::package::about;
use crate::package::docs::Docs;
use crate::package::source::join;

/// Lints that names in the spec can trigger, each with the reason.
const ALLOWED: &[(&str, &str)] = &[
    (
        "clippy::doc_markdown",
        "the spec contains the prose and its wire keys",
    ),
    (
        "clippy::large_enum_variant",
        "one report or one choice is handled at a time",
    ),
    (
        "clippy::missing_errors_doc",
        "the error type lists the errors of a call",
    ),
    (
        "clippy::struct_excessive_bools",
        "the protocol has that many flags",
    ),
    (
        "clippy::struct_field_names",
        "fields are named after the wire's keys",
    ),
    (
        "clippy::wildcard_imports",
        "stubs and descriptors deal with every message",
    ),
    (
        "clippy::too_many_lines",
        "tables and traits are as long as the spec",
    ),
];

/// Generates `lib.rs`.
pub fn root_file(context: &Context<'_>) -> String {
    let model = context.model();
    let mut out = context.source();
    let mut docs = Docs::titled(&model.protocol.title);
    docs.text(&model.protocol.about);
    about::version(&mut docs, model);
    docs.paragraph(
        "An app starts with `Client`, a robot with `PartialRobot` or `Robot`. `examples/app.rs` and `examples/robot.rs` of \
         this crate show both.",
    );
    out.inner_docs(&docs);
    out.blank();
    for (lint, reason) in ALLOWED {
        out.attribute(
            "#![allow(",
            &[(*lint).to_owned(), format!("reason = \"{reason}\"")],
            ")]",
        );
    }
    let (app, robot) = stubs(context);
    let ids = if context.package.ids.is_empty() {
        ""
    } else {
        "pub mod ids;"
    };
    out.template("modules", &[("ids", ids), ("client", &join(&app))]);
    every_id(&mut out, "", context);
    // Only types: a group can have the name of a crate, which a glob import must not hide.
    every_type(&mut out, "", context);
    let package = &context.package;
    let mut names = vec![
        &*package.name,
        "FrameHeader",
        "RequestEnvelope",
        "ResponseEnvelope",
        "ResultCode",
    ];
    if !package.streams.is_empty() {
        names.push("StreamCode");
    }
    names.sort_unstable();
    out.filled("pub use protocol::{", &names, "};");
    out.line("#[cfg(feature = \"server\")]");
    let robot: Vec<&str> = std::iter::once("ExampleRobot").chain(robot).collect();
    out.filled("pub use robot::{", &robot, "};");
    out.finish()
}

/// Re-exports the id types, whose module is at `path`.
fn every_id(out: &mut Source, path: &str, context: &Context<'_>) {
    let mut ids: Vec<&str> = context.package.ids.iter().map(|id| &*id.name).collect();
    ids.sort_unstable();
    if !ids.is_empty() {
        out.filled(&format!("pub use {path}ids::{{"), &ids, "};");
    }
}

/// Returns the public items of the app's stub and of the robot's stub.
fn stubs(context: &Context<'_>) -> (Vec<&'static str>, Vec<&'static str>) {
    let mut app = vec!["AnyReport", "Client", "Reports"];
    let mut robot = vec!["PartialRobot", "Reporter", "Robot", "RobotService"];
    if streams::are_any(context) {
        app.push("Streams");
        robot.push("Streamer");
    }
    (app, robot)
}

/// Re-exports the types of all groups, whose modules are at `path`.
fn every_type(out: &mut Source, path: &str, context: &Context<'_>) {
    let modules = &context.package.modules;
    let types: Vec<String> = modules
        .iter()
        .map(|module| format!("{}::*", module.name))
        .collect();
    match types.as_slice() {
        [] => {}
        [types] => out.line(format!("pub use {path}messages::{types};")),
        types => out.filled(&format!("pub use {path}messages::{{"), types, "};"),
    }
}

/// The types of the runtime that an app needs.
const FOR_APPS: &str = "\
    Backoff CallError CallOptions ClientConfig ConnectError ConnectionState DataConnection Loss";

/// The types of the runtime that a robot needs.
const FOR_ROBOTS: &str = "\
    AckOutcome Acknowledgement Audience ConnectionId Context PushError Server ServerConfig \
    ServerHandle";

/// The types of the runtime that both need.
const FOR_BOTH: &str = "\
    BodyError Bytes64 Command DeclaredError Effect Extra Json Message Protocol Refusal Report";

/// Generates `prelude.rs`.
pub fn prelude(context: &Context<'_>, krate: &str) -> String {
    let mut out = context.source();
    out.head("prelude", &[("krate", krate)]);
    every_id(&mut out, "crate::", context);
    every_type(&mut out, "crate::", context);
    out.line(format!(
        "pub use crate::protocol::{{{}, ResultCode}};",
        context.package.name
    ));
    // A type of the spec takes precedence over a runtime type with the same name.
    let of_runtime = |out: &mut Source, names: &str| {
        let names = names.split_whitespace();
        let names: Vec<&str> = names
            .filter(|name| !context.package.has_type(name))
            .collect();
        out.filled("pub use fc_runtime::{", &names, "};");
    };
    of_runtime(&mut out, FOR_BOTH);
    let (app, robot) = stubs(context);
    for (feature, module, stub, names) in [
        ("client", "client", app, FOR_APPS),
        ("server", "robot", robot, FOR_ROBOTS),
    ] {
        out.blank();
        out.line(format!("#[cfg(feature = \"{feature}\")]"));
        out.filled(&format!("pub use crate::{module}::{{"), &stub, "};");
        out.line(format!("#[cfg(feature = \"{feature}\")]"));
        of_runtime(&mut out, names);
    }
    out.finish()
}

/// Generates `messages/mod.rs`.
pub fn messages(context: &Context<'_>) -> String {
    let modules = &context.package.modules;
    let mut out = context.source();
    out.head("messages", &[]);
    for module in modules {
        out.line(format!("pub mod {};", module.name));
    }
    out.blank();
    for module in modules {
        out.line(format!("pub use self::{}::*;", module.name));
    }
    out.finish()
}
