//! `operations.ts`: the protocol with all of its operations, and what the methods of a robot are called.

use super::context::Context;
use super::layout::Layout;
use super::operations::stream_name;
use super::source::{head, import_types};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::ranges::{self, UNKNOWN};
use crate::surface::language::{Role, TYPESCRIPT};
use fc_spec::model::CodeRange;

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let mut out = head([
        "协议：数值和全部操作。",
        "The protocol: its numbers and all of its operations.",
    ]);
    import_types(&mut out, &["ProtocolOf", "ServiceOf"], "../src/runtime.ts");
    let names = |calls: Vec<crate::surface::package::Call<'_>>| -> Vec<String> {
        calls.iter().map(|call| call.method.to_owned()).collect()
    };
    let streams = context.package.streams.iter();
    let lists = [
        ("commands", names(context.commands())),
        ("reports", names(context.reports())),
        (
            "streams",
            streams.map(|stream| stream_name(stream)).collect(),
        ),
    ];
    for (word, names) in &lists {
        if !names.is_empty() {
            out.line(format!("import * as {word} from './{word}.ts'"));
        }
    }
    out.line("import { wire } from './wire.ts'");

    let protocol = &context.model().protocol;
    let mut docs = Docs::of(&protocol.title);
    docs.text(&protocol.about);
    docs.paragraph(format!("Version {} of the spec.", protocol.version));
    out.blank();
    out.docs(&docs);
    let members = lists.iter().map(|(word, names)| {
        let names = names
            .iter()
            .map(|name| Layout::word(format!("{word}.{name}")));
        (*word, Layout::list(names))
    });
    let head = format!("export const {}: ProtocolOf = ", context.package.name);
    Layout::lines([("wire", Layout::word("wire"))].into_iter().chain(members))
        .write(&mut out, &head, "");

    out.blank();
    out.line("/** 机器人的每个方法处理哪条指令。Which command each method of a robot handles. */");
    let commands = context.commands();
    let methods = commands
        .iter()
        .map(|it| (it.method, Layout::word(format!("commands.{}", it.method))));
    let ranges = self::ranges(context).into_iter().map(|(method, range)| {
        Layout::object([
            ("first", Layout::Number(range.first_spelling.to_lowercase())),
            ("last", Layout::Number(range.last_spelling.to_lowercase())),
            ("method", Layout::text(&method)),
        ])
    });
    Layout::lines([
        ("methods", Layout::lines(methods)),
        ("ranges", Layout::list(ranges)),
        (UNKNOWN, Layout::text(UNKNOWN)),
    ])
    .write(&mut out, "export const service: ServiceOf = ", "");
    out.finish()
}

/// Names of the runtime that stand beside the protocol's own in the stubs.
const BESIDE: &str = "Acknowledgement Answer Audience CallOptions ClientConfig Connection Context DataConnection \
    FollowableCall Platform RawRequest Reported Server ServerConfig ServerPlatform Subscription UnknownReport";

/// What the stubs call the protocol, and how they import it.
pub fn imported(context: &Context<'_>) -> (String, String) {
    let name = context.package.name.to_string();
    if BESIDE.split_whitespace().any(|taken| taken == name) {
        let local = format!("{name}$");
        let import = format!("{name} as {local}");
        (local, import)
    } else {
        (name.clone(), name)
    }
}

/// The ranges of codes that are handed on as they come, each with its method.
pub fn ranges<'m>(context: &Context<'m>) -> Vec<(String, &'m CodeRange)> {
    let ranges = ranges::pass_through(context).into_iter();
    ranges
        .map(|(words, range)| (method(&words), range))
        .collect()
}

/// A method that is not an operation's.
pub fn method(words: &str) -> String {
    let name = TYPESCRIPT.spelling(Role::Method, words);
    name.unwrap_or_else(|name| name).into_owned()
}
