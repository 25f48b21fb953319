//! The robot's stub: a base class with the methods of its groups, one per command.
//!
//! The stub also contains a robot that responds with the spec's examples, and a typed sender of reports.

use super::groups::{NamedGroup, with_commands, with_reports};
use super::layout::{Includes, header_file, source_file};
use super::process::combined;
use super::streams;
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::ranges::{UNKNOWN, pass_through};
use crate::package::source::Source;

/// Generates `robot.hpp`.
pub fn header(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let includes = Includes::new(
        context,
        &["memory", "string_view"],
        &["messages", "protocol"],
        &["server", "stacked"],
    );
    header_file(context, &includes, |out| {
        robot(out, context, groups);
        out.blank();
        // The formatter would fill the lines of the parts, and a new group would change all of them.
        let answers = |name| {
            let own = format!("fc_runtime::{name}<Robot, protocol>");
            [vec![own], with_commands(groups, "Defaults")]
                .concat()
                .join(",\n    ")
        };
        let [refusing, exemplary] = ["Refusing", "Exemplary"].map(answers);
        out.template(
            "robots",
            &[("refusing", &refusing), ("exemplary", &exemplary)],
        );
        let reporters = with_reports(groups, "Reporter");
        streams::sender(out, "Reporter", &reporters, ["上报", "reports"]);
        out.blank();
        streams::for_robot(out, groups);
    })
}

fn robot(out: &mut Source, context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) {
    let bases = with_commands(groups, "Robot").into_iter();
    let bases: Vec<String> = bases.map(|it| format!("public {it}")).collect();
    let values = [("class", &*out.class("Robot", &bases))];
    out.template("complete_robot", &values);
    out.enclose("", "};", |out| {
        for (name, range) in pass_through(context) {
            raw(out, &about::refused(Some(range)), &name);
        }
        raw(out, &about::refused(None), UNKNOWN);
    });
}

/// Writes the class with the handlers of a group's commands.
pub fn handlers(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let name = group.part("Robot");
    out.template("handlers", &[("name", &name)]);
    out.enclose("", "", |out| {
        for command in &group.commands {
            out.documented(&facts::method_docs(context, command.operation, |_| ()));
            let open = format!(
                "virtual fc_runtime::Replied<{}> {}(",
                command.response.ty.name, command.method
            );
            let parameters = [
                "const fc_runtime::Context& context".to_owned(),
                format!("const {}& request", command.request.ty.name),
            ];
            out.parameters(&open, &parameters, ") = 0;");
        }
    });
    out.blank();
    out.line(format!(
        " protected:\n  // Only `Robot` derives from a part.\n  ~{name}() = default;\n}};"
    ));
}

/// Writes the class with the responses of `PartialRobot` and `ExampleRobot` to a group's commands.
pub fn defaults(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.template("defaults", &[("name", &group.part("Defaults"))]);
    out.enclose("", "};", |out| {
        for command in &group.commands {
            let open = format!(
                "fc_runtime::Replied<{}> {}(",
                command.response.ty.name, command.method
            );
            let parameters = [
                "const fc_runtime::Context& /*context*/".to_owned(),
                format!("const {}& request", command.request.ty.name),
            ];
            let method = command.method;
            out.template("see", &[("method", method)]);
            out.parameters(&open, &parameters, ") override {");
            out.line("  return Base::answer_(request);\n}");
        }
    });
}

/// Writes a method for commands without a type, which a robot may omit.
fn raw(out: &mut Source, docs: &Docs<'_>, name: &str) {
    out.documented(docs);
    let parameters = [
        "const fc_runtime::Context& context",
        "std::string_view text",
    ];
    out.parameters(
        &format!("virtual fc_runtime::RawReplied {name}("),
        &parameters.map(str::to_owned),
        ");",
    );
}

/// Returns the statement that calls such a method.
fn serve_raw(name: &str) -> String {
    format!(
        "return fc_runtime::serve_raw(protocol(), context, text, [&robot](const fc_runtime::Context& known, std::string_view whole) {{ return robot->{name}(known, whole); }});"
    )
}

/// Writes the reports of a group as methods of the reporter.
pub fn reporters(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    out.template("reporter_part", &[]);
    group.mixin(out, "Reporter", |out| {
        for report in &group.reports {
            out.documented(&facts::method_docs(context, report.operation, |_| ()));
            let parameters = [
                format!("const {}& report", report.request.ty.name),
                "std::optional<fc_runtime::ConnectionId> to = std::nullopt".to_owned(),
            ];
            out.parameters(
                &format!("fc_runtime::Acknowledged {}(", report.method),
                &parameters,
                ") const {",
            );
            out.line("  return static_cast<const Self*>(this)->server().push(report, to);");
            out.line("}");
        }
    });
}

/// Declares the function that passes a request to its method.
pub fn declare_serve(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.template("declare_serve", &[]);
    let open = format!(
        "[[nodiscard]] std::optional<fc_runtime::Handled> serve_{}(",
        group.id
    );
    let parameters = [
        format!("{}& robot", group.part("Robot")),
        "const fc_runtime::Context& context".to_owned(),
        "std::string_view text".to_owned(),
    ];
    out.parameters(&open, &parameters, ");");
}

/// Defines the function that passes a request to its method.
pub fn serve(out: &mut Source, group: &NamedGroup<'_, '_>) {
    let open = format!(
        "std::optional<fc_runtime::Handled> serve_{}({}& robot, const fc_runtime::Context& context, std::string_view text) {{",
        group.id,
        group.part("Robot")
    );
    out.enclose(&open, "}", |out| {
        out.enclose("switch (context.code) {", "}", |out| {
            for command in &group.commands {
                let (request, response) = (&command.request.ty.name, &command.response.ty.name);
                out.line(format!("case fc_runtime::Command<{request}>::code:"));
                out.line(format!(
                    "  return fc_runtime::serve<{request}, {response}>(protocol(), context, text, [&robot](const fc_runtime::Context& known, const {request}& request) {{ return robot.{}(known, request); }});",
                    command.method
                ));
            }
            out.line("default: return std::nullopt;");
        });
    });
}

/// Generates `robot.cpp`.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let ranges = pass_through(context);
    let before = "#include <utility>\n\n";
    source_file(context, "robot.hpp", before, |out| {
        let unknown = UNKNOWN.to_owned();
        for name in ranges.iter().map(|(name, _)| name).chain([&unknown]) {
            out.blank();
            out.line(format!(
                "fc_runtime::RawReplied Robot::{name}(const fc_runtime::Context& /*context*/, std::string_view /*text*/) {{\n  return fc_runtime::unknown_command(protocol());\n}}"
            ));
        }
        out.template("robot_source", &[]);
        out.deeper(2, |out| {
            for group in groups.iter().filter(|it| !it.commands.is_empty()) {
                let serve = group.function("serve");
                out.line(format!(
                    "if (auto handled = {serve}(*robot, context, text)) return *std::move(handled);"
                ));
            }
            for (name, range) in &ranges {
                let (first, last) = (&range.first_spelling, &range.last_spelling);
                // Compilers warn of a comparison that is always true.
                let bounds = [
                    (range.first > 0).then(|| format!("context.code >= {first}")),
                    (range.last < u16::MAX).then(|| format!("context.code <= {last}")),
                ];
                let is_in = combined(bounds.into_iter().flatten(), " && ", "true");
                out.line(format!("if ({is_in}) {}", serve_raw(name)));
            }
            out.line(serve_raw(UNKNOWN));
        });
        out.line("  };\n}");
    })
}
