//! TypeScript: names that the root exports. Operations, schemas, tables and defaults are in modules.
//!
//! A robot implements the methods of `…Robot`. A literal of a message has the required members. The alternatives of a
//! union type are names, and cases of a `switch`. Open enums have no such alternatives.

use super::Declared;
use super::tree::{Node, Syntax, cut, tree, word};

static TYPESCRIPT: Syntax = Syntax {
    ends_at_line: true,
    is_list: |head| head.trim_end().ends_with(['=', ':']),
    is_script: true,
};

pub fn read(declared: &mut Declared, path: &str, text: &str) {
    let file = path.rsplit('/').next().unwrap_or_default();
    let is_group = path.contains("/groups/");
    let module = match file.trim_end_matches(".ts") {
        "messages" if is_group => "",
        "client" | "ids" | "robot" | "wire" | "operations" => "",
        module @ ("commands" | "reports" | "streams" | "schemas" | "defaults") if is_group => {
            module
        }
        "tables" => "tables",
        _ => return,
    };
    let hidden: &[&str] = match file {
        "wire.ts" => &["wire"],
        "operations.ts" => &["commands", "reports", "streams", "service"],
        _ => &[],
    };
    let module = if module.is_empty() {
        String::new()
    } else {
        format!("{module}.")
    };
    for node in tree(text, &TYPESCRIPT) {
        let Some(head) = node.head.strip_prefix("export ") else {
            continue;
        };
        let (kind, rest) = head.split_once(' ').unwrap_or_default();
        if hidden.contains(&word(rest)) {
            continue;
        }
        let name = format!("{module}{}", word(rest));
        match kind {
            "interface" => interface(declared, &name, &node),
            "type" => alternatives(declared, &name, rest),
            "const" => constant(declared, &module, &name, rest, &node),
            "class" | "function" => declared.name(name, ""),
            _ => {}
        }
    }
}

fn interface(declared: &mut Declared, name: &str, node: &Node) {
    // A class may have the same name, so an existing entry remains.
    declared.names.entry(name.to_owned()).or_default();
    let members = node.children();
    let is_message = members.iter().any(|it| it.head.starts_with("extra?:"));
    for member in members {
        let (signature, _) = cut(&member.head, " =");
        let key = word(signature.trim_start_matches("readonly "));
        let is_required = !signature.contains(&format!("{key}?"));
        let is_asked = is_message || name.ends_with("Robot");
        // `…Robot` requires each method of the `…PartialRobot` of its group.
        if let Some(group) = name
            .strip_suffix("PartialRobot")
            .filter(|it| !it.is_empty())
        {
            declared.demand(format!("{group}Robot.{key}"), signature);
        }
        if is_required && is_asked && key != "extra" {
            declared.demand(format!("{name}.{key}"), signature);
        } else {
            declared.name(format!("{name}.{key}"), signature);
        }
    }
}

fn alternatives(declared: &mut Declared, name: &str, rest: &str) {
    declared.names.entry(name.to_owned()).or_default();
    let (_, mut of) = cut(rest, "=");
    // An open enum accepts any value.
    if of.contains("& {}") {
        return;
    }
    while !of.trim().is_empty() {
        let (one, others) = cut(of, "|");
        let one = one.trim();
        if !one.is_empty() {
            declared.demand(format!("{name}|{one}"), "");
        }
        of = others;
    }
}

fn constant(declared: &mut Declared, module: &str, name: &str, rest: &str, node: &Node) {
    let (before, _) = cut(rest, " =");
    let (_, ty) = cut(before, ":");
    // The types of operations and schemas repeat the names of their messages.
    let is_plain = module.is_empty() || module == "tables.";
    declared.names.entry(name.to_owned()).or_default();
    if is_plain && !ty.is_empty() {
        declared.name(name, ty.trim());
    }
    if ty.is_empty() || module == "defaults." {
        for value in node.children() {
            declared.name(format!("{name}.{}", word(&value.head)), "");
        }
    }
}
