//! Kotlin, also for Java: `public` declarations. The name of a function includes its parameters.
//!
//! A robot implements the functions of `…Handlers` that have no body. Each `when` on a choice has a case for each
//! message that is a variant of the choice.

use super::Declared;
use super::tree::{Node, Syntax, cut, parts, tree, word};

static KOTLIN: Syntax = Syntax {
    ends_at_line: true,
    is_list: |_| false,
    is_script: false,
};

pub fn read(declared: &mut Declared, path: &str, text: &str) {
    if !path.contains("/main/kotlin/") {
        return;
    }
    let nodes = tree(text, &KOTLIN);
    let package = nodes.iter().find_map(|it| it.head.strip_prefix("package "));
    let package = format!("{}.", package.unwrap_or_default());
    for node in &nodes {
        declaration(declared, &package, node);
    }
}

/// Words before the kind of a declaration.
const MODIFIERS: [&str; 5] = ["open ", "sealed ", "inline ", "operator ", "suspend "];

fn declaration(declared: &mut Declared, owner: &str, node: &Node) {
    let Some(mut head) = node.head.strip_prefix("public ") else {
        return;
    };
    while let Some(rest) = MODIFIERS.iter().find_map(|it| head.strip_prefix(it)) {
        head = rest;
    }
    let (kind, rest) = head.split_once(' ').unwrap_or((head, ""));
    match kind {
        "class" | "object" | "interface" => {
            let name = format!("{owner}{}", word(rest));
            let supers = parts(cut(rest, " : ").1);
            // An id is constructed from the type that its base names.
            let base = supers.first().filter(|it| it.starts_with("Id<"));
            declared.name(&name, base.copied().unwrap_or_default());
            if supers.contains(&"State") {
                declared.name(format!("{name}: State"), "");
            }
            if supers.first().is_some_and(|it| it.starts_with("Message(")) {
                for choice in supers.iter().skip(1) {
                    declared.demand(format!("{owner}{choice}:{}", word(rest)), "");
                }
            }
            members(declared, &name, node);
        }
        "companion" => members(declared, &format!("{owner}Companion"), node),
        "fun" => {
            let (signature, _) = cut(rest, " =");
            let (name, _) = cut(signature, ":");
            let name = format!("{owner}{name}");
            let is_asked = owner.trim_end_matches('.').ends_with("Handlers");
            if is_asked && signature == rest && node.body.is_none() {
                declared.demand(name, signature);
            } else {
                declared.name(name, signature);
            }
        }
        "val" => {
            let (signature, _) = cut(cut(rest, " get()").0, " =");
            declared.name(format!("{owner}{}", word(rest)), signature);
        }
        _ => {}
    }
}

fn members(declared: &mut Declared, owner: &str, node: &Node) {
    let owner = format!("{owner}.");
    for member in node.children() {
        declaration(declared, &owner, member);
    }
}
