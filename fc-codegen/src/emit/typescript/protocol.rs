//! `operations.ts`: the protocol with the operations of all groups, and the method names of a robot.

use super::context::{Context, spelled};
use super::group::{Group, What};
use super::layout::Layout;
use super::source::{Source, head, named};
use crate::package::about;
use crate::package::language::Role;
use crate::package::ranges::{self, UNKNOWN};
use fc_spec::model::CodeRange;

pub fn file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> String {
    let about = [
        "协议：数值和全部接口。",
        "The protocol: its numbers and all of its operations.",
    ];
    let mut out = head(context, about);
    let names = [
        "AnyCommand",
        "AnyReportOf",
        "AnyStream",
        "ProtocolOf",
        "ServiceOf",
    ];
    named(&mut out, "import type", names, "../src/runtime.ts");
    let all = [
        ("commands", "AnyCommand", What::Commands),
        ("reports", "AnyReportOf", What::Reports),
        ("streams", "AnyStream", What::Streams),
    ];
    for (word, _, what) in &all {
        for group in groups.iter().filter(|it| it.has(*what)) {
            let (variable, name) = (group.variable(word), &group.name);
            out.line(format!(
                "import {variable} from './groups/{name}/{word}.ts'"
            ));
        }
    }
    out.line("import { wire } from './wire.ts'");
    for (word, ty, what) in &all {
        out.template(&format!("all_{word}"), &[]);
        let groups = groups.iter().filter(|it| it.has(*what));
        let variables: Vec<String> = groups
            .map(|it| format!("...{}", it.variable(word)))
            .collect();
        spread(
            &mut out,
            &format!("export const {word}: Readonly<Record<string, {ty}>> = "),
            &variables,
        );
    }

    out.documented(&about::protocol(context.model()));
    let members = all
        .iter()
        .map(|(word, ..)| (*word, Layout::word(format!("Object.values({word})"))));
    let head = format!("export const {}: ProtocolOf = ", context.package.name);
    Layout::lines([("wire", Layout::word("wire"))].into_iter().chain(members))
        .write(&mut out, &head, "");

    out.template("service", &[]);
    let ranges = self::ranges(context).into_iter().map(|(method, range)| {
        Layout::object([
            ("first", Layout::Number(range.first_spelling.to_lowercase())),
            ("last", Layout::Number(range.last_spelling.to_lowercase())),
            ("method", Layout::text(&method)),
        ])
    });
    Layout::lines([
        ("methods", Layout::word("commands")),
        ("ranges", Layout::list(ranges)),
        (UNKNOWN, Layout::text(UNKNOWN)),
    ])
    .write(&mut out, "export const service: ServiceOf = ", "");
    out.finish()
}

/// Writes `head { ...one, ...other }`, with each member on a separate line.
fn spread(out: &mut Source, head: &str, members: &[String]) {
    if members.is_empty() {
        return out.line([head, "{}"].concat());
    }
    out.lines(&[head, "{"].concat(), members, "}");
}

/// Names of the runtime that the stubs use together with the protocol's name.
const BESIDE: &str = "Acknowledgement Answer Audience CallOptions ClientConfig Connection Context DataConnection \
    FollowableCall Platform RawRequest Reported Server ServerConfig ServerPlatform Subscription UnknownReport";

/// Returns the local name of the protocol in the stubs, and its import.
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

/// Returns the pass-through ranges, each with its method.
pub fn ranges<'m>(context: &Context<'m>) -> Vec<(String, &'m CodeRange)> {
    let ranges = ranges::pass_through(context).into_iter();
    ranges
        .map(|(words, range)| (spelled(Role::Method, &words), range))
        .collect()
}
