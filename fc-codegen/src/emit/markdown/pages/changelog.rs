//! All dated entries, newest first.

use super::shared::{Desk, list};
use crate::emit::markdown::book::Book;
use crate::emit::markdown::links::Link;
use fc_spec::model::{Change, Deprecation, Operation, Subject, TypeShape};
use minijinja::{Value, context};
use std::collections::BTreeMap;

pub(in crate::emit::markdown) fn changelog(desk: Desk<'_, '_>) -> Value {
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
    let mut years: Vec<(String, Vec<Value>)> = Vec::new();
    for (date, entries) in log.days.into_iter().rev() {
        let name = date.split('-').next().unwrap_or_default().to_owned();
        if years.last().is_none_or(|(year, _)| *year != name) {
            years.push((name, Vec::new()));
        }
        if let Some((_, days)) = years.last_mut() {
            days.push(context! { date, entries });
        }
    }
    let years = years.into_iter();
    context! {
        years => list(years.map(|(name, days)| context! { name, days })),
        // They are all deprecations.
        undated => log.undated,
    }
}

struct Log<'b, 'm> {
    desk: Desk<'b, 'm>,
    days: BTreeMap<String, Vec<Value>>,
    undated: Vec<Value>,
}

impl<'m> Log<'_, 'm> {
    fn push(&mut self, date: Option<&String>, entry: Value) {
        match date {
            Some(date) => self.days.entry(date.clone()).or_default().push(entry),
            None => self.undated.push(entry),
        }
    }

    fn changes(&mut self, changes: &[Change], about: Option<&Link>) {
        for change in changes {
            let text = Some(self.desk.sentence(&change.text));
            let entry = context! { what => "changed", about => about.cloned(), text };
            self.push(Some(&change.date), entry);
        }
    }

    /// Adds an entry for a new item. Items from the start of the protocol get none.
    fn added(&mut self, since: Option<&String>, about: &Link, text: Option<String>) {
        if since.is_some() {
            let entry = context! { what => "added", about => about.clone(), text };
            self.push(since, entry);
        }
    }

    fn deprecated(&mut self, deprecated: Option<&Deprecation>, about: &Link) {
        if let Some(deprecated) = deprecated {
            let text = self.desk.sentence(&deprecated.note);
            let entry = context! { what => "deprecated", about => about.clone(), text };
            self.push(deprecated.since.as_ref(), entry);
        }
    }

    fn operation(&mut self, operation: &'m Operation) {
        let link = self.desk.operation(operation);
        let code = format!("`{}`", operation.code.spelling);
        self.added(operation.since.as_ref(), &link, Some(code));
        self.changes(&operation.changes, Some(&link));
        self.deprecated(operation.deprecated.as_ref(), &link);
    }

    /// Adds the entries of types, their fields and their values.
    fn types(&mut self, book: &Book<'m>) {
        let lang = self.desk.lang;
        for ty in &book.model.types {
            let href = self.desk.page.link(book.place_of_type(ty));
            let link = |text: String| Link {
                text,
                href: href.clone(),
            };
            let of_type = link(format!("`{}` {}", ty.name, lang.text(&ty.title)));
            self.added(ty.since.as_ref(), &of_type, None);
            self.changes(&ty.changes, Some(&of_type));
            match &ty.shape {
                TypeShape::Struct(shape) => {
                    for field in &shape.fields {
                        let details = field.details();
                        // Most fields have no date, so the name is not computed for them.
                        if details.since.is_none() && details.deprecated.is_none() {
                            continue;
                        }
                        let subject = Subject::Field {
                            owner: ty.name.clone(),
                            key: field.wire.clone(),
                        };
                        let of_field = link(book.name_of(&subject, lang, self.desk.page));
                        let text = lang.text(&field.text).to_owned();
                        self.added(details.since.as_ref(), &of_field, Some(text));
                        self.deprecated(details.deprecated.as_ref(), &of_field);
                    }
                }
                TypeShape::Enum(shape) => {
                    for value in &shape.values {
                        let about = link(format!("`{}.{}`", ty.name, value.name));
                        let text = lang.text(&value.text).to_owned();
                        self.added(value.since.as_ref(), &about, Some(text));
                    }
                }
                TypeShape::OneOf(_) => {}
            }
        }
    }
}
