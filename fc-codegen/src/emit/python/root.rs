//! `__init__.py`, `call.py` and `tables.py`: what the package shows at its root, its tool, its constants.

use super::homes::Homes;
use super::literal::Constants;
use super::messages::annotation;
use super::protocol;
use super::source::{Code, PYTHON, Python, exported, method};
use crate::emit::stub::about;
use crate::emit::stub::context::Context;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::source::Source;
use crate::sample::Samples;
use crate::surface::expr::{Expr, Expressions};
use fc_spec::model::Type;
use std::collections::BTreeMap;

/// `__init__.py`.
pub fn file(context: &Context<'_>, homes: &Homes<'_>) -> String {
    let package = &context.package;
    let model = context.model();
    let mut out = Source::new(&PYTHON);
    let mut docs = Docs::of(&model.protocol.title);
    docs.text(&model.protocol.about);
    out.docstring(&docs);
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    let name = protocol::name(context);
    let types = homes.modules().flat_map(|it| homes.names(context, it));
    let types = types.chain(package.ids.iter().map(|id| &*id.name));
    let streams = |name| (!package.streams.is_empty()).then_some(name);
    let client = ["AnyReport", "Client"]
        .into_iter()
        .chain(streams("Streams"));
    let robot = ["ExampleRobot", "PartialRobot", "Reporter", "Robot"];
    let robot = robot.into_iter().chain(streams("Streamer"));
    let tables = (!package.tables.is_empty()).then_some("tables");
    let modules = ["messages", "operations", "sync"].into_iter().chain(tables);
    let imports = [
        (".", modules.collect()),
        (".client", client.collect()),
        (".messages", types.collect()),
        (
            ".protocol",
            vec![&name, "RequestEnvelope", "ResponseEnvelope", "ResultCode"],
        ),
        (".robot", robot.collect()),
    ];
    for (module, names) in &imports {
        if *module == ".messages" && !names.is_empty() {
            out.import_each(module, names);
        } else {
            out.import_from(module, names);
        }
    }
    out.blank();
    let names: Vec<&str> = imports
        .iter()
        .flat_map(|(_, names)| names)
        .copied()
        .collect();
    exported(&mut out, &names);
    out.finish()
}

/// `messages/__init__.py`.
pub fn messages(context: &Context<'_>, homes: &Homes<'_>) -> String {
    let mut out = Source::new(&PYTHON);
    out.docstring(&Docs::said(&[
        "全部报文类型，按指令组分模块。",
        "All message types; each group has a module of its own.",
    ]));
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    let modules = homes.modules();
    let modules = modules.map(|it| (it.name.to_string(), homes.names(context, it)));
    let mut modules: BTreeMap<String, Vec<&str>> = modules.collect();
    let ids = &context.package.ids;
    if !ids.is_empty() {
        modules.insert(homes.ids(), ids.iter().map(|id| &*id.name).collect());
    }
    for (module, names) in &modules {
        out.import_each(&format!(".{module}"), names);
    }
    let all: Vec<&str> = modules.into_values().flatten().collect();
    out.blank();
    exported(&mut out, &all);
    out.finish()
}

/// The types of ids.
pub fn ids(context: &Context<'_>) -> String {
    let mut out = Source::new(&PYTHON);
    out.docstring(&Docs::said(&[
        "各种实体的 ID，每种一个类型，类型检查器不会让它们互相混用；发送的形式与不用这些类型时相同。",
        "The IDs of entities, each kind with a type of its own, so that a type checker lets none be taken for another. They travel as what they hold.",
    ]));
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    out.line("from typing import NewType");
    let ids = context.package.ids.iter();
    let ids = ids.filter_map(|id| Some((id, context.model().id_type(id)?)));
    if ids.clone().any(|(_, held)| *held != Type::String) {
        out.blank();
        out.line("import fc_runtime as rt");
    }
    for (id, held) in ids {
        let title = &id.title;
        let mut docs = Docs::default();
        docs.paragraph(format!("{}：ID", title.zh));
        docs.paragraph(format!("{}: its ID", title.en));
        docs.paragraph(context.links(&id.location, "reference/entities.md"));
        let held = annotation(context, held, false);
        out.blank();
        out.line(format!("{0} = NewType(\"{0}\", {held})", id.name));
        out.docstring(&docs);
    }
    out.finish()
}

/// `call.py`.
pub fn call(context: &Context<'_>, package: &str) -> String {
    let name = protocol::name(context);
    format!(
        "\
\"\"\"命令行工具：`python -m {package}.call --help`。A command-line tool.\"\"\"

from __future__ import annotations

from fc_runtime.tool import main

from .protocol import {name}

if __name__ == \"__main__\":
    raise SystemExit(main({name}))
"
    )
}

/// `tables.py`.
pub fn tables(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut constants = Constants::default();
    let mut body = Source::new(&PYTHON);
    let expressions = Expressions::new(&context.package, samples);
    for table in &context.package.tables {
        let mut docs = Docs::of(&table.title);
        docs.text(&table.about);
        if let Some(store) = &table.kept {
            docs.paragraph(facts::kept(store));
        }
        docs.paragraph(context.links(&table.location, "reference/tables.md"));
        let row = context.name_of(&table.row);
        constants.types.insert(row.to_owned());
        let rows = table.rows.iter();
        let rows = rows.map(|row| Expr::Record(expressions.record(&table.row, row)));
        let rows = constants.value(&Expr::List(rows.collect()));
        body.gap();
        let open = format!("def {}(", table.name);
        method(
            &mut body,
            &open,
            Vec::<Code>::new(),
            &format!("list[{row}]"),
            |out| {
                out.docstring(&docs);
                rows.write(out, "return ", "");
            },
        );
    }
    let mut out = Source::new(&PYTHON);
    out.docstring(&Docs::said(&about::TABLES));
    out.blank();
    out.line("from __future__ import annotations");
    let types: Vec<&str> = constants.types.iter().map(String::as_str).collect();
    if constants.runtime {
        out.blank();
        out.line("import fc_runtime as rt");
    }
    out.blank();
    out.import_from(".messages", &types);
    out.blank();
    out.append(&body);
    out.finish()
}
