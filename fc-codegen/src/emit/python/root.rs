//! Re-exports of the package: its root, its groups, its tool, its tables and its id types.

use super::literal::Constants;
use super::messages::annotation;
use super::modules::ModulePlan;
use super::protocol;
use super::source::{Python, exported, method, sorted};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::source::Source;
use fc_spec::model::Type;

/// Writes a computed `__all__` that only takes effect at run time.
fn hidden(out: &mut Source, all: impl FnOnce(&mut Source)) {
    let comment =
        "# Type checkers use the imports above: not all of them read a computed `__all__`.";
    out.line(comment);
    out.suite("if not TYPE_CHECKING", all);
}

/// Creates the head of a file that re-exports names. The template is its docstring.
fn head(context: &Context<'_>, template: &str) -> Source {
    let mut out = context.source();
    out.template(template, &[]);
    out.template("typing", &[]);
    out.blank();
    out
}

/// Generates `__init__.py`.
pub fn root_file(context: &Context<'_>) -> String {
    let package = &context.package;
    let model = context.model();
    let mut docs = Docs::titled(&model.protocol.title);
    docs.text(&model.protocol.about);
    let mut out = context.source();
    out.docstring(&docs);
    out.template("typing", &[]);
    out.blank();
    let name = protocol::name(context);
    let streams = |name| (!package.streams.is_empty()).then_some(name);
    let client = ["AnyReport", "Client"]
        .into_iter()
        .chain(streams("Streams"));
    let robot = ["ExampleRobot", "PartialRobot", "Reporter", "Robot"];
    let robot = robot.into_iter().chain(streams("Streamer"));
    let tables = (!package.tables.is_empty()).then_some("tables");
    let modules = ["messages", "operations", "sync"].into_iter().chain(tables);
    let protocol = vec![&*name, "RequestEnvelope", "ResponseEnvelope", "ResultCode"];
    let imports = [
        (".", modules.collect()),
        (".client", client.collect()),
        (".groups", vec!["*"]),
        (".protocol", protocol),
        (".robot", robot.collect::<Vec<_>>()),
    ];
    for (module, names) in &imports {
        for name in names {
            // Type checkers treat an import as a re-export only if it has an `as` with the same name.
            let its_own = if *name == "*" {
                ""
            } else {
                &format!(" as {name}")
            };
            out.line(format!("from {module} import {name}{its_own}"));
        }
    }
    out.blank();
    let names = imports.iter().flat_map(|(_, names)| names).copied();
    let names: Vec<&str> = names.filter(|name| *name != "*").collect();
    let names = sorted(&names, str::to_owned).into_iter();
    let names = names.map(|name| format!("\"{name}\""));
    let names = names.chain(["*messages.__all__".to_owned()]);
    hidden(&mut out, |out| {
        out.lines("__all__ = [", &names.collect::<Vec<_>>(), "]");
    });
    out.finish()
}

/// Generates `groups/__init__.py`.
pub fn groups(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let mut out = head(context, "groups");
    let mut modules: Vec<&str> = plan.files().map(|group| group.name).collect();
    if !context.package.ids.is_empty() {
        modules.push(plan.ids());
    }
    modules.sort_unstable();
    out.import_from(".", &modules);
    for module in &modules {
        out.line(format!("from .{module} import *"));
    }
    out.blank();
    hidden(&mut out, |out| {
        let all = modules.iter().map(|it| format!("*{it}.__all__"));
        out.lines("__all__ = [", &all.collect::<Vec<_>>(), "]");
    });
    out.finish()
}

/// Generates `messages.py`.
pub fn messages(context: &Context<'_>) -> String {
    let mut out = head(context, "messages");
    out.line("from . import groups, operations\nfrom .groups import *");
    out.blank();
    let is_message = "if name not in operations.__all__";
    hidden(&mut out, |out| {
        out.line(format!(
            "__all__ = [name for name in groups.__all__ {is_message}]"
        ));
    });
    out.finish()
}

/// Generates `operations.py`.
pub fn operations(context: &Context<'_>) -> String {
    let mut out = head(context, "operations");
    out.line("import fc_runtime as rt\n\nfrom . import groups\nfrom .groups import *");
    out.blank();
    let is_operation = "if isinstance(getattr(groups, name), rt.Command | rt.Report | rt.Stream)";
    hidden(&mut out, |out| {
        out.line(format!(
            "__all__ = [name for name in groups.__all__ {is_operation}]"
        ));
    });
    out.finish()
}

/// Generates the file of the id types.
pub fn ids(context: &Context<'_>) -> String {
    let mut out = context.source();
    out.template("ids", &[]);
    if context.ids().any(|(_, held)| *held != Type::String) {
        out.blank();
        out.line("import fc_runtime as rt");
    }
    out.blank();
    let names = context.package.ids.iter().map(|id| &*id.name);
    exported(&mut out, &names.collect::<Vec<_>>());
    for (id, held) in context.ids() {
        let held = annotation(context, held, false);
        out.blank();
        out.line(format!("{0} = NewType(\"{0}\", {held})", id.name));
        out.docstring(&about::id(context, id.of));
    }
    out.finish()
}

/// Generates `call.py`.
pub fn call(context: &Context<'_>, package: &str) -> String {
    let name = protocol::name(context);
    let mut out = context.source();
    out.template("call", &[("package", package), ("name", &name)]);
    out.finish()
}

/// Generates `tables.py`.
pub fn tables(context: &Context<'_>) -> String {
    let mut constants = Constants::default();
    let mut body = context.source();
    for table in &context.package.tables {
        let row = context.name_of(&table.row);
        constants.types.insert(row.to_owned());
        let rows = constants.value(&context.package.rows(table));
        body.gap();
        let open = format!("def {}(", table.name);
        let returns = format!("list[{row}]");
        method(&mut body, &open, &[], &returns, |out| {
            out.docstring(&about::table(context, table.of));
            rows.write(out, "return ", "");
        });
    }
    let mut out = context.source();
    out.docstring(&Docs::said(about::TABLES));
    out.blank();
    out.line("from __future__ import annotations");
    let types: Vec<&str> = constants.types.iter().map(String::as_str).collect();
    if constants.runtime {
        out.blank();
        out.line("import fc_runtime as rt");
    }
    out.blank();
    out.import_from(".groups", &types);
    out.blank();
    out.append(&body);
    out.finish()
}
