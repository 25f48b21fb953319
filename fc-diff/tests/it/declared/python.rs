//! Python, for type checkers: classes, functions, constants and fields. Names with a leading `_` are private.
//!
//! A robot implements each `@abstractmethod`. A program passes a value for each field without a default. A type checker
//! treats `rt.U8` and the like as `int`.

use super::Declared;
use super::tree::{cut, word};

pub fn read(declared: &mut Declared, path: &str, text: &str) {
    let Some((_, path)) = path.split_once("/src/") else {
        return;
    };
    let Some(path) = path
        .strip_suffix(".py")
        .filter(|it| !it.ends_with("/__init__"))
    else {
        return;
    };
    if path.ends_with("/call") {
        return;
    }
    let module = path.replace('/', ".");
    // Indent and name of the enclosing classes.
    let mut around: Vec<(usize, String)> = Vec::new();
    let mut is_abstract = false;
    let mut is_enum = false;
    let mut inside: Option<usize> = None;
    for (indent, line) in lines(text) {
        if inside.is_some_and(|outer| indent > outer) {
            continue;
        }
        inside = None;
        around.retain(|(outer, _)| indent > *outer);
        let owner = around.last().map_or(&module, |(_, name)| name).clone();
        if line.starts_with('@') {
            is_abstract |= line == "@abstractmethod";
        } else if let Some(head) = line.strip_prefix("class ") {
            let name = format!("{owner}.{}", word(head));
            let bases = cut(head, "(").1;
            is_enum = ["Enum)", "rt.State)", "rt.Result)"]
                .iter()
                .any(|it| bases.starts_with(it));
            declared.name(&name, "");
            around.push((indent, name));
        } else if let Some(head) = line
            .strip_prefix("async ")
            .unwrap_or(&line)
            .strip_prefix("def ")
        {
            inside = Some(indent);
            let name = format!("{owner}.{}", word(head));
            if word(head).starts_with('_') {
                continue;
            }
            if is_abstract {
                declared.demand(name, head);
            } else {
                declared.name(name, head);
            }
            is_abstract = false;
        } else {
            value(declared, &owner, &line, is_enum || around.is_empty());
        }
    }
}

/// Adds a field or a constant.
fn value(declared: &mut Declared, owner: &str, line: &str, is_constant: bool) {
    let (before, given) = cut(line, " = ");
    let name = word(before);
    let (_, ty) = cut(before, ":");
    if name.is_empty()
        || name.starts_with('_')
        || (ty.is_empty() && !is_constant)
        || !line.contains(['=', ':'])
    {
        return;
    }
    if ["import", "from", "if", "return", "raise"].contains(&name) {
        return;
    }
    let ty = ty
        .trim()
        .strip_prefix("Annotated[")
        .map_or(ty.trim(), |it| cut(it, ",").0);
    let mut ty = ty.to_owned();
    for bits in ["8", "16", "32", "64"] {
        for sign in ["rt.U", "rt.I"] {
            ty = ty.replace(&format!("{sign}{bits}"), "int");
        }
        ty = ty.replace(&format!("rt.F{bits}"), "float");
    }
    ty = ty
        .replace("rt.TimestampMs", "int")
        .replace("rt.TimestampS", "int");
    let name = format!("{owner}.{name}");
    if ty == "TypeAlias" {
        // The alternatives of a union are names.
        let given = given
            .trim_start_matches("Annotated[")
            .trim_start_matches('(');
        let (mut of, _) = cut(given, ",");
        while !of.trim().is_empty() {
            let (one, others) = cut(of, "|");
            declared.name(format!("{name}|{}", one.trim().trim_end_matches(')')), "");
            of = others;
        }
        return declared.name(name, "");
    }
    if let Some(of) = given.strip_prefix("NewType(") {
        return declared.name(name, of);
    }
    let is_field = !is_constant && !ty.starts_with("ClassVar[");
    // Programs do not construct envelopes; the runtime does.
    let is_made = owner.ends_with("Envelope");
    let is_given = !given.is_empty() && !given.starts_with("field(repr");
    if is_field && !is_given && !is_made {
        declared.demand(name, ty);
    } else {
        declared.name(name, ty);
    }
}

/// Returns the logical lines with their indent. Comments, docstrings and the punctuation in literals are removed.
fn lines(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let (mut line, mut indent, mut depth, mut is_start) = (String::new(), 0, 0_usize, true);
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if is_start && c == ' ' && line.is_empty() {
            indent += 1;
            rest = &rest[1..];
            continue;
        }
        is_start = false;
        let open = ["\"\"\"", "\"", "'"]
            .iter()
            .find(|it| rest.starts_with(**it));
        if let Some(open) = open {
            let end = end_of(&rest[open.len()..], open);
            line.push('"');
            line.extend(
                rest[open.len()..open.len() + end]
                    .chars()
                    .filter(|c| c.is_alphanumeric()),
            );
            line.push('"');
            rest = rest.get(open.len() * 2 + end..).unwrap_or_default();
            continue;
        }
        if c == '#' {
            rest = rest.find('\n').map_or("", |end| &rest[end..]);
            continue;
        }
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if c == '\n' && depth == 0 {
            let words: Vec<&str> = line.split_whitespace().collect();
            let whole = words
                .join(" ")
                .replace("( ", "(")
                .replace("[ ", "[")
                .replace(", )", ")");
            let whole = whole
                .replace(" )", ")")
                .replace(" ]", "]")
                .replace(",]", "]")
                .replace(",)", ")");
            if !whole.is_empty() && !whole.starts_with('"') {
                found.push((indent, whole));
            }
            (line, indent, is_start) = (String::new(), 0, true);
        } else {
            line.push(if c == '\n' { ' ' } else { c });
        }
        rest = &rest[c.len_utf8()..];
    }
    found
}

/// Returns the end of a literal with backslash escapes.
fn end_of(text: &str, close: &str) -> usize {
    let mut is_hidden = false;
    for (at, c) in text.char_indices() {
        if !is_hidden && text[at..].starts_with(close) {
            return at;
        }
        is_hidden = c == '\\' && !is_hidden;
    }
    text.len()
}
