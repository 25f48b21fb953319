//! The app's side: one method per command, and methods that follow its reports.

use super::group::{heading, part_name, part_of, parts, wrapper};
use super::operations::{deprecated, way};
use super::streams;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::group::Group;
use crate::package::items::{Call, Item};
use crate::package::process::{ending, set_off};
use crate::package::source::Source;

/// Generates `Client.kt`.
pub fn client_file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> Source {
    let mut out = context.source();
    let protocol = &context.package.name;
    let parts = parts(groups, "Client", |it| !it.commands.is_empty());
    out.docs(&Docs::said([
        "一个机器人，从 app 一侧看：每条指令一个方法。协程用 `suspend` 方法，Java 用 `Async` 方法。",
        "A robot as seen from the app: one method per command, `suspend` for coroutines and `Async` for Java.",
    ]));
    wrapper(&mut out, "Client", PROPERTY, CONNECTION, &parts);
    let supers: Vec<String> = [vec!["AutoCloseable".to_owned()], parts].concat();
    let values = [("heading", &*heading(")", &supers)), ("protocol", protocol)];
    out.template("client", &values);
    streams::for_app(&mut out, groups);
    out
}

const PROPERTY: &str = "connection: Connection";

const CONNECTION: [&str; 2] = [
    "底层连接。",
    "The underlying connection: raw commands and options of a call.",
];

const OPTIONS: &str = "options: CallOptions";
const OPTIONS_OR_NONE: &str = "options: CallOptions = CallOptions()";

/// Writes a group's part of `Client`: a method for each command.
pub fn part(out: &mut Source, context: &Context<'_>, group: &Group<'_, '_>) {
    if group.commands.is_empty() {
        return;
    }
    part_of(out, group, "Client", &part_name(group, "Client"), |out| {
        out.docs(&Docs::line(CONNECTION));
        out.line(format!("public val {PROPERTY}"));
        for command in &group.commands {
            call(out, context, command);
        }
    });
}

/// Returns `true` if a request needs no values.
pub fn is_bare(item: &Item<'_>) -> bool {
    item.fields().iter().all(|field| field.optional)
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let operation = command.operation;
    let mut docs = facts::command_docs(context, operation, |_| {
        "[fc.runtime.CallError.declared] returns the error of a refused call.".to_owned()
    });
    docs.raw("@throws fc.runtime.CallError if the call fails");
    out.documented(&docs);
    deprecated(out, operation);
    out.line("@JvmSynthetic");
    let (method, request, response) = (
        command.method,
        &command.request.ty.name,
        &command.response.ty.name,
    );
    let bare = is_bare(command.request).then(|| format!("{request} {{}}"));
    let given = format!("request: {request}");
    let parameters = match &bare {
        Some(bare) => [format!("{given} = {bare}"), OPTIONS_OR_NONE.to_owned()],
        None => [given.clone(), OPTIONS_OR_NONE.to_owned()],
    };
    function(
        out,
        &format!("public suspend fun {method}("),
        &parameters,
        &format!("): {response} ="),
        &format!("connection.call(Operations.{method}, request, options)"),
    );
    let mut twin = |parameters: &[String], body: &str| {
        for_java(out, method);
        deprecated(out, operation);
        let open = format!("public fun {method}Async(");
        let close = format!("): CompletableFuture<{response}> =");
        function(out, &open, parameters, &close, body);
    };
    let given_all = [given.clone(), OPTIONS.to_owned()];
    twin(
        &given_all,
        &format!("connection.callAsync(Operations.{method}, request, options)"),
    );
    // `@JvmOverloads` does not work in an interface.
    twin(&[given], &format!("{method}Async(request, CallOptions())"));
    if let Some(bare) = bare {
        twin(&[], &format!("{method}Async({bare}, CallOptions())"));
    }
    followed(out, context, command, &parameters, &given_all);
}

/// Writes the comment on the form of a method for Java.
pub fn for_java(out: &mut Source, method: &str) {
    out.template("for_java", &[("method", method)]);
}

/// Writes a method for each kind of report that a command sets off, and its form for Java.
fn followed(
    out: &mut Source,
    context: &Context<'_>,
    command: &Call<'_>,
    parameters: &[String],
    java_parameters: &[String],
) {
    let operation = command.operation;
    let (method, response) = (command.method, &command.response.ty.name);
    let followed: Vec<_> = set_off(context, operation).collect();
    for (set_off, report, messages) in &followed {
        let Some(reported) = context.package.call(report) else {
            continue;
        };
        let reported_type = &reported.request.ty.name;
        let mut docs = Docs::default();
        docs.raw_lines([
            format!("[{method}]：先返回响应，再逐个返回它引起的 [{reported_type}]。"),
            format!("[{method}]: returns the response, and then each [{reported_type}] that the command sets off."),
        ]);
        ending(&mut docs, context, set_off, report);
        docs.raw("@throws fc.runtime.CallError if the response is not a success");
        let ties = set_off.tied.iter().map(|tie| {
            let side = tie.side.name();
            let here = operation.messages();
            let here = here.map(|it| way(context, &it.body(tie.side).ty, &tie.command, side));
            let there = way(context, &messages.request.ty, &tie.report, "report");
            format!("sameOrUnsaid({}, {there})", here.unwrap_or_default())
        });
        let ties: Vec<String> = ties.collect();
        let kind = reported.method;
        out.documented(&docs);
        deprecated(out, operation);
        out.line("@JvmSynthetic");
        let name = if followed.len() == 1 {
            format!("{method}Followed")
        } else {
            format!("{method}FollowedBy{reported_type}")
        };
        let open = format!("public suspend fun {name}(");
        let following = format!("Following<{response}, {reported_type}>");
        let close = format!("): {following} =");
        let call =
            format!("connection.follow(Operations.{method}, request, Operations.{kind}, options)");
        if ties.is_empty() {
            function(out, &open, parameters, &close, &call);
        } else {
            signature(out, &open, parameters, &close, |out| {
                let used = |word: &str| {
                    if ties.iter().any(|tie| tie.contains(&format!("({word}."))) {
                        word.to_owned()
                    } else {
                        "_".to_owned()
                    }
                };
                let names = format!("_, {}, report", used("response"));
                out.enclose(&format!("{call} {{ {names} ->"), "}", |out| {
                    out.line(ties.join(" && "));
                });
            });
        }
        for_java(out, &name);
        deprecated(out, operation);
        function(
            out,
            &format!("public fun {name}Async("),
            java_parameters,
            &format!("): CompletableFuture<{following}> ="),
            &format!("connection.future {{ {name}(request, options) }}"),
        );
    }
}

/// Writes a function with an expression body. The function has several lines if it exceeds one.
fn function(out: &mut Source, open: &str, parameters: &[String], close: &str, body: &str) {
    let joined = parameters.join(", ");
    out.line_or([open, &joined, close, " ", body], |out| {
        signature(out, open, parameters, close, |out| out.line(body));
    });
}

/// Writes a function with its body below. Each parameter has a line if all exceed one.
fn signature(
    out: &mut Source,
    open: &str,
    parameters: &[String],
    close: &str,
    body: impl FnOnce(&mut Source),
) {
    let joined = parameters.join(", ");
    if out.has_room([open, &joined, close]) {
        return out.enclose(&[open, &joined, close].concat(), "", body);
    }
    out.lines(open, parameters, "");
    out.enclose(close, "", body);
}
