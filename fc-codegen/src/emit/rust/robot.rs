//! `robot.rs`: the robot's stub.
//!
//! The file contains a trait with one method per command, a robot that responds with the spec's examples, and a typed
//! sender of reports.

use super::context::{Context, message};
use super::source::Source;
use super::streams;
use crate::package::about;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::ranges::{UNKNOWN, pass_through};
use fc_spec::model::{CodeRange, Side};

/// Generates `robot.rs`.
pub fn robot_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;
    let commands = context.commands();
    let ranges = pass_through(context);

    let mut out = context.source();
    out.head("robot_head", &[]);
    imports(&mut out, context, protocol, &commands);
    out.blank();
    robot(&mut out, context, protocol, &commands, &ranges);
    example(&mut out, protocol, &commands);
    let allowed = if context.reports().is_empty() {
        "    #[allow(dead_code, reason = \"the spec has no reports\")]"
    } else {
        ""
    };
    let values = [("allowed", allowed), ("protocol", protocol)];
    out.template("reporter", &values);
    if streams::are_any(context) {
        out.blank();
        streams::robot(&mut out, context, protocol);
    }
    out.finish()
}

fn imports(out: &mut Source, context: &Context<'_>, protocol: &str, commands: &[Call<'_>]) {
    if !commands.is_empty() || streams::has_type(context, &[Side::Robot]) {
        out.import("super", &["messages"]);
    }
    out.import("super::protocol", &[protocol]);
    out.import("fc_derive", &["dispatch"]);
    let mut runtime = vec![
        "Context",
        "RawAnswer",
        "RawRequest",
        "Refusal",
        "ServerHandle",
    ];
    if !commands.is_empty() {
        runtime.push("Message");
    }
    runtime.extend(streams::imports_of_robot(context));
    out.import("fc_runtime", &runtime);
}

/// Writes the signature of a method with these types of its context, request, response and refusal.
pub fn signature(out: &mut Source, name: &str, types: [&str; 4], end: &str) {
    let [context, request, response, refusal] = types;
    let open = format!("async fn {name}(");
    let close = format!(") -> Result<{response}, {refusal}>{end}");
    out.list(&open, &["&self", context, request], &close);
}

fn robot(
    out: &mut Source,
    context: &Context<'_>,
    protocol: &str,
    commands: &[Call<'_>],
    ranges: &[(String, &CodeRange)],
) {
    out.template("complete_robot", &[("protocol", protocol)]);
    out.block("pub trait Robot: Send + Sync + 'static", |out| {
        let cx = format!("context: Context<{protocol}>");
        for command in commands {
            let docs = facts::command_docs(context, command.operation, |error| {
                format!("Convert a [`messages::{error}`] to refuse the command with it.")
            });
            out.documented(&docs);
            let request = format!("request: {}", message(command.request));
            let types = [&cx, &request, &message(command.response), "Refusal"];
            signature(out, command.method, types, ";");
        }
        for (name, range) in ranges {
            out.documented(&about::refused(Some(range)));
            out.line(format!(
                "#[fc(range = {}..={})]",
                range.first_spelling, range.last_spelling
            ));
            raw(out, protocol, name);
        }
        out.documented(&about::refused(None));
        out.line("#[fc(unknown)]");
        raw(out, protocol, UNKNOWN);
    });
}

/// Writes a method for requests without a type, which refuses them.
fn raw(out: &mut Source, protocol: &str, name: &str) {
    let cx = format!("context: Context<{protocol}>");
    let types = [&cx, "request: RawRequest", "RawAnswer", "Refusal"];
    signature(out, name, types, " {");
    out.template("raw", &[("protocol", protocol)]);
}

fn example(out: &mut Source, protocol: &str, commands: &[Call<'_>]) {
    out.template("example", &[]);
    out.blank();
    out.block("impl Robot for ExampleRobot", |out| {
        for command in commands {
            let request = format!("_: {}", message(command.request));
            let response = message(command.response);
            let name = if command.may_move() { "context" } else { "_" };
            let cx = format!("{name}: Context<{protocol}>");
            out.blank();
            let types = [&cx, &request, &response, "Refusal"];
            signature(out, command.method, types, " {");
            if command.may_move() {
                out.template("example_method", &[]);
            }
            out.line(format!("    Ok({response}::example())\n}}"));
        }
    });
}
