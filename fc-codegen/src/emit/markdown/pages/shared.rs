//! Views that several pages share.

pub(super) use crate::emit::markdown::desk::Desk;
use crate::emit::markdown::links::{Anchor, Link, Page};
use crate::emit::markdown::rows::Row;
use crate::emit::markdown::words::{self, Word as _};
use fc_spec::model::{
    Answer, Body, BodyState, Change, Code, Direction, Operation, Port, Side, Subject,
};
use minijinja::{Value, context};
use std::collections::HashMap;

impl<'m> Desk<'_, 'm> {
    /// Returns the messages with fields for which `key` returns a name, by that name. Each message has its sender.
    pub(super) fn messages_by(
        self,
        operations: impl Iterator<Item = &'m Operation>,
        key: impl Fn(&Row) -> Option<&str>,
    ) -> HashMap<String, Vec<(Side, Value)>> {
        let mut found: HashMap<String, Vec<(Side, Value)>> = HashMap::new();
        for operation in operations {
            for &direction in operation.directions() {
                let Some(body) = operation.body(direction) else {
                    continue;
                };
                for (name, fields) in self.fields_by(operation, direction, body, &key) {
                    let message = context! {
                        operation => self.operation(operation),
                        side => words::side(operation.kind(), direction, self.lang),
                        fields => list(fields),
                    };
                    let messages = found.entry(name).or_default();
                    messages.push((sender(operation, direction), message));
                }
            }
        }
        found
    }

    /// Returns the fields of a message for which `key` returns a name, by that name.
    fn fields_by(
        self,
        operation: &Operation,
        direction: Direction,
        body: &Body,
        key: impl Fn(&Row) -> Option<&str>,
    ) -> HashMap<String, Vec<Link>> {
        let mut fields: HashMap<String, Vec<Link>> = HashMap::new();
        for row in self.message_rows(direction, &body.ty) {
            if let Some(name) = key(&row) {
                let place = (Page::Operation(operation), Anchor::named(row.anchor()));
                let link = self.to(format!("`{}`", row.path()), place);
                fields.entry(name.to_owned()).or_default().push(link);
            }
        }
        fields
    }

    /// Returns an answer, without the link to the conflict `except`, which the page already shows.
    pub(super) fn answer(self, answer: &'m Answer, except: Option<&str>) -> Value {
        let ids = answer.ids.iter().map(|id| self.conflict(id));
        let ids = ids.filter(|link| except.is_none_or(|except| link.text != except));
        let confirmed = answer.confirmed.as_ref();
        context! {
            ids => list(ids),
            kind => answer.kind.word(self.lang),
            text => self.sentence(&answer.text),
            about => self.about(&answer.subject),
            runtime => answer.runtime,
            confirmed => confirmed.map(|it| words::confirmed(it, self.lang)),
            spec => self.spec(&answer.location),
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
        (!own).then(|| {
            let name = self.book.name_of(subject, self.lang, self.page);
            self.to(name, self.book.place_of(subject))
        })
    }

    pub(super) fn answers(self, answers: impl IntoIterator<Item = &'m Answer>) -> Vec<Value> {
        let answers = answers.into_iter();
        answers.map(|answer| self.answer(answer, None)).collect()
    }

    /// Returns the answers to exactly this subject.
    pub(super) fn answers_to(self, subject: &Subject) -> Vec<Value> {
        self.answers(self.book.answers_to(subject).iter().copied())
    }

    /// Returns changes in their order.
    pub(super) fn history<'c>(self, changes: impl IntoIterator<Item = &'c Change>) -> Vec<Value> {
        let item = |change: &Change| context! { date => &change.date, text => self.sentence(&change.text) };
        changes.into_iter().map(item).collect()
    }

    pub(super) fn ports(self) -> Vec<Value> {
        let view = |port: &Port| {
            context! {
                number => port.number,
                role => port.role.word(self.lang),
                text => self.lang.text(&port.text),
            }
        };
        let ports = self.book.model.transport.ports.each().into_iter();
        ports.map(view).collect()
    }

    /// Returns an entry for a list of operations.
    pub(super) fn entry(self, operation: &Operation) -> Value {
        let protocol = &self.book.model.protocol;
        let robot = self.lang.text(&protocol.robot.title);
        let app = self.lang.text(&protocol.app.title);
        let state = operation.state();
        let available = self.available(operation.available.as_ref());
        let is_shown = operation.is_from_source() || state != BodyState::Stated;
        context! {
            link => self.operation(operation),
            name => &operation.name,
            code => code(&operation.code),
            kind => operation.kind().word(self.lang),
            effect => operation.effect().map(|effect| effect.word(self.lang)),
            direction => words::direction(operation.sender, robot, app),
            state => is_shown.then(|| state.word(self.lang)),
            deprecated => operation.deprecated.is_some(),
            available,
        }
    }
}

fn sender(operation: &Operation, direction: Direction) -> Side {
    match (operation.sender, direction) {
        (Side::Robot, Direction::Request) | (Side::App, Direction::Response) => Side::Robot,
        (Side::App, Direction::Request) | (Side::Robot, Direction::Response) => Side::App,
    }
}

/// Returns a list for a template.
pub(super) fn list<T: Into<Value>>(items: impl IntoIterator<Item = T>) -> Value {
    items.into_iter().map(Into::into).collect()
}

/// Returns a command code, with the spelling of the spec.
pub(super) fn code(code: &Code) -> Value {
    context! { hex => &code.spelling, decimal => code.value }
}
