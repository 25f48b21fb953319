//! A file as rows: everything that starts a line, with its comments.

use super::comments::{Comments, Line, begins_line, on_one_line};
use super::{flow, scalar};
use crate::source::{SourceFile, Span};
use crate::syntax::{Node, NodeKind, Style, Tree};

/// A mapping or list over several lines.
#[derive(Clone, Debug)]
pub(super) struct Block<'t> {
    /// The mapping or list.
    pub node: Node<'t>,
    /// The entries or items.
    pub rows: Vec<Row<'t>>,
    /// The comments after the last row.
    pub tail: Vec<Line<'t>>,
}

/// An entry or item.
#[derive(Clone, Debug)]
pub(super) struct Row<'t> {
    /// The comments above the row.
    pub above: Vec<Line<'t>>,
    /// `true` if the line directly above the row, below its comments, is blank.
    pub blank: bool,
    /// The key of an entry.
    pub key: Option<Node<'t>>,
    /// The value of the entry, or the item.
    pub value: Value<'t>,
    /// The comment on the same line.
    pub behind: Option<&'t str>,
}

/// The content of a row.
#[derive(Clone, Debug)]
pub(super) enum Value<'t> {
    /// A scalar, an empty value, or an empty mapping or list.
    Leaf(Node<'t>),
    /// A mapping or list in brackets that can be on one line.
    Flow(Node<'t>),
    /// A mapping or list over several lines.
    Block(Block<'t>),
}

/// The start of the next part of the file.
#[derive(Clone, Copy)]
struct Next {
    start: usize,
    /// The column of the first text on its line.
    column: Option<usize>,
}

/// Returns the rows of a file.
pub(super) fn build<'t>(tree: &'t Tree<'_>, file: &'t SourceFile) -> Block<'t> {
    let mut builder = Builder {
        file,
        comments: Comments::new(file, tree.comments().collect()),
    };
    let next = Next {
        start: file.text.len(),
        column: None,
    };
    let mut root = builder.block(tree.root(), 0, next);
    root.tail.extend(builder.comments.lines_before(usize::MAX));
    root
}

/// Returns the rows of a mapping or list without comments.
pub(super) fn opened<'t>(node: Node<'t>, file: &'t SourceFile) -> Block<'t> {
    let mut builder = Builder {
        file,
        comments: Comments::new(file, Vec::new()),
    };
    let next = Next {
        start: file.text.len(),
        column: None,
    };
    builder.block(node, 0, next)
}

struct Builder<'t> {
    file: &'t SourceFile,
    comments: Comments<'t>,
}

impl<'t> Builder<'t> {
    /// Returns the rows of a mapping or list. A comment at its end belongs to it only if it is at column `floor` or
    /// further.
    fn block(&mut self, node: Node<'t>, floor: usize, next: Next) -> Block<'t> {
        let children: Vec<(Option<Node<'t>>, Node<'t>)> = match node.kind() {
            NodeKind::Mapping(entries) => entries
                .map(|entry| (Some(entry.key), entry.value))
                .collect(),
            _ => node.items().map(|item| (None, item)).collect(),
        };
        let is_flow = flow::is_flow(node, &self.file.text);
        let starts: Vec<usize> = children
            .iter()
            .map(|(key, value)| key.unwrap_or(*value).span().start)
            .collect();
        let begin = node.span().start;
        let is_below = node.as_sequence().is_some() && starts.first() == Some(&begin);
        let column = if is_below {
            // A list at the column of its key starts after its first dash.
            self.file.indentation(begin)
        } else {
            begin - self.file.line_start(begin)
        };
        let mut rows = Vec::new();
        for (index, (key, value)) in children.into_iter().enumerate() {
            let start = starts.get(index).copied().unwrap_or_default();
            let behind = match starts.get(index + 1) {
                Some(start) => Next {
                    start: *start,
                    column: Some(self.file.indentation(*start)),
                },
                None if is_flow => Next {
                    start: node.span().end.min(next.start),
                    column: None,
                },
                None => next,
            };
            let mut row = Row {
                above: self.comments.lines_before(start),
                blank: self.comments.is_below_blank(start),
                key,
                value: Value::Leaf(value),
                behind: None,
            };
            if index == 0 {
                // A first row has no blank line above it, wherever sorting moves it.
                match row.above.first_mut() {
                    Some(line) => line.blank = false,
                    None => row.blank = false,
                }
            }
            self.fill(&mut row, value, (column, is_flow), behind);
            rows.push(row);
        }
        let mut tail = Vec::new();
        if is_flow {
            tail = self.comments.lines_before(node.span().end);
        }
        while let Some(span) = self.comments.take_if(next.start, |span| {
            let column = self.file.indentation(span.start);
            !is_flow
                && begins_line(self.file, span.start)
                && column >= floor
                && next.column.is_none_or(|next| column > next)
        }) {
            tail.push(self.comments.line(span));
        }
        Block { node, rows, tail }
    }

    /// Fills in the value of a row. The row is in a mapping or list at `column`, with or without brackets.
    fn fill(
        &mut self,
        row: &mut Row<'t>,
        value: Node<'t>,
        (column, in_brackets): (usize, bool),
        next: Next,
    ) {
        let (file, text) = (self.file, self.file.text.as_str());
        let span = value.span();
        let mut inside = value.items().chain(value.entries().map(|entry| entry.key));
        let Some(first) = inside.next() else {
            return self.finish(row, value, in_brackets, next);
        };
        let is_flow = flow::is_flow(value, text);
        let has_comment = self.comments.has_before(span.end);
        if is_flow && flow::may_close(value, text) && !has_comment {
            row.value = Value::Flow(value);
            return self.finish(row, value, in_brackets, next);
        }
        if let Some(key) = row.key {
            let fits = |comment: Span| on_one_line(file, key.span().end, comment.start);
            let behind = self.comments.take_if(first.span().start, fits);
            row.behind = behind.map(|span| self.comments.slice(span));
        }
        let mut block = self.block(value, column + 1, next);
        if is_flow {
            let fits = |comment: Span| on_one_line(file, span.end, comment.start);
            if let Some(comment) = self.comments.take_if(next.start, fits) {
                block.tail.push(self.comments.line(comment));
            }
        }
        row.value = Value::Block(block);
    }

    /// Takes the comments around a value that is one piece. The last comment stays on the line of the value if it is
    /// there. An exception is a plain scalar in brackets that are opened: its comment was after a comma, and would now
    /// seem to cut it off.
    fn finish(&mut self, row: &mut Row<'t>, value: Node<'t>, in_brackets: bool, next: Next) {
        let span = value.span();
        let is_block = value
            .as_scalar()
            .is_some_and(|scalar| scalar.style == Style::Block);
        let from = if is_block {
            scalar::header(row.key, value, &self.file.text)
        } else {
            span.end
        };
        let number = self.file.line(from);
        let line = self.file.lines(number, number);
        let line = line.map_or(from, |(_, end)| end);
        let mut taken = Vec::new();
        while let Some(comment) = self.comments.take_if(line.min(next.start), |_| true) {
            taken.push(comment);
        }
        let may_follow = !in_brackets || value.as_plain().is_none();
        let last = taken.last().copied();
        if let Some(last) = last.filter(|last| last.start >= from && may_follow) {
            taken.pop();
            row.behind = Some(self.comments.slice(last));
        }
        let lines = taken.into_iter().map(|span| Line {
            text: self.comments.slice(span),
            blank: false,
        });
        row.above.extend(lines);
        let header = self.file.text.get(from..line).unwrap_or_default();
        let indicators = header.split([' ', '#']).next().unwrap_or_default();
        if is_block && indicators.contains('+') {
            self.comments.keep_blank(span.end);
        }
    }
}
