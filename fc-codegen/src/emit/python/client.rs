//! A group's part of the app's stubs: methods for its commands, with and without `async`, and for its streams.

use super::group::part_of;
use super::literal::literal;
use super::modules::{GroupPart, NamedGroup};
use super::operations::constant;
use super::source::{Code, Python, method};
use crate::package::context::{Context, page_of};
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::name::free;
use crate::package::process;
use crate::package::source::Source;
use fc_spec::model::Operation;

/// The options of a call.
const OPTIONS: [&str; 2] = ["timeout", "repeat"];

/// Writes the union of a group's reports.
pub fn any_report(out: &mut Source, group: &NamedGroup<'_, '_>) {
    let Some(name) = group.part(GroupPart::AnyReport) else {
        return;
    };
    let reports = group.reports.iter();
    let union = Code::Union(reports.map(|it| it.request.ty.name.to_string()).collect());
    out.blank();
    union.write_in_parentheses(out, &format!("{name}: TypeAlias = "));
}

/// Writes the methods of a group's commands.
pub fn calls(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::Calls, ["Client", "指令", "commands"]);
    part_of(out, group, part, "rt.Calls", about, |out| {
        for command in &group.commands {
            out.blank();
            call(out, context, command);
        }
    });
}

/// Writes a method that calls a command: its parameters are the request and the options of the call.
fn calling(
    out: &mut Source,
    open: &str,
    command: &Call<'_>,
    returns: &str,
    body: impl FnOnce(&mut Source),
) {
    let request = &command.request.ty.name;
    let is_empty = command.request.fields().iter().all(|field| field.optional);
    let or_none = if is_empty { " | None = None" } else { "" };
    let request = format!("request: {request}{or_none}");
    let (timeout, repeat) = ("timeout: float | None = None", "repeat: bool | None = None");
    let parameters = ["self", &request, "*", timeout, repeat];
    method(out, open, &parameters, returns, body);
}

fn deprecated(out: &mut Source, command: &Call<'_>) {
    if let Some(deprecation) = &command.operation.deprecated {
        let note = literal(&facts::withdrawn_note(deprecation));
        Code::call("rt.deprecated", [note]).write(out, "@", "");
    }
}

/// Returns the reports that a command sets off, and their type.
fn followed<'c>(context: &'c Context<'_>, command: &'c Operation) -> (Vec<&'c Operation>, String) {
    let reports = process::set_off(context, command);
    let (reports, types): (Vec<_>, Vec<_>) = reports
        .map(|(_, report, messages)| (report, context.name_of(&messages.request.ty)))
        .unzip();
    (reports, types.join(" | "))
}

/// Returns the sentence about the errors of a refused call.
fn declared(error: &str) -> String {
    format!("`CallError.declared({error})` returns the error of a refused call.")
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let docs = facts::call_docs(context, operation, declared);
    deprecated(out, command);
    let response = command.response.ty.name.to_string();
    let (reports, types) = followed(context, operation);
    let mut arguments = vec![Code::Text(constant(context, operation))];
    arguments.extend(
        reports
            .iter()
            .map(|report| Code::Text(constant(context, report))),
    );
    let options = OPTIONS.map(|name| Code::named(name, name));
    let (word, returns, function) = if reports.is_empty() {
        arguments.push("request".into());
        ("async def", response, "await self.connection.call")
    } else {
        arguments.push(Code::named("request", "request"));
        let followable = format!("rt.Followable[{response}, {types}]");
        ("def", followable, "self._followable")
    };
    arguments.extend(options);
    let open = format!("{word} {}(", command.method);
    calling(out, &open, command, &returns, |out| {
        out.docstring(&docs);
        Code::call(function, arguments).write(out, "return ", "");
    });
}

/// Returns the parameter with the content of a stream.
pub fn content(context: &Context<'_>, stream: &Operation) -> String {
    format!("content: {}", context.content(stream).unwrap_or("bytes"))
}

fn subscribe(out: &mut Source, context: &Context<'_>, stream: &Operation) {
    let held = context.content(stream).unwrap_or("bytes");
    let returns = format!("rt.Subscription[{held}]");
    let open = format!("def subscribe_{}(", stream.name);
    method(out, &open, &["self"], &returns, |out| {
        out.docstring(&facts::method_docs(context, stream, |_| ()));
        Code::call("self.data.subscribe", [constant(context, stream)]).write(out, "return ", "");
    });
}

/// Returns the comment on a method that calls a command and follows one of its reports, of type `followed`.
fn follow_docs<'c>(
    context: &Context<'_>,
    command: &'c Operation,
    report: &Operation,
    followed: &str,
) -> Docs<'c> {
    let mut docs = Docs::titled(&command.title);
    docs.raw_lines([
        format!("先返回响应，再逐个返回它引起的 `{followed}`。"),
        format!("Returns the response, and then each `{followed}` that the command sets off."),
    ]);
    let mut all = process::set_off(context, command);
    if let Some((set_off, ..)) = all.find(|(_, it, _)| it.name == report.name) {
        process::ending(&mut docs, context, set_off, report);
    }
    docs.paragraph(context.links(&command.location, &page_of(command)));
    docs
}

/// Writes the methods of a group's commands without `async`. Each waits for the response.
pub fn sync_calls(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::SyncCalls, ["sync.Client", "指令", "commands"]);
    part_of(out, group, part, "rt.SyncCalls", about, |out| {
        for command in &group.commands {
            sync_call(out, context, command);
        }
    });
}

fn sync_call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let response = &command.response.ty.name;
    let options = ["request"].into_iter().chain(OPTIONS).map(Code::from);
    let told = |of: &[&Operation]| {
        let of = of.iter().map(|it| Code::Text(constant(context, it)));
        of.chain(options.clone()).collect::<Vec<Code>>()
    };
    out.blank();
    deprecated(out, command);
    let open = format!("def {}(", command.method);
    calling(out, &open, command, response, |out| {
        out.docstring(&facts::command_docs(context, operation, declared));
        Code::call("self._call", told(&[operation])).write(out, "return ", "");
    });
    let reports: Vec<_> = process::set_off(context, operation).collect();
    for (_, report, messages) in &reports {
        let short = format!("follow_{}", command.method);
        let long = format!("{short}_{}", report.name);
        let wishes: &[&str] = if reports.len() > 1 {
            &[&long]
        } else {
            &[&short, &long]
        };
        let name = free(wishes, |name| context.package.has_call(name));
        let followed = context.name_of(&messages.request.ty);
        let returns = format!("rt.SyncFollowing[{response}, {followed}]");
        let open = format!("def {name}(");
        out.blank();
        deprecated(out, command);
        calling(out, &open, command, &returns, |out| {
            out.docstring(&follow_docs(context, operation, report, followed));
            let arguments = told(&[operation, report]);
            Code::call("self._follow", arguments).write(out, "return ", "");
        });
    }
}

/// Writes the methods of a group's streams. The robot's streams come first.
pub fn streams(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let (part, about) = (GroupPart::Streams, ["Streams", "数据流", "streams"]);
    part_of(out, group, part, "rt.Streams", about, |out| {
        for stream in group.subscribed() {
            out.blank();
            subscribe(out, context, stream);
        }
        for stream in group.sent() {
            out.blank();
            send(out, context, stream);
        }
    });
}

fn send(out: &mut Source, context: &Context<'_>, stream: &Operation) {
    let parameters = ["self", "message_id: int", &content(context, stream)];
    let open = format!("async def send_{}(", stream.name);
    method(out, &open, &parameters, "None", |out| {
        out.docstring(&facts::method_docs(context, stream, |_| ()));
        let arguments = [&*constant(context, stream), "message_id", "content"];
        Code::call("self.data.send_stream", arguments).write(out, "await ", "");
    });
}
