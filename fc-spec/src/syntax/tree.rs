//! The syntax tree of a file, as one list of nodes.

use super::node::{Entries, Items, Node, Style};
use crate::source::{FileId, Span};
use std::borrow::Cow;
use std::ops::Range;

/// The tree of a file.
///
/// The nodes are in one list, ordered by their starts: a mapping or list before its content, a key before its value. A
/// text that the file contains unchanged is not stored again.
pub struct Tree<'s> {
    pub(super) file: FileId,
    pub(super) source: &'s str,
    pub(super) parts: Cow<'s, Parts>,
}

/// A tree without its source.
#[derive(Clone)]
pub(super) struct Parts {
    pub(super) nodes: Vec<Raw>,
    /// Texts with escapes, folded lines or indentation.
    pub(super) texts: Vec<Box<str>>,
    pub(super) comments: Vec<Range<usize>>,
}

/// A node in the list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    pub(super) start: u32,
    pub(super) end: u32,
    pub(super) form: Form,
}

/// The form of a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    Null,
    /// The text is the whole span.
    Plain,
    /// The text is the span without its quotes.
    Quoted,
    /// The text is in `texts`, with this index.
    Kept(Style, u32),
    /// The number is that of the nodes in it, including itself.
    Sequence(u32),
    Mapping(u32),
}

/// The number of bytes per node in a dense file.
const BYTES_PER_NODE: usize = 8;

/// A tree without nodes, for [`Node::nothing`].
pub(super) static EMPTY: Tree<'static> = Tree {
    file: FileId(0),
    source: "",
    parts: Cow::Owned(Parts {
        nodes: Vec::new(),
        texts: Vec::new(),
        comments: Vec::new(),
    }),
};

impl<'s> Tree<'s> {
    /// Creates an empty tree with room for the nodes of `bytes` bytes.
    pub(super) fn new(file: FileId, source: &'s str, bytes: usize) -> Self {
        Self {
            file,
            source,
            parts: Cow::Owned(Parts {
                nodes: Vec::with_capacity(bytes / BYTES_PER_NODE),
                texts: Vec::new(),
                comments: Vec::new(),
            }),
        }
    }

    /// Returns the outermost node.
    #[must_use]
    pub fn root(&self) -> Node<'_> {
        self.node(0)
    }

    /// Returns the spans of all comments with their `#`, in their order.
    pub fn comments(&self) -> impl Iterator<Item = Span> {
        self.spans(&self.parts.comments)
    }

    /// Returns the comments of the tree's text, sorted.
    pub(crate) fn sorted_comments<'t>(&self, text: &'t str) -> Vec<&'t str> {
        let texts = self
            .comments()
            .filter_map(|span| text.get(span.start..span.end));
        let mut texts: Vec<&str> = texts.collect();
        texts.sort_unstable();
        texts
    }

    pub(super) fn push_comment(&mut self, span: Span) {
        self.parts.to_mut().comments.push(span.start..span.end);
    }

    pub(super) fn spans(&self, ranges: &[Range<usize>]) -> impl Iterator<Item = Span> {
        let spans = ranges.iter();
        spans.map(|range| Span::new(self.file, range.start, range.end))
    }

    pub(super) fn node(&self, at: usize) -> Node<'_> {
        Node { tree: self, at }
    }

    /// Returns the number of nodes, which is the index of the next one.
    pub(super) fn len(&self) -> usize {
        self.parts.nodes.len()
    }

    /// Returns all nodes, ordered by their starts.
    pub(super) fn nodes(&self) -> impl Iterator<Item = Node<'_>> {
        (0..self.parts.nodes.len()).map(|at| self.node(at))
    }

    pub(super) fn push_null(&mut self, span: Span) {
        self.push(span, Form::Null);
    }

    pub(super) fn push_scalar(&mut self, span: Span, style: Style, text: &str) {
        let inside = match style {
            Style::Plain => (span.start, span.end, Form::Plain),
            Style::Quoted => (span.start + 1, span.end.saturating_sub(1), Form::Quoted),
            Style::Block => (0, 0, Form::Null),
        };
        let (start, end, form) = inside;
        let form = if style != Style::Block && self.source.get(start..end) == Some(text) {
            form
        } else {
            self.parts.to_mut().texts.push(text.into());
            Form::Kept(style, narrow(self.parts.texts.len() - 1))
        };
        self.push(span, form);
    }

    /// Adds a mapping or list with an unknown end.
    pub(super) fn open(&mut self) {
        self.parts.to_mut().nodes.push(Raw {
            start: 0,
            end: 0,
            form: Form::Null,
        });
    }

    /// Completes the opened node at `at`. All nodes after it become its content.
    pub(super) fn close(&mut self, at: usize, span: Span, is_mapping: bool) {
        let size = narrow(self.parts.nodes.len().saturating_sub(at));
        if let Some(node) = self.parts.to_mut().nodes.get_mut(at) {
            *node = Raw {
                start: narrow(span.start),
                end: narrow(span.end),
                form: if is_mapping {
                    Form::Mapping(size)
                } else {
                    Form::Sequence(size)
                },
            };
        }
    }

    /// Returns the entries of the open mapping at `at`.
    pub(super) fn open_entries(&self, at: usize) -> Entries<'_> {
        Entries(Items {
            next: self.node(at + 1),
            end: self.parts.nodes.len(),
        })
    }

    /// Removes entries of the open mapping at `at`, by the sorted indices of their keys.
    pub(super) fn remove_entries(&mut self, at: usize, keys: &[usize]) {
        let mut kept = Vec::new();
        for entry in self.open_entries(at) {
            if keys.binary_search(&entry.key.at).is_err() {
                kept.push(entry.key.at..entry.value.behind());
            }
        }
        let mut end = at + 1;
        for range in kept {
            let length = range.len();
            self.parts.to_mut().nodes.copy_within(range, end);
            end += length;
        }
        self.parts.to_mut().nodes.truncate(end);
    }

    /// Returns the same tree for another source, which is equal wherever the tree has a node.
    pub(super) fn of_source(self, source: &str) -> Tree<'_> {
        Tree {
            source,
            file: self.file,
            parts: Cow::Owned(self.parts.into_owned()),
        }
    }

    /// Returns the same tree for its source at another address.
    pub(crate) fn over<'a>(&'a self, source: &'a str) -> Tree<'a> {
        Tree {
            source,
            file: self.file,
            parts: Cow::Borrowed(&self.parts),
        }
    }

    /// Returns the tree without its source, so that both can be stored together.
    pub(crate) fn bare(self) -> Tree<'static> {
        self.of_source("")
    }

    /// Frees the unused capacity.
    pub(super) fn finish(mut self) -> Self {
        let parts = self.parts.to_mut();
        parts.nodes.shrink_to_fit();
        parts.comments.shrink_to_fit();
        self
    }

    fn push(&mut self, span: Span, form: Form) {
        self.parts.to_mut().nodes.push(Raw {
            start: narrow(span.start),
            end: narrow(span.end),
            form,
        });
    }
}

/// Converts offsets and counts. They fit, because the size of a file is limited.
fn narrow(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

pub(super) fn widen(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}
