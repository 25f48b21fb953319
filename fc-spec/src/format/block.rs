//! A file as rows: what begins a line of its own, with the comments that go with it.

use super::comments::{Comments, Line, begins_line, column, indentation, line, on_one_line};
use super::{flow, scalar};
use crate::source::{SourceFile, Span};
use crate::syntax::{Node, NodeKind, Style, Tree};

/// A mapping or list that goes over several lines.
#[derive(Clone, Debug)]
pub(super) struct Block<'t> {
    /// What it is.
    pub node: Node<'t>,
    /// Its entries or items.
    pub rows: Vec<Row<'t>>,
    /// Comments behind the last of them.
    pub tail: Vec<Line<'t>>,
}

/// An entry or item.
#[derive(Clone, Debug)]
pub(super) struct Row<'t> {
    /// Comments above it.
    pub above: Vec<Line<'t>>,
    /// Whether the line right above it, below its comments, is blank.
    pub blank: bool,
    /// Key of an entry.
    pub key: Option<Node<'t>>,
    /// What stands under the key, or the item.
    pub value: Value<'t>,
    /// The comment on its line.
    pub behind: Option<&'t str>,
}

/// What stands in a row.
#[derive(Clone, Debug)]
pub(super) enum Value<'t> {
    /// A scalar, nothing, or an empty mapping or list.
    Leaf(Node<'t>),
    /// A mapping or list in brackets that could be on one line.
    Flow(Node<'t>),
    /// One that goes over several lines.
    Block(Block<'t>),
}

/// What begins behind a node, whatever that is in.
#[derive(Clone, Copy)]
struct Next {
    start: usize,
    /// Column at which its line begins.
    column: Option<usize>,
}

/// The rows of a file.
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

/// The rows of a mapping or list without a comment in it.
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
    /// `floor`: columns before a comment, at the least, that is the last thing in it.
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
            // A list no further in than its key begins behind its first dash.
            indentation(self.file, begin)
        } else {
            column(self.file, begin)
        };
        let mut rows = Vec::new();
        for (index, (key, value)) in children.into_iter().enumerate() {
            let start = starts.get(index).copied().unwrap_or_default();
            let behind = match starts.get(index + 1) {
                Some(start) => Next {
                    start: *start,
                    column: Some(indentation(self.file, *start)),
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
                // What was first is not below anything, wherever it goes.
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
            let column = indentation(self.file, span.start);
            !is_flow
                && begins_line(self.file, span.start)
                && column >= floor
                && next.column.is_none_or(|next| column > next)
        }) {
            tail.push(self.comments.line(span));
        }
        Block { node, rows, tail }
    }

    /// Finds what stands in a row, in a mapping or list that begins at a column, in brackets or not.
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

    /// Takes the comments around a value that is in one piece: the last one stays on its line if it stands there. But not
    /// where brackets are opened behind a text without quotes: there it was behind a comma, and would seem to cut the
    /// text off.
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
        let (_, line) = line(self.file, from);
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
