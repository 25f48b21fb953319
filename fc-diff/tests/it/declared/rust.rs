//! Rust: `pub` items and fields, variants, and methods of traits.
//!
//! The derives add names that the source does not have:
//!
//! - `New` adds `new`, and a `with_…` for each optional field.
//! - `New` also adds a `…Fields` type for two or more required fields.
//! - `#[fc(default = …)]` on a field adds `…_or_default` and `DEFAULT_…`.
//! - `final`, `error` and `order` of an enum add methods and `State`.
//! - `sets_off` and `accepted_in` of a request implement traits.
//!
//! The root re-exports the items of the private modules `client`, `protocol` and `robot`.

use super::Declared;
use super::tree::{Node, Syntax, cut, parts, tree, word};

static RUST: Syntax = Syntax {
    ends_at_line: false,
    is_list: |head| {
        let (_, head) = attributes(head);
        head.starts_with("pub struct ") || head.starts_with("pub enum ")
    },
    is_script: false,
};

pub fn read(declared: &mut Declared, path: &str, text: &str) {
    let Some((_, path)) = path.split_once("/src/") else {
        return;
    };
    let module = match path.trim_end_matches(".rs") {
        "lib" | "prelude" | "messages/mod" => return,
        "client" | "protocol" | "robot" => String::new(),
        module => module.replace('/', "::") + "::",
    };
    for node in tree(text, &RUST) {
        item(declared, &module, &node);
    }
}

/// Splits a declaration into its attributes and the rest.
fn attributes(head: &str) -> (Vec<&str>, &str) {
    let mut rest = head.trim_start();
    let mut found = Vec::new();
    while let Some(open) = ["#[", "#!["].iter().find(|it| rest.starts_with(**it)) {
        let (attribute, behind) = cut(&rest[open.len()..], "]");
        found.push(attribute);
        rest = behind.trim_start();
    }
    (found, rest)
}

/// Returns an item of `#[fc(…)]`, such as `default = 1.0` or `final`.
fn told<'a>(attributes: &[&'a str], key: &str) -> Option<&'a str> {
    let fc = attributes.iter().filter_map(|it| it.strip_prefix("fc("));
    let items = fc.flat_map(|it| parts(it.trim_end_matches(')')));
    let mut items = items.filter(|it| word(it) == key);
    items.next()
}

/// Returns `A` and `B` of `sets_off(A, B(request.x = y))`.
fn listed(told: Option<&str>) -> Vec<&str> {
    let inside = told.and_then(|it| it.split_once('('));
    let inside = inside.map(|(_, inside)| inside.strip_suffix(')').unwrap_or(inside));
    inside
        .map(parts)
        .unwrap_or_default()
        .into_iter()
        .map(word)
        .collect()
}

fn item(declared: &mut Declared, module: &str, node: &Node) {
    let (attributes, head) = attributes(&node.head);
    if let Some(of) = head.strip_prefix("impl crate::") {
        return methods(declared, &format!("{}::", of.trim()), node);
    }
    if let Some(of) = head.strip_prefix("impl ").filter(|it| !it.contains(' ')) {
        return methods(declared, &format!("{module}{of}::"), node);
    }
    if let Some(name) = head.strip_prefix("macro_rules! ") {
        return declared.name(format!("{name}!"), "");
    }
    let Some(head) = head.strip_prefix("pub ") else {
        return;
    };
    let (kind, rest) = head.split_once(' ').unwrap_or_default();
    let name = format!("{module}{}", word(rest));
    match kind {
        "struct" => {
            declared.name(&name, if node.body.is_some() { "" } else { rest });
            structure(declared, &name, &attributes, node);
        }
        "enum" => {
            declared.name(&name, "");
            enumeration(declared, &name, &attributes, node);
        }
        "trait" => {
            declared.name(&name, "");
            for method in node.children() {
                let (_, head) = self::attributes(&method.head);
                let method_name = word(cut(head, "fn ").1);
                match method.body {
                    Some(_) => declared.name(format!("{name}::{method_name}"), head),
                    None => declared.demand(format!("{name}::{method_name}"), head),
                }
            }
        }
        "use" | "mod" => {}
        _ => function(declared, module, head),
    }
}

/// Adds a function, or a constant without its value.
fn function(declared: &mut Declared, owner: &str, head: &str) {
    let (head, _) = cut(head, " = ");
    let name = match cut(head, "fn ") {
        (_, "") => word(head.trim_start_matches("const ")),
        (_, name) => word(name),
    };
    declared.name(format!("{owner}{name}"), head);
}

fn methods(declared: &mut Declared, owner: &str, node: &Node) {
    for method in node.children() {
        let (_, head) = attributes(&method.head);
        if let Some(head) = head.strip_prefix("pub ") {
            function(declared, owner, head);
        }
    }
}

fn structure(declared: &mut Declared, name: &str, of: &[&str], node: &Node) {
    let mut required = Vec::new();
    for field in node.children() {
        let (attributes, head) = attributes(&field.head);
        let Some((field, ty)) = head.strip_prefix("pub ").and_then(|it| it.split_once(": ")) else {
            continue;
        };
        declared.name(format!("{name}::{field}"), ty);
        if attributes.contains(&"fc(extra)") {
            continue;
        }
        match ty.strip_prefix("Option<") {
            Some(_) => declared.name(format!("{name}::with_{field}"), ty),
            None => required.push(format!("{field}: {ty}")),
        }
        if told(&attributes, "default").is_some() {
            declared.name(format!("{name}::{field}_or_default"), ty);
            declared.name(format!("{name}::DEFAULT_{}", field.to_uppercase()), ty);
        }
    }
    let derives = of.iter().filter_map(|it| it.strip_prefix("derive("));
    let mut derives = derives.flat_map(|it| parts(it.trim_end_matches(')')));
    if derives.any(|it| it == "New") {
        required.sort();
        declared.name(format!("{name}::new"), required.join(", "));
        if required.len() > 1 {
            declared.name(format!("{name}Fields"), "");
        }
    }
    for report in listed(told(of, "sets_off")) {
        declared.name(format!("{name}: SetsOff<{report}>"), "");
    }
    for state in listed(told(of, "accepted_in")) {
        declared.name(format!("{name}: AcceptedIn<{state}>"), "");
    }
    if let Some(error) = told(of, "error") {
        declared.name(format!("{name}: Errors"), error);
    }
}

fn enumeration(declared: &mut Declared, name: &str, of: &[&str], node: &Node) {
    for variant in node.children() {
        let (attributes, head) = attributes(&variant.head);
        declared.demand(format!("{name}::{}", word(head)), head);
        for (key, method) in [("final", "is_final"), ("error", "is_error")] {
            if told(&attributes, key).is_some() {
                declared.name(format!("{name}::{method}"), "");
                declared.name(format!("{name}: State"), "");
            }
        }
    }
    if let Some(order) = told(of, "order") {
        let is_complete = order.contains("complete");
        let method = if is_complete {
            "may_follow"
        } else {
            "normally_follows"
        };
        declared.name(format!("{name}::{method}"), "");
        declared.name(format!("{name}: State"), "");
    }
}
