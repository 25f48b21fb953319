//! The syntax tree, with the place and the spelling of every node.

use super::{comment, slip};
use crate::diagnostic::Diagnostic;
use crate::model::Text;
use crate::source::{FileId, Span};
use crate::text;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

/// The tree of a file.
///
/// The nodes are in one list, ordered by their starts: a mapping or list before its content, a key before its value. A
/// text that the file contains unchanged is not stored again.
pub struct Tree<'s> {
    file: FileId,
    source: &'s str,
    parts: Cow<'s, Parts>,
}

/// A tree without its source.
#[derive(Clone)]
struct Parts {
    nodes: Vec<Raw>,
    /// Texts with escapes, folded lines or indentation.
    texts: Vec<Box<str>>,
    comments: Vec<Range<usize>>,
}

/// A node in the list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    start: u32,
    end: u32,
    form: Form,
}

/// The form of a node.
#[derive(Clone, Copy, Debug)]
enum Form {
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

/// A node of a tree.
#[derive(Clone, Copy)]
pub struct Node<'t> {
    tree: &'t Tree<'t>,
    at: usize,
}

/// The kind of a node.
#[derive(Clone, Debug)]
pub enum NodeKind<'t> {
    /// An empty value, or a plain `~` or `null`.
    Null,
    /// A string, number or truth value. The code that uses it decides which.
    Scalar(Scalar<'t>),
    /// A list.
    Sequence(Items<'t>),
    /// Keys and values in their order. Each key occurs once and is a [`NodeKind::Scalar`].
    Mapping(Entries<'t>),
}

/// A scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scalar<'t> {
    /// The text. A plain scalar keeps its spelling (`0x0A01`). Other scalars have their escapes and line folding
    /// resolved.
    pub text: &'t str,
    /// The style.
    pub style: Style,
}

/// The style of a scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Style {
    /// Without quotes.
    Plain,
    /// In `'…'` or `"…"`.
    Quoted,
    /// After `|` or `>`.
    Block,
}

/// A key and its value.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'t> {
    /// The key; always a [`NodeKind::Scalar`].
    pub key: Node<'t>,
    /// The value.
    pub value: Node<'t>,
}

/// The items of a list.
#[derive(Clone, Debug)]
pub struct Items<'t> {
    next: Node<'t>,
    end: usize,
}

/// The entries of a mapping.
#[derive(Clone, Debug)]
pub struct Entries<'t>(Items<'t>);

/// The number of bytes per node in a dense file.
const BYTES_PER_NODE: usize = 8;

/// A tree without nodes, for [`Node::nothing`].
static EMPTY: Tree<'static> = Tree {
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

    pub(super) fn push_comment(&mut self, span: Span) {
        self.parts.to_mut().comments.push(span.start..span.end);
    }

    fn spans(&self, ranges: &[Range<usize>]) -> impl Iterator<Item = Span> {
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

fn widen(number: u32) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

impl<'t> Entry<'t> {
    /// Returns the text of the key.
    #[must_use]
    pub fn name(self) -> &'t str {
        self.key.as_str().unwrap_or_default()
    }

    /// Returns the span of the key and the value.
    #[must_use]
    pub fn span(self) -> Span {
        self.key.span().to(self.value.span())
    }
}

impl<'t> Node<'t> {
    /// Returns a null without a place.
    #[must_use]
    pub fn nothing() -> Self {
        EMPTY.root()
    }

    fn raw(self) -> Raw {
        self.tree.parts.nodes.get(self.at).copied().unwrap_or(Raw {
            start: 0,
            end: 0,
            form: Form::Null,
        })
    }

    /// Returns the index in the tree's list.
    pub(super) fn at(self) -> usize {
        self.at
    }

    /// Returns the index of the node after this one and its content.
    fn behind(self) -> usize {
        match self.raw().form {
            Form::Sequence(size) | Form::Mapping(size) => self.at + widen(size).max(1),
            _ => self.at + 1,
        }
    }

    /// Returns the span without surrounding white space. A block mapping or list ends at the end of its last child. An
    /// empty value (`key:`) has the empty span after the colon.
    #[must_use]
    pub fn span(self) -> Span {
        let raw = self.raw();
        Span::new(self.tree.file, widen(raw.start), widen(raw.end))
    }

    /// Returns the kind.
    #[must_use]
    pub fn kind(self) -> NodeKind<'t> {
        match self.raw().form {
            Form::Null => NodeKind::Null,
            Form::Sequence(_) => NodeKind::Sequence(self.items()),
            Form::Mapping(_) => NodeKind::Mapping(self.entries()),
            Form::Plain | Form::Quoted | Form::Kept(..) => {
                self.as_scalar().map_or(NodeKind::Null, NodeKind::Scalar)
            }
        }
    }

    /// Returns the scalar.
    #[must_use]
    pub fn as_scalar(self) -> Option<Scalar<'t>> {
        let raw = self.raw();
        let (start, end) = (widen(raw.start), widen(raw.end));
        let (text, style) = match raw.form {
            Form::Null | Form::Sequence(_) | Form::Mapping(_) => return None,
            Form::Plain => (self.tree.source.get(start..end), Style::Plain),
            Form::Quoted => {
                let inside = start + 1..end.saturating_sub(1);
                (self.tree.source.get(inside), Style::Quoted)
            }
            Form::Kept(style, index) => {
                let text = self.tree.parts.texts.get(widen(index));
                (text.map(AsRef::as_ref), style)
            }
        };
        let text = text.unwrap_or_default();
        Some(Scalar { text, style })
    }

    /// Returns the text of a scalar in any style.
    #[must_use]
    pub fn as_str(self) -> Option<&'t str> {
        self.as_scalar().map(|scalar| scalar.text)
    }

    /// Returns the text of a scalar without quotes. Only this style counts for numbers, truth values and codes.
    #[must_use]
    pub fn as_plain(self) -> Option<&'t str> {
        self.as_scalar()
            .filter(|scalar| scalar.style == Style::Plain)
            .map(|scalar| scalar.text)
    }

    /// Returns the comments about the node: those directly above its line, and the one on its line. Returns none if
    /// another node precedes it on the line.
    pub fn comments(self) -> impl Iterator<Item = Span> {
        let comments = &self.tree.parts.comments;
        let about = comment::about(comments, self.tree.source, self.span().start);
        self.tree.spans(comments.get(about).unwrap_or_default())
    }

    /// Returns the error of a plain scalar that continues as a comment.
    pub(crate) fn cut_off(self) -> Option<Diagnostic> {
        self.as_plain()?;
        let (span, source) = (self.span(), self.tree.source);
        let comment = comment::behind(source, span)?;
        Some(comment::cut(
            span.file,
            source,
            span.start,
            comment.start,
            false,
        ))
    }

    /// Returns the error of a plain scalar with wrong punctuation: `type:u8`, `［1，2］`.
    pub(crate) fn slip(self) -> Option<Diagnostic> {
        self.as_plain()?;
        let span = self.span();
        slip::of_scalar(span, self.tree.source.get(span.start..span.end)?)
    }

    /// Returns the items of a list.
    #[must_use]
    pub fn as_sequence(self) -> Option<Items<'t>> {
        matches!(self.raw().form, Form::Sequence(_)).then(|| self.inside())
    }

    /// Returns the entries of a mapping.
    #[must_use]
    pub fn as_mapping(self) -> Option<Entries<'t>> {
        matches!(self.raw().form, Form::Mapping(_)).then(|| Entries(self.inside()))
    }

    /// Returns the items of a list, or none for another node.
    #[must_use]
    pub fn items(self) -> Items<'t> {
        self.as_sequence().unwrap_or_default()
    }

    /// Returns the entries of a mapping, or none for another node.
    #[must_use]
    pub fn entries(self) -> Entries<'t> {
        self.as_mapping().unwrap_or_default()
    }

    /// Returns the direct children: keys and values.
    fn inside(self) -> Items<'t> {
        Items {
            next: self.tree.node(self.at + 1),
            end: self.behind(),
        }
    }

    /// Returns the entry of a mapping with this key.
    #[must_use]
    pub fn entry(self, key: &str) -> Option<Entry<'t>> {
        self.entries().find(|entry| entry.key.is(key))
    }

    /// Returns `true` for a scalar with this text.
    fn is(self, text: &str) -> bool {
        let raw = self.raw();
        let (start, end) = (widen(raw.start), widen(raw.end));
        let range = match raw.form {
            Form::Null | Form::Sequence(_) | Form::Mapping(_) => return false,
            Form::Plain => start..end,
            Form::Quoted => start + 1..end.saturating_sub(1),
            Form::Kept(..) => return self.as_str() == Some(text),
        };
        let found = self.tree.source.as_bytes().get(range).unwrap_or_default();
        // Most keys differ in length or first byte, so a call to compare them would cost more.
        found.len() == text.len()
            && found.first() == text.as_bytes().first()
            && found == text.as_bytes()
    }

    /// Returns the value of a mapping under this key.
    #[must_use]
    pub fn get(self, key: &str) -> Option<Node<'t>> {
        self.entry(key).map(|entry| entry.value)
    }

    /// Returns `true` for a null.
    #[must_use]
    pub fn is_null(self) -> bool {
        matches!(self.raw().form, Form::Null)
    }

    /// Returns `true` if one of these gaps is inside the node, or directly after it.
    pub(crate) fn lacks(self, gaps: &[Span], key: Span) -> bool {
        let end = self.span().end.max(key.end);
        gaps.iter().any(|gap| {
            let between = self.tree.source.get(end..gap.start.max(end));
            // The colon of an empty value may be all that is between.
            let is_behind =
                between.is_some_and(|text| text.trim_matches([':', ' ', '\r', '\n']).is_empty());
            gap.file == key.file && gap.start > key.start && (gap.start < end || is_behind)
        })
    }

    /// Returns `true` if only white space follows in the file.
    #[must_use]
    pub(crate) fn ends_file(self) -> bool {
        let behind = self.tree.source.get(self.span().end..);
        behind.is_some_and(|behind| behind.trim().is_empty())
    }

    /// Returns a description for "expected a list, found {}".
    #[must_use]
    pub fn describe(self) -> Text {
        match self.kind() {
            NodeKind::Null => text!("空值", "nothing"),
            NodeKind::Scalar(scalar) => match scalar.style {
                Style::Plain => text!("不加引号的值", "a plain value"),
                Style::Quoted => text!("加引号的文本", "a quoted text"),
                Style::Block => text!("多行文本", "a block text"),
            },
            NodeKind::Sequence(_) => text!("列表", "a list"),
            NodeKind::Mapping(_) => text!("映射", "a mapping"),
        }
    }
}

/// Shows the description and the place, without the content.
impl fmt::Debug for Node<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {:?}", self.describe().en, self.span())
    }
}

impl<'t> Iterator for Items<'t> {
    type Item = Node<'t>;

    fn next(&mut self) -> Option<Node<'t>> {
        let node = self.next;
        if node.at >= self.end {
            return None;
        }
        self.next.at = node.behind();
        Some(node)
    }
}

/// Returns no items.
impl Default for Items<'_> {
    fn default() -> Self {
        Self {
            next: Node::nothing(),
            end: 0,
        }
    }
}

impl<'t> Iterator for Entries<'t> {
    type Item = Entry<'t>;

    fn next(&mut self) -> Option<Entry<'t>> {
        let key = self.0.next()?;
        let value = self.0.next()?;
        Some(Entry { key, value })
    }
}

/// Returns no entries.
impl Default for Entries<'_> {
    fn default() -> Self {
        Self(Items::default())
    }
}
