//! `client.ts`: the app's side, whose methods the groups declare.

use super::context::{Context, own};
use super::group::{Group, What, merged, parts};
use super::messages::{deprecated, union};
use super::operations::carried;
use super::protocol;
use super::source::{alternatives, head, named};
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::process::{is_followed, set_off};
use crate::package::source::Source;
use fc_spec::model::{Operation, Side};

pub fn file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> String {
    let has_commands = groups.iter().any(|it| it.has(What::Commands));
    let has_streams = groups.iter().any(|it| it.has(What::Streams));
    let mut out = head(
        context,
        [
            "app 端：每条指令一个方法。",
            "The app's side: one method per command.",
        ],
    );
    let mut names = vec!["Connection", "dial", "dialLater"];
    names.extend(has_commands.then_some("addCalls"));
    names.extend(has_streams.then_some("addAppStreams"));
    named(&mut out, "import", names, "../src/runtime.ts");
    let mut names = vec!["ClientConfig", "Platform", "UnknownReport"];
    names.extend(has_streams.then_some("DataConnection"));
    named(&mut out, "import type", names, "../src/runtime.ts");
    if has_commands || has_streams || groups.iter().any(|it| it.has(What::Reports)) {
        out.line("import type * as messages from './messages.ts'");
    }
    let (protocol, name) = protocol::imported(context);
    let mut names = vec![name];
    names.extend(has_commands.then(|| "service".to_owned()));
    names.extend(has_streams.then(|| "streams".to_owned()));
    named(&mut out, "import", names, "./operations.ts");
    out.blank();
    out.template("any_report", &[]);
    let mut reports = parts(context, groups, "report", What::Reports);
    reports.push("UnknownReport".to_owned());
    union(&mut out, "AnyReport", &reports);
    out.blank();
    let calls = parts(context, groups, "calls", What::Commands);
    let calls = if has_commands {
        merged(&mut out, "Client", ["指令", " of commands"], &calls);
        CALLS
    } else {
        ""
    };
    let values = [("calls", calls), ("protocol", &protocol)];
    out.template("client", &values);
    if has_streams {
        let parts = parts(context, groups, "streams", What::Streams);
        merged(&mut out, "Streams", ["数据流", " of streams"], &parts);
        out.template("streams_class", &[]);
    }
    out.finish()
}

/// The statement that gives `Client` the methods of the groups.
const CALLS: &str = "  static {\n    addCalls(Client, service.methods)\n  }\n";

/// Returns the runtime types that a group's part of the app's side names.
pub fn runtime_types(context: &Context<'_>, group: &Group<'_, '_>) -> Vec<&'static str> {
    let follows = |call: &Call<'_>| is_followed(context, call.operation);
    let mut names = Vec::new();
    names.extend(group.has(What::Commands).then_some("CallOptions"));
    names.extend(
        group
            .commands
            .iter()
            .any(follows)
            .then_some("FollowableCall"),
    );
    names.extend(group.has(What::Reports).then_some("Reported"));
    names.extend(group.has(What::RobotStreams).then_some("Subscription"));
    names
}

/// Writes a group's part of the app's side.
pub fn group(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    group.interface(out, context, "calls", &group.commands, |out, command| {
        call(out, context, command);
    });
    if group.has(What::Reports) {
        out.template("report", &[]);
        let reported = own(context, "Reported");
        let reports = group.reports.iter().map(|report| {
            let name = &report.request.ty.name;
            let docs = Docs::titled(&report.operation.title);
            (docs, format!("{reported}<'{name}', {name}>"))
        });
        let name = group.part(context, "report");
        alternatives(out, &name, &reports.collect::<Vec<_>>());
    }
    group.interface(out, context, "streams", &group.streams, |out, stream| {
        let (name, held) = (&stream.name, carried(context, stream, ""));
        out.docs(&stream_docs(context, stream));
        if stream.sender == Side::Robot {
            let result = format!("{}<{held}>", own(context, "Subscription"));
            method(out, &format!("subscribe{name}"), &[], &result);
        } else {
            let parameters = ["id: number".to_owned(), format!("content: {held}")];
            method(out, &format!("send{name}"), &parameters, "Promise<void>");
        }
    });
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let mut docs = facts::call_docs(context, operation, |error| {
        format!("`CallError.declared` returns the {{@link {error}}} of a refused call.")
    });
    deprecated(&mut docs, operation.deprecated.as_ref());
    out.docs(&docs);
    let [request, response] = [command.request, command.response].map(|it| &it.ty.name);
    let is_optional = command.request.fields().iter().all(|field| field.optional);
    let mark = if is_optional { "?" } else { "" };
    let answer = match set_off(context, operation).next() {
        Some((_, _, report)) => {
            let report = context.name_of(&report.request.ty);
            format!("{}<{response}, {report}>", own(context, "FollowableCall"))
        }
        None => format!("Promise<{response}>"),
    };
    let parameters = [
        format!("request{mark}: {request}"),
        format!("options?: {}", own(context, "CallOptions")),
    ];
    method(out, command.method, &parameters, &answer);
}

pub fn method(out: &mut Source, name: &str, parameters: &[String], result: &str) {
    out.list(&format!("{name}("), parameters, &format!("): {result}"));
}

/// Returns the comment on the method of a stream.
pub fn stream_docs<'m>(context: &Context<'_>, stream: &'m Operation) -> Docs<'m> {
    let mut docs = facts::method_docs(context, stream, |_| ());
    deprecated(&mut docs, stream.deprecated.as_ref());
    docs
}
