//! Edits the files of a spec when the owner answers a question.

use super::answer_scope::{CoveredFact, Found};
use super::draft::{AnswerDraft, Origin, Sourced};
use super::settle::Said;
use crate::language::ambiguous_scalar::misread;
use crate::language::grammar::{
    ANSWER, Answer, CHANGE, CODE, COMMAND, COMMON, CONFIRMED, EFFECT, FIELD, OPERATION, REPORT,
    TEXT,
};
use crate::model::{
    AnswerKind, BodyState, Confirmation, Fact, Kind, Lang, Languages, Operation, Text,
};
use crate::source::{Edits, SourceFile, Sources, Span};
use crate::syntax::{Entry, Node, quoted};

/// Placeholder for a value that only the owner knows.
const TO_BE_SAID: &str = "…";

impl Confirmation {
    /// Returns the confirmation as a YAML mapping on one line.
    pub(super) fn to_yaml(&self) -> String {
        let by = text(&self.by);
        let mut entries = vec![
            (CONFIRMED.by.name, by.as_str()),
            (CHANGE.date.name, &self.date),
        ];
        let reference = self.reference.as_deref().map(text);
        let reply = self.reply.as_deref().map(text);
        entries.extend(
            reference
                .as_deref()
                .map(|it| (CONFIRMED.reference.name, it)),
        );
        entries.extend(reply.as_deref().map(|it| (CONFIRMED.reply.name, it)));
        confirmation(entries)
    }
}

fn confirmation<'v>(entries: impl IntoIterator<Item = (&'static str, &'v str)>) -> String {
    let entries = entries
        .into_iter()
        .map(|(key, value)| format!("{key}: {value}"));
    format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
}

/// Collects the edits of one answer.
pub(super) struct AnswerEditor<'s> {
    sources: &'s Sources,
    /// Languages of new texts.
    texts: Languages,
    /// The owner's answer. Without one, every value is a placeholder.
    said: Option<&'s Said>,
    pub edits: Edits,
}

impl<'s> AnswerEditor<'s> {
    pub fn new(sources: &'s Sources, texts: Languages, said: Option<&'s Said>) -> Self {
        Self {
            sources,
            texts,
            said,
            edits: Edits::default(),
        }
    }

    /// Returns the new value of the fact at `path`, as YAML; `None` keeps the current value.
    fn value(&self, path: &str) -> Option<String> {
        match self.said {
            Some(said) => said.value(path),
            None => Some(TO_BE_SAID.to_owned()),
        }
    }

    /// Returns the confirmation, with the owner's name and the date, as a YAML mapping.
    fn confirmed(&self) -> String {
        let blank = [CONFIRMED.by.name, CHANGE.date.name].map(|key| (key, TO_BE_SAID));
        let said = self.said.map(|said| said.confirmation.to_yaml());
        said.unwrap_or_else(|| confirmation(blank))
    }

    /// Returns the changed lines as a diff.
    pub fn diff(&self) -> String {
        let file = self.edits.place().and_then(|span| self.file(span));
        file.map(|file| self.edits.diff(file)).unwrap_or_default()
    }

    fn file(&self, span: Span) -> Option<&'s SourceFile> {
        self.sources.get(span.file)
    }

    /// Returns spaces up to the column at which the span starts.
    fn indent(&self, span: Span) -> String {
        let file = self.file(span);
        let column = file.map_or(1, |file| file.line_col(span.start).column);
        " ".repeat(column.saturating_sub(1))
    }

    /// Returns `true` if a mapping or list is written in braces or brackets.
    fn is_flow(&self, node: Node<'_>) -> bool {
        self.sources.slice(node.span()).starts_with(['{', '['])
    }

    /// Returns `true` if the operation and its answers are in block style. The edits of a fact replace whole lines.
    pub fn has_lines(&self, operation: Node<'_>) -> bool {
        let answers = COMMON.answers.of(operation);
        !self.is_flow(operation) && !answers.is_some_and(|node| self.is_flow(node))
    }

    /// Inserts a line below the span.
    fn line_after(&mut self, span: Span, line: &str) {
        if let Some(file) = self.file(span) {
            self.edits.add_line(file, span, line);
        }
    }

    /// Writes the facts that an answer covers, and the owner's confirmation.
    pub fn settle_answer(&mut self, answer: &AnswerDraft<'_>, covered: &[CoveredFact<'_>]) {
        for covered in covered {
            let path = covered.path.as_str().unwrap_or_default();
            match covered.found {
                Found::Fact(..) if !self.has_lines(answer.holder) => {}
                Found::Fact(fact, state, kind) => self.fact(answer.holder, kind, fact, state),
                Found::Value(node) => {
                    if let Some(value) = self.value(path) {
                        self.edits.replace(node.span(), value);
                    }
                }
                Found::Absent(node) => {
                    let key = path.rsplit('.').next().unwrap_or_default();
                    if let Some(value) = self.value(path) {
                        self.add(node, key, &value);
                    }
                }
                Found::Several(_) | Found::Nowhere(_) => {}
            }
        }
        self.confirm(answer.origin.node);
    }

    /// Writes a lost fact without an answer, and adds an answer with the owner's confirmation.
    pub fn settle_loss(
        &mut self,
        operation: &Sourced<'_, Operation>,
        fact: Fact,
        state: BodyState,
        asked: &Text,
    ) {
        let Sourced { item, origin } = operation;
        if !self.has_lines(origin.node) {
            return;
        }
        self.fact(origin.node, item.kind(), fact, state);
        self.answer(*origin, fact, state, asked);
    }

    /// Adds a key after the first key of a field, which is its type.
    fn add(&mut self, node: Node<'_>, key: &str, value: &str) {
        let first = node.entries().next();
        match first {
            None => {
                let ty = self.sources.slice(node.span());
                let long = format!("{{ {}: {ty}, {key}: {value} }}", FIELD.r#type.name);
                self.edits.replace(node.span(), long);
            }
            Some(first) if self.is_flow(node) => {
                self.edits
                    .insert_after(first.value.span(), format!(", {key}: {value}"));
            }
            Some(first) => {
                let indent = self.indent(first.key.span());
                self.line_after(first.value.span(), &format!("{indent}{key}: {value}"));
            }
        }
    }

    /// Writes a fact of an operation.
    fn fact(&mut self, operation: Node<'_>, kind: Kind, fact: Fact, state: BodyState) {
        let is_open = state == BodyState::Open;
        let code = OPERATION.code.of(operation);
        let effect = COMMAND.effect.of(operation);
        let request = match kind {
            Kind::Report => REPORT.body.name,
            Kind::Command | Kind::Stream => COMMAND.request.name,
        };
        match fact {
            Fact::Code => self.fact_value(code, CODE.value.of(code), fact),
            Fact::Effect => self.fact_value(effect, EFFECT.value.of(effect), fact),
            Fact::Request => {
                let state = OPERATION.request_state.entry(operation);
                self.body(state, operation.entry(request), request, fact, is_open);
            }
            Fact::Response => {
                let state = OPERATION.response_state.entry(operation);
                let body = COMMAND.response.entry(operation);
                self.body(state, body, COMMAND.response.name, fact, is_open);
            }
            // The words of a heading are under `zh` and `en`. The type needs no value.
            Fact::Title | Fact::Type => {}
        }
    }

    /// Replaces a value, together with its `state` if it has one.
    fn fact_value(&mut self, node: Option<Node<'_>>, inferred: Option<Node<'_>>, fact: Fact) {
        let Some(node) = node else {
            return;
        };
        let inferred = inferred.and_then(Node::as_str).map(str::to_owned);
        let said = self.value(fact.name());
        let said = said.filter(|said| inferred.is_none() || said != TO_BE_SAID);
        if let Some(value) = said.or(inferred) {
            self.edits.replace(node.span(), value);
        }
    }

    /// Writes a body and removes its state. Keeps the body if the owner gives no other.
    fn body(
        &mut self,
        state: Option<Entry<'_>>,
        body: Option<Entry<'_>>,
        key: &str,
        fact: Fact,
        is_open: bool,
    ) {
        let Some(state) = state else {
            return;
        };
        let span = state.key.span().to(state.value.span());
        let value = self.value(fact.name());
        let value = value.filter(|value| is_open || value != TO_BE_SAID);
        let Some(file) = self.file(span) else {
            return;
        };
        let Some(value) = value else {
            return self.edits.remove_lines(file, span);
        };
        let indent = self.indent(state.key.span());
        let value = value.trim_end();
        let text = if value.starts_with('{') || value == TO_BE_SAID {
            format!("{indent}{key}: {value}")
        } else {
            let mut text = format!("{indent}{key}:");
            for line in value.lines() {
                let line = format!("\n{indent}  {line}");
                text.push_str(line.trim_end());
            }
            text
        };
        if let Some(body) = body {
            self.edits
                .remove_lines(file, body.key.span().to(body.value.span()));
        }
        self.edits.remove_lines(file, span);
        self.edits
            .replace(Span::point(span.file, line_start(file, span)), text + "\n");
    }

    /// Adds the owner's confirmation to an answer.
    fn confirm(&mut self, answer: Node<'_>) {
        // The new key goes after the keys that precede it in the grammar.
        let rank = |key: &str| {
            Answer::TABLE
                .keys
                .iter()
                .position(|known| known.name == key)
        };
        let before = answer
            .entries()
            .filter(|entry| rank(entry.name()) < rank(ANSWER.confirmed.name));
        let Some(entry) = before.last() else {
            return;
        };
        let confirmed = format!("{}: {}", ANSWER.confirmed.name, self.confirmed());
        if self.is_flow(answer) {
            self.edits
                .insert_after(entry.value.span(), format!(", {confirmed}"));
        } else {
            // The edit repeats the answer up to here, so that the diff shows which answer it is.
            let last = entry.value.span();
            let before = Span::new(last.file, answer.span().start, last.end);
            self.edits.replace(before, self.sources.slice(before));
            let indent = self.indent(entry.key.span());
            self.line_after(entry.value.span(), &format!("{indent}{confirmed}"));
        }
    }

    /// Adds an answer about a fact of an operation; `asked` is the text of the question.
    fn answer(&mut self, operation: Origin<'_>, fact: Fact, before: BodyState, asked: &Text) {
        let answers = COMMON.answers.entry(operation.node);
        let last = operation.node.entries().last();
        let Some((at, indent)) = answers.or(last).map(|entry| {
            let span = entry.key.span();
            (span.to(entry.value.span()), self.indent(span))
        }) else {
            return;
        };
        let (path, meanwhile) = (fact.name(), before.name());
        let mut lines = String::new();
        if answers.is_none() {
            lines = format!("{indent}{}:\n", COMMON.answers.name);
        }
        let entries = [
            (ANSWER.about.name, format!("{{ {path}: {meanwhile} }}")),
            (ANSWER.r#as.name, AnswerKind::Question.name().to_owned()),
            (ANSWER.confirmed.name, self.confirmed()),
        ];
        let texts = Lang::ALL.into_iter().filter(|it| self.texts.include(*it));
        let texts = texts.map(|lang| {
            let key = lang.pick(TEXT.zh.name, TEXT.en.name);
            (key, text(lang.text(asked)))
        });
        let entries = entries.into_iter().chain(texts);
        let entries: Vec<_> = entries
            .map(|(key, value)| format!("{key}: {value}"))
            .collect();
        lines += &indent;
        lines += "  - ";
        lines += &entries.join(&format!("\n{indent}    "));
        self.line_after(at, &lines);
    }
}

/// Returns a string as YAML on one line, which also fits between braces. Quotes it if a reader could take it for
/// something else.
pub(crate) fn text(text: &str) -> String {
    if text.contains(char::is_control) {
        // YAML in double quotes has the same escapes as JSON.
        return serde_json::Value::from(text).to_string();
    }
    let is_plain = |c: char| c.is_alphanumeric() || " _.-/()（），。、；“”？！".contains(c);
    let is_safe = text.starts_with(char::is_alphabetic)
        && !text.ends_with(' ')
        && text.chars().all(is_plain)
        && !matches!(text, "true" | "false" | "null")
        && misread(text).is_none();
    if is_safe {
        text.to_owned()
    } else {
        quoted(text)
    }
}

/// Returns the start of the line on which a span begins.
fn line_start(file: &SourceFile, span: Span) -> usize {
    let line = file.line(span.start);
    file.lines(line, line)
        .map_or(span.start, |(start, _)| start)
}
