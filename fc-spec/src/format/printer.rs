//! Prints rows as text.

use super::block::{Block, Row, Value};
use super::comments::Line;
use super::order::{Head, LEVEL};
use super::{flow, scalar};
use crate::language::Cursor;
use crate::syntax::{Node, Style};

/// Returns the text of a file whose rows are sorted.
pub(super) fn print(head: &Head<'_>, root: &Block<'_>, cursor: Cursor, text: &str) -> String {
    let mut printer = Printer {
        text,
        out: String::with_capacity(text.len()),
        may_gap: false,
    };
    for line in &head.lines {
        printer.comment(line, 0);
    }
    if head.has_gap {
        printer.gap();
    }
    printer.sections(root, cursor);
    printer.out
}

struct Printer<'t> {
    text: &'t str,
    out: String,
    /// `true` if a blank line may follow. It may not follow the start of a block, another blank line, or a block scalar
    /// to which it would belong.
    may_gap: bool,
}

impl Printer<'_> {
    /// Prints the top level of a file. A blank line separates two keys, unless both are on one line.
    fn sections(&mut self, root: &Block<'_>, cursor: Cursor) {
        let mut above_is_long = false;
        for (index, row) in root.rows.iter().enumerate() {
            let (start, may_gap) = (self.out.len(), self.may_gap);
            self.row(row, cursor, 0, false);
            let printed = self.out.get(start..).unwrap_or_default();
            let is_long = printed.trim_matches('\n').contains('\n');
            let needs_gap = index > 0 && may_gap && !printed.starts_with('\n');
            if needs_gap && (is_long || above_is_long) {
                self.out.insert(start, '\n');
            }
            above_is_long = is_long;
        }
        self.lines(&root.tail, 0);
    }

    /// Prints a block. With `shared`, its first row continues the current line.
    fn block(&mut self, block: &Block<'_>, cursor: Cursor, indent: usize, mut shared: bool) {
        for row in &block.rows {
            self.row(row, cursor, indent, shared);
            shared = false;
        }
        self.lines(&block.tail, indent);
    }

    fn row(&mut self, row: &Row<'_>, cursor: Cursor, indent: usize, shared: bool) {
        if !shared {
            self.lines(&row.above, indent);
            if row.blank {
                self.gap();
            }
            self.indent(indent);
        }
        let within = |value| match row.key.and_then(Node::as_str) {
            Some(name) => cursor.under(name, value),
            None => cursor.item(value),
        };
        match row.key {
            Some(key) => {
                self.out.push_str(&scalar::short(key, self.text));
                self.out.push(':');
            }
            None => self.out.push('-'),
        }
        match &row.value {
            Value::Leaf(node) => self.leaf(*node, row, within(*node), indent),
            Value::Flow(node) => {
                self.out.push(' ');
                self.out
                    .push_str(&flow::line(*node, within(*node), self.text));
                self.end(row.behind);
            }
            Value::Block(block) => {
                let is_item = row.key.is_none();
                if is_item {
                    self.out.push(' ');
                } else {
                    self.end(row.behind);
                    self.may_gap = false;
                }
                self.block(block, within(block.node), indent + LEVEL, is_item);
            }
        }
    }

    /// Prints a value that is one piece. A comment goes on the first line of a block scalar, or on the last line of any
    /// other value.
    fn leaf(&mut self, node: Node<'_>, row: &Row<'_>, cursor: Cursor, indent: usize) {
        let scalar = node.as_scalar();
        let written = match scalar {
            Some(_) => scalar::laid_out(row.key, node, self.text, indent + LEVEL),
            None if node.is_null() => scalar::written(node, self.text).to_owned(),
            None => flow::line(node, cursor, self.text),
        };
        if !written.is_empty() {
            self.out.push(' ');
        }
        let is_block = scalar.is_some_and(|scalar| scalar.style == Style::Block);
        if let Some((first, lines)) = written.split_once('\n').filter(|_| is_block) {
            self.out.push_str(first);
            self.end(row.behind);
            self.out.push_str(lines);
            self.end(None);
        } else {
            self.out.push_str(&written);
            self.end(row.behind);
        }
        // After `|+` a blank line would belong to the scalar.
        self.may_gap = !(is_block
            && written
                .lines()
                .next()
                .is_some_and(|first| first.contains('+')));
    }

    fn lines(&mut self, lines: &[Line<'_>], indent: usize) {
        for line in lines {
            if line.blank {
                self.gap();
            }
            self.comment(line, indent);
        }
    }

    fn comment(&mut self, line: &Line<'_>, indent: usize) {
        self.indent(indent);
        self.out.push_str(line.text);
        self.end(None);
    }

    fn indent(&mut self, columns: usize) {
        self.out.extend(std::iter::repeat_n(' ', columns));
    }

    /// Ends a line, with a comment if there is one.
    fn end(&mut self, behind: Option<&str>) {
        if let Some(comment) = behind {
            self.out.push(' ');
            self.out.push_str(comment);
        }
        self.out.push('\n');
        self.may_gap = true;
    }

    /// Prints a blank line, if one may follow.
    fn gap(&mut self) {
        if self.may_gap {
            self.out.push('\n');
            self.may_gap = false;
        }
    }
}
