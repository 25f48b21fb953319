//! The nodes of a syntax tree, with the place and the spelling of each.

use super::tree::{EMPTY, Form, Raw, Tree, widen};
use super::{comment, slip};
use crate::diagnostic::Diagnostic;
use crate::model::Text;
use crate::source::Span;
use crate::text;
use std::fmt;

/// A node of a tree.
#[derive(Clone, Copy)]
pub struct Node<'t> {
    pub(super) tree: &'t Tree<'t>,
    pub(super) at: usize,
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
    pub(super) next: Node<'t>,
    pub(super) end: usize,
}

/// The entries of a mapping.
#[derive(Clone, Debug)]
pub struct Entries<'t>(pub(super) Items<'t>);

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
    pub(super) fn behind(self) -> usize {
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
