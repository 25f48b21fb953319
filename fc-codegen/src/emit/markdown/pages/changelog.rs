//! Everything that has a date, newest first.

use super::shared::Desk;
use crate::emit::markdown::book::Book;
use crate::emit::markdown::links::{Anchor, Link, Page};
use fc_spec::model::{Change, Field, Operation, Subject, TypeShape};
use serde::Serialize;
use std::collections::BTreeMap;

/// All that its template shows.
#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct ChangelogView {
    days: Vec<Day>,
    /// Withdrawn at an unknown date.
    undated: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Day {
    date: String,
    entries: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    /// `changed`, `added`, `deprecated`.
    what: &'static str,
    /// `None` for the protocol as a whole.
    about: Option<Link>,
    text: Option<String>,
}

pub(in crate::emit::markdown) fn changelog(desk: Desk<'_, '_>) -> ChangelogView {
    let model = desk.book.model;
    let mut log = Log {
        desk,
        days: BTreeMap::new(),
        undated: Vec::new(),
    };
    log.changes(&model.changes, None);
    for operation in &model.operations {
        log.operation(operation);
    }
    log.types(desk.book);
    let days = log
        .days
        .into_iter()
        .rev()
        .map(|(date, entries)| Day { date, entries });
    ChangelogView {
        days: days.collect(),
        undated: log.undated,
    }
}

struct Log<'b, 'm> {
    desk: Desk<'b, 'm>,
    days: BTreeMap<String, Vec<Entry>>,
    undated: Vec<Entry>,
}

impl<'m> Log<'_, 'm> {
    fn push(&mut self, date: Option<&String>, entry: Entry) {
        match date {
            Some(date) => self.days.entry(date.clone()).or_default().push(entry),
            None => self.undated.push(entry),
        }
    }

    fn changes(&mut self, changes: &[Change], about: Option<&Link>) {
        for change in changes {
            let text = Some(self.desk.sentence(&change.text));
            let entry = Entry {
                what: "changed",
                about: about.cloned(),
                text,
            };
            self.push(Some(&change.date), entry);
        }
    }

    fn operation(&mut self, operation: &'m Operation) {
        let link = Link {
            text: self.desk.lang.text(&operation.title).to_owned(),
            href: self.desk.link(Page::Operation(operation), Anchor::none()),
        };
        if operation.since.is_some() {
            let text = Some(format!("`{}`", operation.code.spelling));
            let entry = Entry {
                what: "added",
                about: Some(link.clone()),
                text,
            };
            self.push(operation.since.as_ref(), entry);
        }
        self.changes(&operation.changes, Some(&link));
        if let Some(deprecated) = &operation.deprecated {
            let text = Some(self.desk.sentence(&deprecated.note));
            let entry = Entry {
                what: "deprecated",
                about: Some(link),
                text,
            };
            self.push(deprecated.since.as_ref(), entry);
        }
    }

    /// Types, their fields and their values.
    fn types(&mut self, book: &Book<'m>) {
        for ty in &book.model.types {
            let href = self.desk.page.link(book.place_of_type(ty));
            let link = |text: String| Link {
                text,
                href: href.clone(),
            };
            let name = self.desk.lang.text(&ty.title);
            let of_type = link(format!("`{}` {name}", ty.name));
            if ty.since.is_some() {
                let entry = Entry {
                    what: "added",
                    about: Some(of_type.clone()),
                    text: None,
                };
                self.push(ty.since.as_ref(), entry);
            }
            self.changes(&ty.changes, Some(&of_type));
            match &ty.shape {
                TypeShape::Struct(shape) => {
                    let dated = |field: &&Field| {
                        field.details().since.is_some() || field.details().deprecated.is_some()
                    };
                    for field in shape.fields.iter().filter(dated) {
                        let owner = ty.name.clone();
                        let subject = Subject::Field {
                            owner,
                            key: field.wire.clone(),
                        };
                        let of_field = link(book.name_of(&subject, self.desk.lang, self.desk.page));
                        if field.details().since.is_some() {
                            let text = Some(self.desk.lang.text(&field.text).to_owned());
                            let entry = Entry {
                                what: "added",
                                about: Some(of_field.clone()),
                                text,
                            };
                            self.push(field.details().since.as_ref(), entry);
                        }
                        if let Some(deprecated) = &field.details().deprecated {
                            let text = Some(self.desk.sentence(&deprecated.note));
                            let entry = Entry {
                                what: "deprecated",
                                about: Some(of_field),
                                text,
                            };
                            self.push(deprecated.since.as_ref(), entry);
                        }
                    }
                }
                TypeShape::Enum(shape) => {
                    for value in shape.values.iter().filter(|value| value.since.is_some()) {
                        let about = link(format!("`{}.{}`", ty.name, value.name));
                        let text = Some(self.desk.lang.text(&value.text).to_owned());
                        let entry = Entry {
                            what: "added",
                            about: Some(about),
                            text,
                        };
                        self.push(value.since.as_ref(), entry);
                    }
                }
                TypeShape::OneOf(_) => {}
            }
        }
    }
}
