//! Views that several pages share.

use crate::emit::markdown::available::AvailableView;
use crate::emit::markdown::book::Book;
use crate::emit::markdown::links::{Anchor, Link, Page};
use crate::emit::markdown::mentions::linked;
use crate::emit::markdown::rows::{Row, Rows};
use crate::emit::markdown::words::{self, Word as _};
use fc_spec::model::Lang;
use fc_spec::model::{
    Answer, Body, BodyState, Change, Code, Direction, Location, Operation, Port, Subject, Text,
};
use serde::Serialize;
use std::collections::HashMap;

/// A message and some of its fields.
#[derive(Debug, Serialize)]
pub(super) struct MessageView {
    pub(super) operation: Link,
    pub(super) side: &'static str,
    pub(super) fields: Vec<Link>,
}

/// The model, the language and the page of a view.
#[derive(Clone, Copy)]
pub(in crate::emit::markdown) struct Desk<'b, 'm> {
    pub(in crate::emit::markdown) book: &'b Book<'m>,
    pub(in crate::emit::markdown) lang: Lang,
    pub(in crate::emit::markdown) page: Page<'m>,
}

impl<'b, 'm> Desk<'b, 'm> {
    pub(super) fn rows(self) -> Rows<'b, 'm> {
        Rows {
            book: self.book,
            lang: self.lang,
            page: self.page,
        }
    }

    pub(super) fn link(self, page: Page<'_>, anchor: Anchor) -> String {
        self.page.link((page, anchor))
    }

    pub(super) fn spec(self, location: &Location) -> Link {
        Link {
            text: location.file.clone(),
            href: self.page.link_to_spec(location, self.lang),
        }
    }

    /// Returns a link with the title of an operation.
    pub(super) fn operation(self, operation: &Operation) -> Link {
        Link {
            text: self.lang.text(&operation.title).to_owned(),
            href: self.link(Page::Operation(operation), Anchor::none()),
        }
    }

    /// Returns the fields of a message for which `key` returns a name, by that name.
    pub(super) fn fields_by(
        self,
        operation: &Operation,
        direction: Direction,
        body: &Body,
        key: impl Fn(&Row) -> Option<&str>,
    ) -> HashMap<String, Vec<Link>> {
        let mut fields: HashMap<String, Vec<Link>> = HashMap::new();
        for row in self.rows().message(direction, &body.ty) {
            if let Some(name) = key(&row) {
                fields.entry(name.to_owned()).or_default().push(Link {
                    text: format!("`{}`", row.path()),
                    href: self.link(Page::Operation(operation), Anchor::named(row.anchor())),
                });
            }
        }
        fields
    }

    pub(super) fn answer(self, answer: &'m Answer) -> AnswerView {
        let rows = self.rows();
        AnswerView {
            ids: answer.ids.iter().map(|id| rows.conflict(id)).collect(),
            kind: answer.kind.word(self.lang),
            text: self.sentence(&answer.text),
            about: self.about(&answer.subject),
            runtime: answer.runtime,
            confirmed: answer
                .confirmed
                .as_ref()
                .map(|it| words::confirmed(it, self.lang)),
            spec: self.spec(&answer.location),
        }
    }

    /// Returns a link to a subject, or `None` on the page of that subject.
    pub(super) fn about(self, subject: &'m Subject) -> Option<Link> {
        let own = match (subject, self.page) {
            (Subject::Operation(name), Page::Operation(operation)) => *name == operation.name,
            (Subject::Protocol, Page::Index)
            | (Subject::Transport | Subject::Frame(None) | Subject::Envelope(None), Page::Wire)
            | (Subject::Codes, Page::Codes)
            | (Subject::Results(None), Page::Results)
            | (Subject::Table(_), Page::Tables)
            | (Subject::Type(_), Page::Types) => true,
            _ => false,
        };
        (!own).then(|| Link {
            text: self.book.name_of(subject, self.lang, self.page),
            href: self.page.link(self.book.place_of(subject)),
        })
    }

    /// Returns a sentence of the spec with links to the operations that it names.
    pub(super) fn sentence(self, text: &Text) -> String {
        linked(self.book, self.page, self.lang.text(text))
    }

    pub(super) fn answers(self, answers: impl IntoIterator<Item = &'m Answer>) -> Vec<AnswerView> {
        let answers = answers.into_iter();
        answers.map(|answer| self.answer(answer)).collect()
    }

    /// Returns the answers to exactly this subject.
    pub(super) fn answers_to(self, subject: &Subject) -> Vec<AnswerView> {
        self.answers(self.book.answers_to(subject).iter().copied())
    }

    /// Returns changes in their order.
    pub(super) fn history<'c>(
        self,
        changes: impl IntoIterator<Item = &'c Change>,
    ) -> Vec<HistoryItem> {
        let item = |change: &Change| HistoryItem {
            date: change.date.clone(),
            text: self.sentence(&change.text),
        };
        changes.into_iter().map(item).collect()
    }

    pub(super) fn ports(self) -> Vec<PortView> {
        let view = |port: &Port| PortView {
            number: port.number,
            role: port.role.word(self.lang),
            text: self.lang.text(&port.text).to_owned(),
        };
        self.book
            .model
            .transport
            .ports
            .each()
            .into_iter()
            .map(view)
            .collect()
    }

    /// Returns an entry for a list of operations.
    pub(super) fn entry(self, operation: &Operation) -> OperationEntry {
        let protocol = &self.book.model.protocol;
        let robot = self.lang.text(&protocol.robot.title);
        let app = self.lang.text(&protocol.app.title);
        let state = operation.state();
        let is_shown = operation.is_from_source() || state != BodyState::Stated;
        OperationEntry {
            link: self.operation(operation),
            name: operation.name.clone(),
            code: CodeView::new(&operation.code),
            kind: operation.kind().word(self.lang),
            effect: operation.effect().map(|effect| effect.word(self.lang)),
            direction: words::direction(operation.sender, robot, app),
            state: is_shown.then(|| state.word(self.lang)),
            deprecated: operation.deprecated.is_some(),
            available: AvailableView::of(self.book.model, operation.available.as_ref(), self.lang),
        }
    }
}

/// An answer to a gap of the source.
#[derive(Debug, Serialize)]
pub(super) struct AnswerView {
    ids: Vec<Link>,
    kind: &'static str,
    text: String,
    /// The subject; `None` on the page of that subject.
    about: Option<Link>,
    /// `true` if the answer concerns the runtime, so that no value of the spec changes it.
    runtime: bool,
    /// The confirmation.
    confirmed: Option<String>,
    spec: Link,
}

impl AnswerView {
    /// Removes the link to a conflict that the page already shows.
    pub(super) fn without(mut self, id: &str) -> Self {
        self.ids.retain(|link| link.text != id);
        self
    }
}

/// An entry of a list of operations.
#[derive(Debug, Serialize)]
pub(super) struct OperationEntry {
    link: Link,
    name: String,
    code: CodeView,
    kind: &'static str,
    effect: Option<&'static str>,
    direction: String,
    /// The least certain fact about it; `None` if it is new and has no open facts.
    state: Option<&'static str>,
    deprecated: bool,
    available: Option<AvailableView>,
}

/// A command code.
#[derive(Debug, Serialize)]
pub(super) struct CodeView {
    /// The spelling of the spec.
    hex: String,
    decimal: Option<u16>,
}

impl CodeView {
    pub(super) fn new(code: &Code) -> Self {
        Self {
            hex: code.spelling.clone(),
            decimal: code.value,
        }
    }
}

/// A dated sentence.
#[derive(Debug, Serialize)]
pub(super) struct HistoryItem {
    pub(super) date: String,
    text: String,
}

/// A TCP port.
#[derive(Debug, Serialize)]
pub(super) struct PortView {
    number: u16,
    role: &'static str,
    text: String,
}
