//! `client.py`, `sync.py` and `robot.py`: the public classes, which combine the parts of all groups.

use super::modules::{GroupPart, ModulePlan};
use super::protocol;
use super::source::{Code, Python, method};
use crate::package::about;
use crate::package::context::Context;
use crate::package::ranges::pass_through;
use crate::package::source::Source;

/// Creates the head of a file: its docstring, and its imports from the standard library and the runtime.
fn head(context: &Context<'_>, template: &str) -> Source {
    let mut out = context.source();
    out.template(template, &[]);
    out.blank();
    out
}

/// Returns the bases of a class: a part of each group, then `own`.
fn bases_of(plan: &ModulePlan<'_, '_>, part: GroupPart, own: &[&str]) -> Vec<Code> {
    let parts = plan.parts(part).into_iter();
    parts.chain(own.iter().copied()).map(Code::from).collect()
}

/// Writes a class. The template with the name `docs` is its docstring.
fn class(
    out: &mut Source,
    name: &str,
    bases: Vec<Code>,
    docs: &str,
    body: impl FnOnce(&mut Source),
) {
    out.gap();
    Code::Call(format!("class {name}("), bases, ")").write(out, "", ":");
    out.enclose("", "", |out| {
        out.template(docs, &[]);
        body(out);
    });
}

/// Writes the class variable with the protocol of a stub.
fn speaks(out: &mut Source, context: &Context<'_>) {
    out.blank();
    out.line(format!(
        "protocol: ClassVar[rt.Protocol] = {}",
        protocol::name(context)
    ));
}

/// Generates `client.py`.
pub fn client(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let has_streams = !context.package.streams.is_empty();
    let mut out = head(context, "client_file");
    plan.import(
        &mut out,
        &[GroupPart::AnyReport, GroupPart::Calls, GroupPart::Streams],
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    out.blank();
    let mut reports = plan.parts(GroupPart::AnyReport);
    reports.push("rt.RawReport");
    let union = Code::Union(reports.into_iter().map(str::to_owned).collect());
    union.write_in_parentheses(&mut out, "AnyReport: TypeAlias = ");
    out.template("any_report", &[]);
    let bases = bases_of(plan, GroupPart::Calls, &["rt.Client[AnyReport]"]);
    class(&mut out, "Client", bases, "client", |out| {
        speaks(out, context);
    });
    if has_streams {
        let bases = bases_of(plan, GroupPart::Streams, &["rt.Streams"]);
        class(&mut out, "Streams", bases, "streams", |_| ());
    }
    out.finish()
}

/// Generates `sync.py`.
pub fn sync(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let mut out = head(context, "sync_file");
    out.import_from(".client", &["AnyReport"]);
    plan.import(&mut out, &[GroupPart::SyncCalls]);
    out.import_from(".protocol", &[&protocol::name(context)]);
    let bases = bases_of(plan, GroupPart::SyncCalls, &["rt.SyncClient[AnyReport]"]);
    class(&mut out, "Client", bases, "sync_client", |out| {
        speaks(out, context);
    });
    out.finish()
}

/// Generates `robot.py`.
pub fn robot(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let mut out = head(context, "robot_file");
    plan.import(
        &mut out,
        &[
            GroupPart::Handlers,
            GroupPart::PartialHandlers,
            GroupPart::Reporter,
            GroupPart::Streamer,
        ],
    );
    out.import_from(".protocol", &[&protocol::name(context)]);
    complete(&mut out, context, plan);
    let bases = bases_of(plan, GroupPart::PartialHandlers, &["Robot"]);
    class(&mut out, "PartialRobot", bases, "partial_robot", |_| ());
    let bases = vec!["rt.ExampleRobot".into()];
    class(&mut out, "ExampleRobot", bases, "example_robot", |out| {
        speaks(out, context);
    });
    let bases = bases_of(plan, GroupPart::Reporter, &["rt.Reporter"]);
    class(&mut out, "Reporter", bases, "reporter", |_| ());
    if !context.package.streams.is_empty() {
        let bases = bases_of(plan, GroupPart::Streamer, &["rt.Streamer"]);
        class(&mut out, "Streamer", bases, "streamer", |_| ());
    }
    out.finish()
}

fn complete(out: &mut Source, context: &Context<'_>, plan: &ModulePlan<'_, '_>) {
    let bases = bases_of(plan, GroupPart::Handlers, &["rt.Robot", "ABC"]);
    class(out, "Robot", bases, "complete_robot", |out| {
        speaks(out, context);
        for (name, range) in pass_through(context) {
            let parameters = ["self", "context: rt.Context", "request: rt.RawRequest"];
            let open = format!("async def {name}(");
            out.blank();
            out.line("@rt.left_out");
            method(out, &open, &parameters, "rt.Json", |out| {
                out.docstring(&about::refused(Some(range)));
                out.line("raise NotImplementedError");
            });
        }
    });
}
