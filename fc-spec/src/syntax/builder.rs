//! Builds nodes from parser events. Only this module uses the events.

use crate::text;
use std::collections::HashMap;
use std::ops::Range;

use granit_parser::{Event, ScalarStyle, Span as ParserSpan, StructureStyle};

use super::node::Style;
use super::parser::parser;
use super::quote::quoted;
use super::tree::Tree;
use super::{control, key, limits, scan_error, slip, tab};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::source::{FileId, Span};

/// The outcome of parsing a part of a text.
pub(super) enum Outcome<'s> {
    /// The tree, or `None` if there are only white space and comments.
    Tree(Option<Tree<'s>>),
    /// The text is YAML, but the tree would have another meaning.
    Unfaithful,
    /// The text is not YAML at this byte.
    Broken(usize),
    /// The text is too deep or too large.
    Stopped,
}

/// Builds the tree of a part of a file.
pub(super) struct Builder<'a> {
    file: FileId,
    text: &'a str,
    range: Range<usize>,
    tree: Tree<'a>,
    open: Vec<Open>,
    nodes: usize,
    anchors: HashMap<usize, Span>,
    faithful: bool,
    /// The end of the last event. The text before it has been parsed.
    understood: usize,
    /// The last scalar.
    value: Option<Span>,
    /// `true` if the value of a merge key comes next.
    is_merged: bool,
    /// The start of the last alias. A text directly after it is not YAML.
    alias: Option<usize>,
}

/// A mapping or list whose end has not been reached.
struct Open {
    /// The index in the tree.
    at: usize,
    start: usize,
    /// The end of its last child.
    end: Option<usize>,
    flow: bool,
    children: Children,
}

#[derive(Clone, Copy)]
enum Children {
    Items,
    /// `true` if a value comes next.
    Entries {
        has_key: bool,
    },
}

/// Stops the builder. The error has been reported.
struct Stop;

impl<'a> Builder<'a> {
    /// Creates a builder for the bytes `range` of `text`, which are whole lines.
    pub(super) fn new(file: FileId, text: &'a str, range: Range<usize>) -> Self {
        Self {
            file,
            text,
            understood: range.start,
            tree: Tree::new(file, text, range.len()),
            range,
            open: Vec::new(),
            nodes: 0,
            anchors: HashMap::new(),
            faithful: true,
            value: None,
            is_merged: false,
            alias: None,
        }
    }

    /// Runs the parser to its end.
    pub(super) fn run(&mut self, faults: &mut Faults) -> Outcome<'a> {
        let source = self.text.get(self.range.clone()).unwrap_or_default();
        let mut documents = 0;
        let mut first = None;
        for event in parser(source, true) {
            let (event, at) = match event {
                Ok(event) => event,
                Err(error) => {
                    let at = self.range.start + error.marker().byte_offset().unwrap_or_default();
                    let parser = self.parser_state(at);
                    let starts = [parser.bracket, self.value.map(|value| value.start)];
                    let from = starts
                        .into_iter()
                        .flatten()
                        .fold(self.understood, usize::min);
                    let fault = scan_error::diagnose(error.kind(), &parser);
                    let stopped = fault.code == FaultCode::TooDeep;
                    let line = super::recover::line_start(self.text, at);
                    let has_cause = control::faulted(self.text, at)
                        || self.alias.is_some_and(|alias| alias >= line);
                    if !has_cause {
                        let slip =
                            || slip::behind_error(self.file, self.text, &self.range, from, at);
                        let slip = if stopped { None } else { slip() };
                        faults.push(slip.unwrap_or(fault));
                    }
                    return if stopped {
                        Outcome::Stopped
                    } else {
                        Outcome::Broken(at)
                    };
                }
            };
            let span = self.span(&at);
            if let Event::Comment(..) = event {
                self.tree.push_comment(span);
                continue;
            }
            if let Event::DocumentStart(..) = event {
                documents += 1;
                if documents == 2 {
                    self.several_documents(first.unwrap_or(span), span, faults);
                    self.faithful = false;
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
        if !self.faithful {
            return Outcome::Unfaithful;
        }
        tab::check(self.file, self.text, &self.range, &self.tree, faults);
        let root = self.tree.root();
        let is_empty = root.is_null() && root.span().start == root.span().end;
        let tree = std::mem::replace(&mut self.tree, Tree::new(self.file, self.text, 0));
        Outcome::Tree((!is_empty).then(|| tree.finish()))
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
                    text!("标签 `{tag}`", "the tag `{tag}`", tag = tag.original()),
                )
                .label(text!("规范中不用标签", "tags are not used in the spec"))
                .note(text!(
                    "删除它；如果文本以 `!` 开头，给它加上引号",
                    "delete it, or put the text in quotes if it starts with a `!`"
                )),
            );
        }
        match event {
            Event::Scalar(text, style, _, _) => self.scalar(&text, style, span, faults),
            Event::SequenceStart(style, _, _) => self.start(style, span, Children::Items, faults),
            Event::MappingStart(style, _, _) => {
                let children = Children::Entries { has_key: false };
                self.start(style, span, children, faults)
            }
            Event::SequenceEnd | Event::MappingEnd => self.end(span, faults),
            Event::Anchor(id, name) => {
                self.anchors.insert(id, span);
                faults.push(
                    Diagnostic::error(
                        FaultCode::Anchor,
                        span,
                        text!("锚点 `&{name}`", "the anchor `&{name}`"),
                    )
                    .label(text!(
                        "规范中不用锚点和别名",
                        "anchors and aliases are not used in the spec"
                    ))
                    .note(text!(
                        "定义一个类型，或把值写两遍",
                        "define a type, or write the value twice"
                    ))
                    .note(text!(
                        "如果文本以 `&` 开头，给它加上引号",
                        "put the text in quotes if it starts with a `&`"
                    )),
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
            let message = text!(
                "这段文本超过 {limit} MiB",
                "this text is longer than {limit} MiB"
            );
            let start = Span::new(self.file, span.start, self.next_boundary(span.start));
            faults.push(
                Diagnostic::error(FaultCode::ScalarTooLong, start, message)
                    .label(text!("从这里开始", "starts here")),
            );
            self.faithful = false;
            return self.placeholder(span, faults);
        }
        let style = match style {
            ScalarStyle::Plain => Style::Plain,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => Style::Quoted,
            ScalarStyle::Literal | ScalarStyle::Folded => Style::Block,
        };
        if style == Style::Plain {
            self.check_question_mark(text, span, faults);
        }
        let null = style == Style::Plain && matches!(text, "~" | "null" | "Null" | "NULL");
        let at = self.tree.len();
        if null {
            self.tree.push_null(self.behind_colon(span));
        } else {
            self.tree.push_scalar(self.trimmed(span), style, text);
        }
        self.add(at, faults)
    }

    /// Adds an empty scalar in place of a node with an error. The tree is never returned.
    fn placeholder(&mut self, span: Span, faults: &mut Faults) -> Result<(), Stop> {
        let at = self.tree.len();
        self.tree.push_scalar(span, Style::Plain, "");
        self.add(at, faults)
    }

    fn alias(&mut self, span: Span, anchor: Option<Span>, faults: &mut Faults) -> Result<(), Stop> {
        self.alias = Some(span.start);
        let name = self.text.get(span.start..span.end).unwrap_or_default();
        let fault = Diagnostic::error(
            FaultCode::Alias,
            span,
            text!("别名 `{name}`", "the alias `{name}`"),
        )
        .label(text!(
            "规范中不用锚点和别名",
            "anchors and aliases are not used in the spec"
        ))
        .note(text!(
            "在这里写出值，或定义一个类型，在两处引用",
            "write the value here, or define a type and refer to it in both places"
        ))
        .note(text!(
            "如果文本以 `*` 开头，给它加上引号",
            "put the text in quotes if it starts with a `*`"
        ))
        .also_if(anchor, text!("指的是这个值", "refers to this value"));
        // The error of the merge key covers its value.
        if !self.is_merged {
            faults.push(fault);
        }
        self.faithful = false;
        self.placeholder(span, faults)
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
            faults.push(scan_error::too_deep(&self.parser_state(span.start)));
            return Err(Stop);
        }
        self.open.push(Open {
            at: self.tree.len(),
            start: span.start,
            end: None,
            flow,
            children,
        });
        self.tree.open();
        Ok(())
    }

    fn end(&mut self, span: Span, faults: &mut Faults) -> Result<(), Stop> {
        let Some(open) = self.open.pop() else {
            return Ok(());
        };
        let is_mapping = matches!(open.children, Children::Entries { .. });
        if is_mapping {
            let again = key::repeated(self.tree.open_entries(open.at), faults);
            if !again.is_empty() {
                self.tree.remove_entries(open.at, &again);
            }
        }
        let end = if open.flow { Some(span.end) } else { open.end };
        let end = end.unwrap_or(open.start).max(open.start);
        let span = Span::new(self.file, open.start, end);
        self.tree.close(open.at, span, is_mapping);
        self.add(open.at, faults)
    }

    /// Counts a finished node. A key is also checked.
    fn add(&mut self, at: usize, faults: &mut Faults) -> Result<(), Stop> {
        let node = self.tree.node(at);
        self.nodes += 1;
        if self.nodes > limits::NODES {
            let limit = limits::NODES;
            let message = text!(
                "文件中的值超过 {limit} 个",
                "the file contains more than {limit} values"
            );
            faults.push(Diagnostic::error(
                FaultCode::TooManyNodes,
                node.span(),
                message,
            ));
            return Err(Stop);
        }
        if let Some(open) = self.open.last_mut() {
            match &mut open.children {
                Children::Entries { has_key } if !*has_key => {
                    self.is_merged = key::is_merge(node);
                    self.faithful &= key::check(node, faults);
                    *has_key = true;
                    return Ok(());
                }
                Children::Entries { has_key } => {
                    *has_key = false;
                    self.is_merged = false;
                }
                Children::Items => {}
            }
            open.end = Some(node.span().end);
        }
        Ok(())
    }

    fn several_documents(&self, first: Span, second: Span, faults: &mut Faults) {
        let first = if self.tree.len() == 0 {
            first
        } else {
            let start = self.tree.root().span().start;
            Span::new(self.file, start, self.next_boundary(start))
        };
        faults.push(
            Diagnostic::error(
                FaultCode::SeveralDocuments,
                second,
                text!("一个文件中有第二个文档", "a second document in one file"),
            )
            .label(text!("从这里开始", "starts here"))
            .also(
                first,
                text!("第一个从这里开始", "the first one starts here"),
            )
            .note(text!(
                "删除 `---`，或把后面的内容移到单独的文件",
                "delete the `---`, or move the rest into its own file"
            )),
        );
    }

    /// Reports `?` in brackets, because some parsers end a plain scalar there.
    fn check_question_mark(&self, text: &str, span: Span, faults: &mut Faults) {
        if text.contains('?') && self.open.last().is_some_and(|open| open.flow) {
            let message = text!(
                "有的 YAML 解析器不接受括号中不加引号的 `?`",
                "some YAML parsers reject an unquoted `?` in brackets"
            );
            faults.push(
                Diagnostic::error(FaultCode::AmbiguousWord, span, message).fix(
                    span,
                    quoted(text),
                    text!("加上引号", "quote it"),
                ),
            );
        }
    }

    /// Reports tabs between the start of the line and a node.
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

    fn parser_state(&self, at: usize) -> scan_error::ParserState<'a> {
        scan_error::ParserState {
            file: self.file,
            text: self.text,
            at,
            understood: self.understood,
            value: self.value,
            bracket: self.open.iter().rev().map(|open| open.start).find(|start| {
                // `[a: b]` opens a mapping without its own bracket.
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

    /// Returns a span without the white space that the parser includes in block scalars.
    fn trimmed(&self, span: Span) -> Span {
        let text = self.text.get(span.start..span.end).unwrap_or_default();
        Span::new(
            self.file,
            span.start,
            span.start + text.trim_end_matches([' ', '\t', '\r', '\n']).len(),
        )
    }

    /// Moves the empty value after the colon, because the parser puts it before.
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
