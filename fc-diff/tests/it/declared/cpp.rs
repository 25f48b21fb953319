//! C++: declarations of the headers outside of `private`. The name of a function is its whole signature, because of
//! overloads.
//!
//! A robot implements the pure virtual functions. The signature of a choice lists all types of its `std::variant`. The
//! members of a struct have an order, because aggregates are initialised by position.

use super::Declared;
use super::tree::{Node, Syntax, cut, parts, tree, word};

static CPP: Syntax = Syntax {
    ends_at_line: false,
    is_list: |head| head.contains("enum class "),
    is_script: false,
};

pub fn read(declared: &mut Declared, path: &str, text: &str) {
    if !path.contains("/include/") {
        return;
    }
    let code: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    for node in tree(&code.join("\n"), &CPP) {
        declaration(declared, "", &node);
    }
}

fn declaration(declared: &mut Declared, owner: &str, node: &Node) {
    let head = bare(&node.head);
    if let Some(space) = head.strip_prefix("namespace ") {
        for inner in node.children() {
            declaration(declared, &format!("{owner}{space}::"), inner);
        }
        return;
    }
    if ["extern ", "friend ", "namespace"]
        .iter()
        .any(|it| head.starts_with(it))
    {
        return;
    }
    if let Some(rest) = head.strip_prefix("enum class ") {
        let name = format!("{owner}{}", word(rest));
        declared.name(&name, cut(rest, " : ").1);
        for value in node.children() {
            declared.name(format!("{name}::{}", word(&value.head)), "");
        }
    } else if let Some(rest) = head.strip_prefix("using ") {
        let (name, of) = cut(rest, " = ");
        let name = format!("{owner}{name}");
        match of.strip_prefix("fc_runtime::Types<") {
            // Every report is an alternative of `AnyReport`.
            Some(listed) if name.ends_with("Reports") => {
                for report in parts(listed.trim_end_matches('>')) {
                    declared.demand(format!("{name}|{report}"), "");
                }
                declared.name(name, "");
            }
            Some(_) => declared.name(name, ""),
            None => declared.name(name, of),
        }
    } else if let Some((kind, rest)) = head
        .split_once(' ')
        .filter(|(kind, _)| matches!(*kind, "struct" | "class"))
    {
        let (name, base) = cut(rest, " : ");
        let name = format!("{owner}{name}");
        // An id is constructed from the type that its base names.
        let is_id = base.contains("fc_runtime::Id<");
        declared.name(&name, if is_id { base } else { "" });
        members(declared, &name, kind == "class", node);
    } else if let Some(name) = member(declared, owner, head) {
        declared.name(name, "");
    }
}

/// Removes attributes and template parameters.
fn bare(head: &str) -> &str {
    let mut rest = head.trim_start();
    loop {
        let behind = if rest.starts_with("[[") {
            rest.split_once("]]").map(|(_, behind)| behind)
        } else {
            let of = rest.strip_prefix("template <");
            of.map(|of| cut(of, ">").1)
        };
        match behind {
            Some(behind) => rest = behind.trim_start(),
            None => return rest,
        }
    }
}

/// Adds a value, or returns the name of a function.
fn member(declared: &mut Declared, owner: &str, head: &str) -> Option<String> {
    let (before, _) = cut(head.trim_end_matches(" ="), " = ");
    if !before.contains('(') {
        let (ty, name) = before.rsplit_once(' ')?;
        declared.name(format!("{owner}{name}"), ty);
        return None;
    }
    let called = before.split('(').next()?.rsplit(' ').next()?;
    // The class already declares this function.
    if called.contains("::") {
        return None;
    }
    let (signature, _) = cut(before, " : ");
    let name = format!("{owner}{signature}");
    if head.ends_with("= 0") {
        declared.demands.insert(name.clone());
    }
    Some(name)
}

fn members(declared: &mut Declared, owner: &str, is_class: bool, node: &Node) {
    let mut is_hidden = is_class;
    let mut order = Vec::new();
    let inner = format!("{owner}::");
    for node in node.children() {
        let mut head = node.head.trim_start();
        while let Some((label, rest)) = ["public:", "protected:", "private:"]
            .iter()
            .find_map(|label| Some((*label, head.strip_prefix(label)?)))
        {
            is_hidden = label != "public:";
            head = rest.trim_start();
        }
        if is_hidden || head.is_empty() {
            continue;
        }
        let is_value = !cut(head, " = ").0.contains('(') && !head.contains("enum class ");
        if is_value && !head.starts_with("static ") && !head.starts_with("using ") {
            let name = cut(head, " = ").0.rsplit(' ').next().unwrap_or_default();
            order.push(name.to_owned());
        }
        if head.starts_with("enum class ") {
            for value in node.children() {
                declared.name(format!("{owner}::{}", word(&value.head)), "");
            }
            continue;
        }
        let node = Node {
            head: head.to_owned(),
            body: None,
        };
        declaration(declared, &inner, &node);
    }
    // `extra`, the last member, holds the unknown keys. Programs do not initialise it by position.
    order.retain(|name| name != "extra");
    if !is_class {
        declared.orders.insert(owner.to_owned(), order);
    }
}
