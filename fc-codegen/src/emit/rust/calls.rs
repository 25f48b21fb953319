//! Stub methods that carry the messages of one group, in the group's file.
//!
//! A new command changes no file of another group. Readers of a message find the method that sends it in the same file.

use super::context::Context;
use super::literal::literal;
use super::source::Source;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::{Call, Module};
use fc_spec::model::Kind;

/// Writes the stub methods for the messages of a module.
///
/// Types of other modules appear with their path, because each stub has a separate feature.
pub fn methods(out: &mut Source, context: &Context<'_>, module: &Module<'_>) {
    let commands = calls(context, module, Kind::Command);
    let reports = calls(context, module, Kind::Report);
    stub(out, "client", "crate::Client", &commands, |out, command| {
        call(out, context, command);
    });
    stub(
        out,
        "blocking",
        "crate::blocking::Client",
        &commands,
        blocking_call,
    );
    stub(out, "server", "crate::Reporter", &reports, |out, report| {
        push(out, context, report);
    });
}

/// Returns the calls of a kind whose requests are in the module.
fn calls<'p>(context: &'p Context<'_>, module: &'p Module<'_>, kind: Kind) -> Vec<Call<'p>> {
    let items = module.items.iter();
    let calls = items.filter_map(|item| context.package.opened_by(item));
    calls.filter(|call| call.operation.kind() == kind).collect()
}

/// Writes an `impl` of a stub, unless it has no methods.
fn stub(
    out: &mut Source,
    feature: &str,
    path: &str,
    calls: &[Call<'_>],
    method: impl Fn(&mut Source, &Call<'_>),
) {
    if calls.is_empty() {
        return;
    }
    out.blank();
    out.line(format!("#[cfg(feature = \"{feature}\")]"));
    out.block(format!("impl {path}"), |out| {
        for call in calls {
            out.blank();
            method(out, call);
        }
    });
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let docs = facts::call_docs(context, command.operation, |error| {
        format!(
            "[`CallError::declared`](fc_runtime::CallError::declared) returns the [`{error}`] of a refused call."
        )
    });
    out.docs(&docs);
    deprecation(out, command);
    let request = &command.request.ty.name;
    let protocol = &context.package.name;
    out.list(
        &format!("pub fn {}<'a>(", command.method),
        &["&'a self".to_owned(), format!("request: &'a {request}")],
        &format!(") -> fc_runtime::Call<'a, crate::{protocol}, {request}> {{"),
    );
    out.template("call", &[]);
}

fn blocking_call(out: &mut Source, command: &Call<'_>) {
    let method = command.method;
    let mut docs = Docs::titled(&command.operation.title);
    docs.raw(format!(
        "See [`Client::{method}`](crate::Client::{method})."
    ));
    out.docs(&docs);
    deprecation(out, command);
    let request = format!("request: &{}", command.request.ty.name);
    let response = &command.response.ty.name;
    out.list(
        &format!("pub fn {}(", command.method),
        &["&self".to_owned(), request],
        &format!(") -> Result<{response}, fc_runtime::CallError> {{"),
    );
    out.template("call", &[]);
}

fn deprecation(out: &mut Source, command: &Call<'_>) {
    if let Some(deprecation) = &command.operation.deprecated {
        let note = literal(&facts::withdrawn_note(deprecation));
        out.attribute("#[deprecated(", &[format!("note = {note}")], ")]");
    }
}

fn push(out: &mut Source, context: &Context<'_>, report: &Call<'_>) {
    let docs = facts::method_docs(context, report.operation, |docs| {
        docs.paragraph("Returns the outcome at each connection.");
    });
    out.docs(&docs);
    let params = [
        "&self".to_owned(),
        "audience: fc_runtime::Audience".to_owned(),
        format!("report: &{}", report.request.ty.name),
    ];
    out.list(
        &format!("pub async fn {}(", report.method),
        &params,
        ") -> Result<Vec<fc_runtime::Acknowledgement>, fc_runtime::PushError> {",
    );
    out.line("    self.handle.push(audience, report).await");
    out.line("}");
}
