//! Parser events to nodes. The only place that knows the parser's events.

use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;
use std::ops::Range;

use granit_parser::{Event, Parser, ScalarStyle, Span as ParserSpan, StructureStyle};

use super::{Entry, FileId, Node, NodeKind, Scalar, Span, Style, control, limits, scan_error};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};

/// How a run over a stretch of text ended.
pub(super) enum Outcome {
    /// With the tree; `None` if there is nothing but white space and comments.
    Tree(Option<Node>),
    /// The text is YAML, but the tree would not say what it means.
    Unfaithful,
    /// The text is not YAML at this byte.
    Broken(usize),
    /// Too deep or too much to go on.
    Stopped,
}

/// Builds the tree of a stretch of a file.
pub(super) struct Builder<'a> {
    file: FileId,
    text: &'a str,
    range: Range<usize>,
    open: Vec<Open>,
    root: Option<Node>,
    nodes: usize,
    anchors: HashMap<usize, Span>,
    faithful: bool,
    /// End of the last event: the parser has understood the text up to here.
    understood: usize,
    /// The last scalar.
    value: Option<Span>,
}

/// A mapping or list whose end has not come yet.
struct Open {
    start: usize,
    flow: bool,
    children: Children,
}

enum Children {
    Items(Vec<Node>),
    Entries {
        entries: Vec<Entry>,
        key: Option<Node>,
    },
}

/// Why building stops; the fault has been reported.
struct Stop;

impl<'a> Builder<'a> {
    /// For the bytes `range` of `text`, whole lines.
    pub(super) fn new(file: FileId, text: &'a str, range: Range<usize>) -> Self {
        Self {
            file,
            text,
            understood: range.start,
            range,
            open: Vec::new(),
            root: None,
            nodes: 0,
            anchors: HashMap::new(),
            faithful: true,
            value: None,
        }
    }

    /// Runs the parser to its end.
    pub(super) fn run(&mut self, faults: &mut Faults) -> Outcome {
        let source = self.text.get(self.range.clone()).unwrap_or_default();
        let options = granit_parser::options! {
            emit_comments: false,
            emit_anchor_events: true,
            emit_unresolved_aliases: true,
            disallow_directives: true,
            flow_nesting_limit: limits::DEPTH + 1,
            block_nesting_limit: limits::DEPTH + 1,
        };
        let mut documents = 0;
        let mut first = None;
        for event in Parser::new_from_str_with_options(source, options) {
            let (event, at) = match event {
                Ok(event) => event,
                Err(error) => {
                    let at = self.range.start + error.marker().byte_offset().unwrap_or_default();
                    let fault = scan_error::diagnose(error.kind(), &self.place(at));
                    let stopped = fault.code == FaultCode::TooDeep;
                    if !control::faulted(self.text, at) {
                        faults.push(fault);
                    }
                    return if stopped {
                        Outcome::Stopped
                    } else {
                        Outcome::Broken(at)
                    };
                }
            };
            let span = self.span(&at);
            if let Event::DocumentStart(..) = event {
                documents += 1;
                if documents == 2 {
                    self.several_documents(first.unwrap_or(span), span, faults);
                    break;
                }
                first = Some(span);
            }
            if let Event::StreamEnd = event {
                break;
            }
            if self.event(event, span, &at, faults).is_err() {
                return Outcome::Stopped;
            }
            self.understood = self.understood.max(span.end);
        }
        match self.root.take() {
            _ if !self.faithful => Outcome::Unfaithful,
            Some(node) if node.is_null() && node.span.start == node.span.end => Outcome::Tree(None),
            root => Outcome::Tree(root),
        }
    }

    fn event(
        &mut self,
        event: Event<'_>,
        span: Span,
        at: &ParserSpan,
        faults: &mut Faults,
    ) -> Result<(), Stop> {
        if let (Some(tag), Some(range)) =
            (event.tag(), at.tag_span().and_then(|tag| tag.byte_range()))
        {
            let place = self.shifted(&range);
            faults.push(
                Diagnostic::error(
                    FaultCode::Tag,
                    place,
                    format!("the tag `{}`", tag.original()),
                )
                .label("tags mean nothing in the spec")
                .note("delete it, or put the text in quotes if it starts with a `!`"),
            );
        }
        match event {
            Event::Scalar(text, style, _, _) => self.scalar(&text, style, span, faults),
            Event::SequenceStart(style, _, _) => {
                self.start(style, span, Children::Items(Vec::new()), faults)
            }
            Event::MappingStart(style, _, _) => {
                let children = Children::Entries {
                    entries: Vec::new(),
                    key: None,
                };
                self.start(style, span, children, faults)
            }
            Event::SequenceEnd | Event::MappingEnd => self.end(span, faults),
            Event::Anchor(id, name) => {
                self.anchors.insert(id, span);
                faults.push(
                    Diagnostic::error(FaultCode::Anchor, span, format!("the anchor `&{name}`"))
                        .label("anchors and aliases have no place in the spec")
                        .note("define a type where a value is needed twice, or write it twice")
                        .note("put the text in quotes if it starts with a `&`"),
                );
                Ok(())
            }
            Event::Alias(id) => {
                let anchor = self.anchors.get(&id).copied();
                self.alias(span, anchor, faults)
            }
            Event::UnresolvedAlias(_) => self.alias(span, None, faults),
            _ => Ok(()),
        }
    }

    fn scalar(
        &mut self,
        text: &str,
        style: ScalarStyle,
        span: Span,
        faults: &mut Faults,
    ) -> Result<(), Stop> {
        self.value = Some(span);
        self.check_tabs(span, faults);
        if text.len() > limits::SCALAR_BYTES {
            let limit = limits::SCALAR_BYTES >> 20;
            let message = format!("this text is longer than {limit} MiB");
            let start = Span::new(self.file, span.start, self.next_boundary(span.start));
            faults.push(
                Diagnostic::error(FaultCode::ScalarTooLong, start, message).label("starts here"),
            );
            self.faithful = false;
            return self.add(placeholder(span), faults);
        }
        let style = match style {
            ScalarStyle::Plain => Style::Plain,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => Style::Quoted,
            ScalarStyle::Literal | ScalarStyle::Folded => Style::Block,
        };
        let null = style == Style::Plain && matches!(text, "~" | "null" | "Null" | "NULL");
        let node = if null {
            Node {
                span: self.behind_colon(span),
                kind: NodeKind::Null,
            }
        } else {
            Node {
                span: self.trimmed(span),
                kind: NodeKind::Scalar(Scalar {
                    text: text.to_owned(),
                    style,
                }),
            }
        };
        self.add(node, faults)
    }

    fn alias(&mut self, span: Span, anchor: Option<Span>, faults: &mut Faults) -> Result<(), Stop> {
        let name = self.text.get(span.start..span.end).unwrap_or_default();
        let mut fault = Diagnostic::error(FaultCode::Alias, span, format!("the alias `{name}`"))
            .label("anchors and aliases have no place in the spec")
            .note("write the value itself here, or define a type and name it in both places")
            .note("put the text in quotes if it starts with a `*`");
        if let Some(anchor) = anchor {
            fault = fault.also(anchor, "stands for the value here");
        }
        faults.push(fault);
        self.faithful = false;
        self.add(placeholder(span), faults)
    }

    fn start(
        &mut self,
        style: StructureStyle,
        span: Span,
        children: Children,
        faults: &mut Faults,
    ) -> Result<(), Stop> {
        let flow = style == StructureStyle::Flow;
        if flow {
            self.check_tabs(span, faults);
        }
        if self.open.len() >= limits::DEPTH {
            faults.push(scan_error::too_deep(&self.place(span.start)));
            return Err(Stop);
        }
        self.open.push(Open {
            start: span.start,
            flow,
            children,
        });
        Ok(())
    }

    fn end(&mut self, span: Span, faults: &mut Faults) -> Result<(), Stop> {
        let Some(open) = self.open.pop() else {
            return Ok(());
        };
        let (kind, last) = match open.children {
            Children::Items(items) => {
                let last = items.last().map(|item| item.span.end);
                (NodeKind::Sequence(items), last)
            }
            Children::Entries { mut entries, .. } => {
                let last = entries.last().map(|entry| entry.value.span.end);
                drop_duplicates(&mut entries, faults);
                (NodeKind::Mapping(entries), last)
            }
        };
        let end = if open.flow { Some(span.end) } else { last };
        let end = end.unwrap_or(open.start).max(open.start);
        self.add(
            Node {
                span: Span::new(self.file, open.start, end),
                kind,
            },
            faults,
        )
    }

    /// Puts a finished node where it belongs.
    fn add(&mut self, node: Node, faults: &mut Faults) -> Result<(), Stop> {
        self.nodes += 1;
        if self.nodes > limits::NODES {
            let limit = limits::NODES;
            let message = format!("the file holds more than {limit} values");
            faults.push(Diagnostic::error(
                FaultCode::TooManyNodes,
                node.span,
                message,
            ));
            return Err(Stop);
        }
        match self.open.last_mut() {
            None => self.root = Some(node),
            Some(Open {
                children: Children::Items(items),
                ..
            }) => items.push(node),
            Some(Open {
                children: Children::Entries { entries, key },
                ..
            }) => match key.take() {
                None => {
                    self.faithful &= check_key(&node, faults);
                    *key = Some(node);
                }
                Some(key) => entries.push(Entry { key, value: node }),
            },
        }
        Ok(())
    }

    fn several_documents(&self, first: Span, second: Span, faults: &mut Faults) {
        let first = self.root.as_ref().map_or(first, |root| {
            Span::new(
                self.file,
                root.span.start,
                self.next_boundary(root.span.start),
            )
        });
        faults.push(
            Diagnostic::error(
                FaultCode::SeveralDocuments,
                second,
                "a second document in one file",
            )
            .label("starts here")
            .also(first, "the first one starts here")
            .note("delete the `---`, or move what follows into a file of its own"),
        );
    }

    /// Tabs between the start of the line and a node.
    fn check_tabs(&self, node: Span, faults: &mut Faults) {
        let before = self.text.get(..node.start).unwrap_or_default();
        let rest = before.trim_end_matches([' ', '\t']);
        if !(rest.is_empty() || rest.ends_with('\n')) {
            return;
        }
        if let Some(tab) = scan_error::indenting_tab(self.file, self.text, rest.len()) {
            faults.push(tab);
        }
    }

    fn place(&self, at: usize) -> scan_error::Place<'a> {
        scan_error::Place {
            file: self.file,
            text: self.text,
            at,
            understood: self.understood,
            value: self.value,
            bracket: self.open.iter().rev().map(|open| open.start).find(|start| {
                // `[a: b]` opens a mapping without a bracket of its own.
                self.text
                    .get(*start..)
                    .is_some_and(|text| text.starts_with(['[', '{']))
            }),
        }
    }

    fn span(&self, at: &ParserSpan) -> Span {
        at.byte_range()
            .map_or(Span::point(self.file, self.range.start), |range| {
                self.shifted(&range)
            })
    }

    fn shifted(&self, range: &Range<usize>) -> Span {
        let start = self.range.start + range.start;
        Span::new(self.file, start, (self.range.start + range.end).max(start))
    }

    /// Without the white space that the parser counts to block texts.
    fn trimmed(&self, span: Span) -> Span {
        let text = self.text.get(span.start..span.end).unwrap_or_default();
        Span::new(
            self.file,
            span.start,
            span.start + text.trim_end_matches([' ', '\t', '\r', '\n']).len(),
        )
    }

    /// The parser puts an empty value before the colon.
    fn behind_colon(&self, span: Span) -> Span {
        if span.start < span.end {
            return span;
        }
        let rest = self.text.get(span.start..).unwrap_or_default();
        let spaces = rest.len() - rest.trim_start_matches(' ').len();
        match rest.get(spaces..) {
            Some(rest) if rest.starts_with(':') => Span::point(self.file, span.start + spaces + 1),
            _ => span,
        }
    }

    fn next_boundary(&self, at: usize) -> usize {
        self.text
            .get(at..)
            .and_then(|rest| rest.chars().next())
            .map_or(at, |character| at + character.len_utf8())
    }
}

/// Stands for what had a fault of its own, in a tree that nobody will see.
fn placeholder(span: Span) -> Node {
    Node {
        span,
        kind: NodeKind::Scalar(Scalar {
            text: String::new(),
            style: Style::Plain,
        }),
    }
}

/// Whether a key is one the spec can have.
fn check_key(key: &Node, faults: &mut Faults) -> bool {
    match &key.kind {
        NodeKind::Scalar(_) if is_merge(key) => {
            faults.push(
                Diagnostic::error(FaultCode::MergeKey, key.span, "the merge key `<<`")
                    .label("merge keys have no place in the spec")
                    .note("write the keys out, or define a type and name it"),
            );
            false
        }
        NodeKind::Scalar(_) => true,
        other => {
            let found = match other {
                NodeKind::Sequence(_) => "a list",
                NodeKind::Mapping(_) => "a mapping",
                _ => "empty or null",
            };
            let message = format!("a key that is {found}");
            faults.push(
                Diagnostic::error(FaultCode::KeyNotScalar, key.span, message)
                    .label("a key must be one word")
                    .note("put it in quotes if it is meant as text, as in `\"null\"`"),
            );
            false
        }
    }
}

fn is_merge(key: &Node) -> bool {
    key.as_plain() == Some("<<")
}

/// Faults keys that stand twice and keeps the first of each.
fn drop_duplicates(entries: &mut Vec<Entry>, faults: &mut Faults) {
    let mut first = HashMap::with_capacity(entries.len());
    let mut again = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        // Other keys have had their fault.
        let Some(name) = entry.key.as_str().filter(|_| !is_merge(&entry.key)) else {
            continue;
        };
        match first.entry(name) {
            Slot::Vacant(slot) => {
                slot.insert(entry.key.span);
            }
            Slot::Occupied(slot) => {
                again.push(index);
                faults.push(
                    Diagnostic::error(
                        FaultCode::DuplicateKey,
                        entry.key.span,
                        format!("the key `{name}` stands twice"),
                    )
                    .label("again here")
                    .also(*slot.get(), "first here")
                    .note("delete one of them or rename it"),
                );
            }
        }
    }
    if !again.is_empty() {
        let mut index = 0;
        entries.retain(|_| {
            index += 1;
            again.binary_search(&(index - 1)).is_err()
        });
    }
}
