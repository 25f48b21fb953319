//! The app's stub: a class with the methods of its groups, one per command.
//!
//! The stub also contains one variant over all reports.

use super::groups::{NamedGroup, with_commands, with_reports};
use super::layout::{Includes, header_file, literal, source_file};
use super::streams;
use crate::package::context::Context;
use crate::package::facts;
use crate::package::items::Call;
use crate::package::source::Source;

/// Generates `client.hpp`.
pub fn header(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let includes = Includes::new(
        context,
        &["chrono", "memory", "optional", "utility", "variant"],
        &["messages", "protocol"],
        &["client", "following", "types"],
    );
    header_file(context, &includes, |out| {
        reports(out, groups);
        out.blank();
        client(out, groups);
        out.blank();
        for calls in with_commands(groups, "Calls") {
            out.line(format!("extern template class {calls}<Client>;"));
        }
        out.blank();
        streams::for_app(out, groups);
        out.blank();
        each(out, groups);
    })
}

fn reports(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    out.template("any_report", &[]);
    let mut lists = with_reports(groups, "Reports");
    lists.push("fc_runtime::Types<fc_runtime::RawReport>".to_owned());
    out.alias("AnyReport", "fc_runtime::VariantOf", &lists);
    out.blank();
    out.template("reports", &[]);
}

fn client(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let values = [(
        "class",
        &*streams::whole(out, "Client", &with_commands(groups, "Calls")),
    )];
    out.template("client", &values);
}

/// Writes the commands of a group as methods of the client.
pub fn calls(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    out.template("calls", &[]);
    group.mixin(out, "Calls", |out| {
        for command in &group.commands {
            out.blank();
            call(out, context, command);
        }
    });
    out.blank();
    out.line(
        "// Not in the class: inline functions would be compiled in spite of `extern template`.",
    );
    out.line("// clang-format off");
    for command in &group.commands {
        let values = [
            ("response", &*command.response.ty.name),
            ("part", &group.part("Calls")),
            ("method", command.method),
            ("request", &command.request.ty.name),
        ];
        out.template("call", &values);
    }
    out.line("// clang-format on");
}

fn call(out: &mut Source, context: &Context<'_>, command: &Call<'_>) {
    let docs = facts::call_docs(context, command.operation, |error| {
        format!("`fc_runtime::declared` returns the `{error}` of a refused call.")
    });
    out.docs(&docs);
    let (request, response) = (&command.request.ty.name, &command.response.ty.name);
    let parameters = [
        format!("const {request}& request"),
        "const fc_runtime::CallOptions& options = {}".to_owned(),
    ];
    let (result, method) = (format!("fc_runtime::Called<{response}>"), command.method);
    let open = format!("{result} {method}(");
    let deprecation = command.operation.deprecated.as_ref();
    if let Some(deprecation) = deprecation {
        // The formatter would break the reason.
        let reason = literal(&facts::withdrawn_note(deprecation));
        out.line("// clang-format off");
        out.line(format!("[[deprecated({reason})]]"));
    }
    out.parameters(&open, &parameters, ") const;");
    if deprecation.is_some() {
        out.line("// clang-format on");
    }
}

/// Writes the types of a group's requests and of its reports.
pub fn lists(out: &mut Source, group: &NamedGroup<'_, '_>) {
    for (part, zh, en, calls) in [
        ("Commands", "指令的请求", "requests", &group.commands),
        ("Reports", "的上报", "reports", &group.reports),
    ] {
        if calls.is_empty() {
            continue;
        }
        out.template("list", &[("zh", zh), ("en", en)]);
        out.line(format!("using {} = fc_runtime::Types<", group.part(part)));
        // The comments and the end marker keep each type on a separate line. A new type therefore changes no other
        // line.
        for call in calls {
            out.line(format!("    // {}", call.operation.code.spelling));
            out.line(format!("    {},", call.request.ty.name));
        }
        out.line("    // No more.");
        out.line("    fc_runtime::End>;");
    }
}

/// Writes a function over the types of all commands, and one over the types of all reports.
fn each(out: &mut Source, groups: &[NamedGroup<'_, '_>]) {
    let commands = with_commands(groups, "Commands");
    let reports = with_reports(groups, "Reports");
    for (what, zh, lists) in [("command", "请求", commands), ("report", "上报", reports)] {
        out.template("each", &[("zh", zh), ("en", what)]);
        let visit = if lists.is_empty() {
            "/*visit*/"
        } else {
            "visit"
        };
        out.block(format!("void for_each_{what}(Visitor&& {visit})"), |out| {
            for list in &lists {
                out.line(format!("fc_runtime::visit_each(visit, {list}());"));
            }
        });
    }
}

/// Generates `client.cpp`.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let before = "#include \"fc_runtime/any_report.hpp\"\n\n";
    source_file(context, "client.hpp", before, |out| {
        out.template("client_source", &[]);
        out.blank();
        for calls in with_commands(groups, "Calls") {
            out.line(format!("template class {calls}<Client>;"));
        }
    })
}
