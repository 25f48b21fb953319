//! Layout rules of clang-format in Google's style: parameters, files and namespaces.

use super::types::namespace;
use crate::package::context::Context;
use crate::package::docs::columns_of;
use crate::package::joined::Joined;
use crate::package::source::{Source, join};
use crate::package::style::{Comment, Style};
use crate::package::template::{Templates, templates};
use fc_spec::model::is_hidden;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::LazyLock;

static TEMPLATES: Templates = LazyLock::new(|| templates(include_str!("templates.cpp.in")));

/// The style of clang-format.
pub static CPP: Style = Style {
    width: 100,
    indent: "  ",
    comment: Comment {
        open: "",
        mark: "///",
        inner_mark: "///",
        close: "",
        begins_at_once: false,
        prose: |line| unspliced(line, "&#92;"),
        code: |line| unspliced(line, "\u{FF3C}"),
        fence: |language| language,
    },
    link: |name| format!("`{name}`"),
    integer: |value| value.to_string(),
    redacted: "Never printed.",
    templates: &TEMPLATES,
};

/// Replaces backslashes that could end a line of a comment after wrapping.
///
/// Such a backslash would join the next line to the comment. Some compilers read the trigraph `??/` as a backslash, and
/// others warn of it.
fn unspliced<'l>(line: &'l str, shown: &str) -> Cow<'l, str> {
    const TRIGRAPH: &str = "??/";
    if !line.ends_with('\\') && !line.contains("\\ ") && !line.contains(TRIGRAPH) {
        return Cow::Borrowed(line);
    }
    let mut out = line.replace("\\ ", &format!("{shown} "));
    out = out.replace(TRIGRAPH, "?\u{FF1F}/");
    if out.ends_with('\\') {
        out.pop();
        out.push_str(shown);
    }
    Cow::Owned(out)
}

/// The includes of a file.
#[derive(Default)]
pub struct Includes {
    standard: BTreeSet<&'static str>,
    own: BTreeSet<String>,
}

impl Includes {
    /// Creates includes of the standard library, of the package and of the runtime.
    ///
    /// The names have no folder and no extension.
    pub fn new(
        context: &Context<'_>,
        standard: &[&'static str],
        package: &[&str],
        runtime: &[&str],
    ) -> Self {
        let space = &namespace(context);
        let package = package.iter().map(|name| format!("{space}/{name}.hpp"));
        let mut includes = Self::default();
        includes.own.extend(package);
        includes.add(standard, runtime);
        includes
    }

    /// Adds headers of the standard library and of the runtime.
    pub fn add(&mut self, standard: &[&'static str], runtime: &[&str]) {
        let runtime = runtime.iter().map(|name| format!("fc_runtime/{name}.hpp"));
        self.standard.extend(standard);
        self.own.extend(runtime);
    }

    /// Adds a header of the standard library.
    pub fn standard(&mut self, name: &'static str) {
        self.standard.insert(name);
    }

    /// Adds a header of the package.
    pub fn own(&mut self, path: impl Into<String>) {
        self.own.insert(path.into());
    }

    /// Writes all includes.
    pub fn lines(&self, out: &mut Source) {
        for name in &self.standard {
            out.line(format!("#include <{name}>"));
        }
        if !self.standard.is_empty() {
            out.blank();
        }
        for path in &self.own {
            out.line(format!("#include \"{path}\""));
        }
    }
}

/// Generates a header with the namespace of the package.
pub fn header_file(
    context: &Context<'_>,
    includes: &Includes,
    body: impl FnOnce(&mut Source),
) -> String {
    let mut out = context.source();
    out.line("#pragma once");
    out.blank();
    includes.lines(&mut out);
    out.blank();
    out.namespace(&namespace(context), body);
    out.finish()
}

/// Generates the source of a header. `before` precedes the namespace of the package.
pub fn source_file(
    context: &Context<'_>,
    header: &str,
    before: &str,
    body: impl FnOnce(&mut Source),
) -> String {
    let space = &namespace(context);
    let mut out = context.source();
    out.line(format!("#include \"{space}/{header}\""));
    out.blank();
    out.line(before);
    out.line("// clang-format off");
    out.blank();
    out.namespace(space, body);
    out.finish()
}

impl Source {
    /// Writes `open(a, b)close` on one line if it fits.
    ///
    /// Otherwise the parameters are aligned below the first, as many to a line as fit.
    pub fn parameters(&mut self, open: &str, parameters: &[String], close: &str) {
        if self.has_room([open, &join(parameters), close]) {
            return self.line([open, &join(parameters), close].concat());
        }
        let mut indent = " ".repeat(columns_of(open));
        let mut line = open.to_owned();
        let overflows = parameters.iter().enumerate().any(|(index, parameter)| {
            let is_last = index + 1 == parameters.len();
            let behind = if is_last { columns_of(close) } else { 1 };
            indent.len() + columns_of(parameter) + behind > self.room()
        });
        if overflows {
            self.line(open);
            indent = " ".repeat(4);
            line.clone_from(&indent);
        }
        let mut is_first = true;
        for (index, parameter) in parameters.iter().enumerate() {
            let behind = if index + 1 < parameters.len() {
                ","
            } else {
                close
            };
            let gap = if is_first { "" } else { " " };
            if !is_first && !self.has_room([&line, gap, parameter, behind]) {
                self.line(&line);
                line = [&indent, parameter.as_str(), behind].concat();
            } else {
                line.extend([gap, parameter, behind]);
            }
            is_first = false;
        }
        self.line(line);
    }

    /// Writes `using name = of<…>;`.
    pub fn alias(&mut self, name: &str, of: &str, types: &[String]) {
        let using = format!("using {name} =");
        let all = join(types);
        if self.has_room([&using, " ", of, "<", &all, ">;"]) {
            return self.line(format!("{using} {of}<{all}>;"));
        }
        // Uses the layout with fewer lines.
        let mut beside = self.part();
        beside.parameters(&format!("{using} {of}<"), types, ">;");
        let mut below = self.part();
        below.line(using);
        below.parameters(&format!("    {of}<"), types, ">;");
        let (beside, below) = (beside.finish(), below.finish());
        let is_below = below.lines().count() <= beside.lines().count();
        self.line(if is_below { below } else { beside });
    }

    /// Returns the first line of a class with its bases. Bases that exceed the line have one line each.
    pub fn class(&self, name: &str, bases: &[String]) -> String {
        if bases.is_empty() {
            return format!("class {name} {{");
        }
        let open = format!("class {name} : ");
        if self.has_room([&open, &join(bases), " {"]) {
            return [&open, &*join(bases), " {"].concat();
        }
        let between = format!(",\n{}", " ".repeat(columns_of(&open)));
        [&open, &*bases.join(&between), " {"].concat()
    }

    /// Writes a namespace, whose contents are not indented.
    pub fn namespace(&mut self, name: &str, body: impl FnOnce(&mut Self)) {
        self.line(format!("namespace {name} {{"));
        self.blank();
        body(self);
        self.blank();
        self.line(format!("}}  // namespace {name}"));
    }
}

/// Returns a string literal.
pub fn literal(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for character in text.chars() {
        match character {
            // Two question marks may begin a trigraph.
            '?' if out.ends_with('?') => out.push_str("\\?"),
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            // Three digits, so that a following digit does not extend the escape.
            c if c.is_ascii_control() => out.extend(format!("\\{:03o}", u32::from(c)).chars()),
            c if is_hidden(c) => out.extend(format!("\\U{:08x}", u32::from(c)).chars()),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// The maximum length of a raw string literal, in bytes.
///
/// Compilers may refuse longer ones. Adjacent literals form one string.
const LONGEST: usize = 16_000;

/// Returns a raw string literal, which shows the text unescaped.
pub fn raw(text: &str) -> String {
    if text.contains(is_hidden) {
        return literal(text);
    }
    let mut mark = String::new();
    while text.contains(&format!("){mark}\"")) {
        mark.push('_');
    }
    let mut rest = text;
    let mut pieces = Vec::new();
    while rest.len() > LONGEST {
        let end = (0..=LONGEST).rev().find(|at| rest.is_char_boundary(*at));
        let (piece, behind) = rest.split_at(end.unwrap_or_default());
        pieces.push(piece);
        rest = behind;
    }
    pieces.push(rest);
    let pieces = pieces.iter();
    let pieces = pieces.map(|piece| format!("R\"{mark}({piece}){mark}\""));
    pieces.joined("\n      ")
}

/// Returns an integer literal of any width.
pub fn integer(value: i128) -> String {
    if value > i128::from(i64::MAX) {
        return format!("{value}ULL");
    }
    if value == i128::from(i64::MIN) {
        return format!("({} - 1)", value + 1);
    }
    value.to_string()
}

/// Returns a float literal.
pub fn float(value: f64) -> String {
    format!("{value:?}")
}
