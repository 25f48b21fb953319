//! Constants of the spec as statements that fill a struct, field by field.
//!
//! C++17 cannot name the fields of a struct in one expression.

use super::tables::{item_of, spelled_in};
use super::types::field_type_in;
use crate::package::context::Context;
use crate::package::expr::{Expr, Record};
use crate::package::source::Source;
use std::collections::BTreeSet;

/// The statements that fill a struct with the values of a constant.
pub struct Assignments<'c, 'm> {
    context: &'c Context<'m>,
    /// The qualifier before each name of the package.
    space: &'c str,
    /// The variables in scope.
    variables: BTreeSet<String>,
    statements: Vec<Statement>,
}

/// A statement before layout.
enum Statement {
    /// A complete line.
    Line(String),
    /// An assignment: left side, right side.
    Assign(String, String),
    /// An assignment of a list: left side, type before the braces, items.
    List(String, String, Vec<String>),
}

impl<'c, 'm> Assignments<'c, 'm> {
    /// Creates the statements that fill the variable `name`. `others` are the other variables in scope.
    pub fn new(
        context: &'c Context<'m>,
        space: &'c str,
        name: &str,
        others: &[&str],
        record: &Record<'_>,
    ) -> Self {
        let variables = others.iter().chain([&name]).map(|&it| it.to_owned());
        let mut made = Self {
            context,
            space,
            variables: variables.collect(),
            statements: Vec::new(),
        };
        made.members(name, record);
        made
    }

    /// Returns `true` if no statement is necessary.
    pub fn is_empty(&self) -> bool {
        self.statements.is_empty()
    }

    /// Writes all statements.
    pub fn write(&self, out: &mut Source) {
        for statement in &self.statements {
            match statement {
                Statement::Line(line) => out.line(line),
                Statement::Assign(left, right) => assign(out, left, right),
                Statement::List(left, open, items) => {
                    let open = format!("{left} = {open}{{");
                    let joined = items.join(", ");
                    out.line_or([&open, &joined, "};"], |out| {
                        out.enclose(&open, "};", |out| out.fill(items, ","));
                    });
                }
            }
        }
    }

    fn members(&mut self, path: &str, record: &Record<'_>) {
        for (field, value) in &record.members {
            if let Some(value) = value {
                let name = &field.name;
                let place = format!("{path}.{name}");
                let ty = field_type_in(self.context, self.space, field);
                self.held(&place, name, &ty, field.optional, value);
            }
        }
    }

    /// Adds the statements that fill `place`, which has the C++ type `ty`. `name` is the base of new variables.
    fn held(&mut self, place: &str, name: &str, ty: &str, optional: bool, value: &Expr<'_>) {
        match value {
            Expr::Record(record) if optional => {
                self.inside(&format!("{place}.emplace()"), name, record);
            }
            Expr::Record(record) => self.members(place, record),
            Expr::Choice(_, variant, record) => {
                let begun = if optional { ".emplace()" } else { "" };
                let ty = self.context.name_of(&variant.ty);
                let made = format!("{place}{begun}.emplace<{}{ty}>()", self.space);
                self.inside(&made, name, record);
            }
            Expr::List(items) => self.list(place, name, ty, optional, items),
            Expr::Bytes(bytes) => {
                let items = bytes.iter().map(|byte| format!("0x{byte:02X}")).collect();
                self.filled(place, ty, optional, items);
            }
            value => {
                let spelled = spelled_in(self.context, self.space, value, ty);
                self.statements
                    .push(Statement::Assign(place.to_owned(), spelled));
            }
        }
    }

    fn list(&mut self, place: &str, name: &str, ty: &str, optional: bool, items: &[Expr<'_>]) {
        let inner = item_of(ty);
        let has_fields =
            |it: &Expr<'_>| matches!(it, Expr::Record(_) | Expr::Choice(..) | Expr::List(_));
        if !items.iter().any(has_fields) {
            let spelled = items.iter();
            let spelled = spelled.map(|it| spelled_in(self.context, self.space, it, inner));
            let spelled = spelled.collect();
            return self.filled(place, ty, optional, spelled);
        }
        let count = items.len();
        let place = if optional {
            let list = self.variable(name);
            let line = format!("auto& {list} = {place}.emplace({count});");
            self.statements.push(Statement::Line(line));
            list
        } else {
            let line = format!("{place}.resize({count});");
            self.statements.push(Statement::Line(line));
            place.to_owned()
        };
        for (index, item) in items.iter().enumerate() {
            self.held(&format!("{place}[{index}]"), name, inner, false, item);
        }
    }

    /// Adds an assignment of items that fit a line. An empty list that is required needs no statement.
    fn filled(&mut self, place: &str, ty: &str, optional: bool, items: Vec<String>) {
        if optional {
            let list = Statement::List(place.to_owned(), ty.to_owned(), items);
            self.statements.push(list);
        } else if !items.is_empty() {
            self.statements
                .push(Statement::List(place.to_owned(), String::new(), items));
        }
    }

    /// Adds the statements for a struct that the expression `made` creates.
    fn inside(&mut self, made: &str, name: &str, record: &Record<'_>) {
        let start = self.statements.len();
        let variable = self.variable(name);
        self.members(&variable, record);
        let line = if self.statements.len() == start {
            format!("{made};")
        } else {
            format!("auto& {variable} = {made};")
        };
        self.statements.insert(start, Statement::Line(line));
    }

    /// Returns a free variable with this name, or with a number as a suffix.
    fn variable(&mut self, name: &str) -> String {
        let numbered = (2_usize..).map(|number| format!("{name}_{number}"));
        let mut names = std::iter::once(name.to_owned()).chain(numbered);
        let free = names.find(|it| !self.variables.contains(it));
        let free = free.unwrap_or_else(|| name.to_owned());
        self.variables.insert(free.clone());
        free
    }
}

/// Writes `left = right;`, on two lines if it exceeds one.
pub fn assign(out: &mut Source, left: &str, right: &str) {
    out.line_or([left, " = ", right, ";"], |out| {
        out.line(format!("{left} =\n    {right};"));
    });
}
