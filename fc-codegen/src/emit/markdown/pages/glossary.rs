//! The terms of the protocol, their meanings and their uses.

use super::shared::{Desk, list};
use crate::emit::markdown::links::{Anchor, Link, Page};
use fc_spec::model::Lang;
use fc_spec::model::{Operation, Term, Text, TypeDef, TypeShape};
use minijinja::{Value, context};
use std::collections::HashMap;

pub(in crate::emit::markdown) fn glossary(desk: Desk<'_, '_>) -> Value {
    let lang = desk.lang;
    let mut terms: Vec<&Term> = desk.book.model.glossary.iter().collect();
    // Chinese terms keep the spec's order, which is by subject.
    if lang == Lang::En {
        terms.sort_by_key(|term| term.word.en.to_lowercase());
    }
    let mut uses = uses(desk);
    let view = |term: &Term| {
        context! {
            anchor => Anchor::of("term", &term.id).id(),
            word => lang.text(&term.word),
            other => lang.pick(&term.word.en, &term.word.zh).clone(),
            also => lang.aliases(&term.also),
            means => (desk.book.terms(lang)).linked(desk.page, &desk.sentence(&term.means), term),
            uses => list(uses.remove(term.id.as_str()).unwrap_or_default()),
            spec => desk.spec(&term.location),
        }
    };
    context! {
        terms => list(terms.into_iter().map(view)),
    }
}

/// Returns the places where texts of operations and shared types contain a term, by the term's id.
fn uses<'m>(desk: Desk<'_, 'm>) -> HashMap<&'m str, Vec<Link>> {
    let book = desk.book;
    let operations = book.model.operations.iter().map(|operation| {
        let bodies = book.body_types(operation).iter();
        let mut texts = of_operation(operation);
        texts.extend(bodies.flat_map(|ty| of_type(ty)));
        (desk.operation(operation), texts)
    });
    let shared = book.model.types.iter().filter(|ty| ty.body_of.is_none());
    let shared = shared.map(|ty| {
        let place = (Page::Types, Anchor::of("type", &ty.name));
        let link = desk.to(format!("`{}`", ty.name), place);
        let mut texts = of_type(ty);
        texts.push(&ty.title);
        (link, texts)
    });
    let mut uses: HashMap<&str, Vec<Link>> = HashMap::new();
    for (link, texts) in operations.chain(shared) {
        let texts: Vec<&str> = texts.into_iter().map(|text| desk.lang.text(text)).collect();
        for term in book.terms(desk.lang).in_text(&texts.join("\n")) {
            uses.entry(&term.id).or_default().push(link.clone());
        }
    }
    uses
}

/// Returns the texts of an operation.
fn of_operation(operation: &Operation) -> Vec<&Text> {
    let bodies = operation.bodies();
    std::iter::once(&operation.title)
        .chain(&operation.about)
        .chain(operation.deprecated.as_ref().map(|it| &it.note))
        .chain(bodies.filter_map(|body| body.note.as_ref()))
        .collect()
}

/// Returns the texts of a type and its parts, without its title. A type made for a body has the title of its operation.
fn of_type(ty: &TypeDef) -> Vec<&Text> {
    let mut texts: Vec<&Text> = ty.about.iter().collect();
    match &ty.shape {
        TypeShape::Struct(shape) => {
            for field in &shape.fields {
                let details = field.details();
                texts.push(&field.text);
                texts.extend(&details.note);
                texts.extend(details.deprecated.as_ref().map(|it| &it.note));
            }
        }
        TypeShape::Enum(shape) => texts.extend(shape.values.iter().map(|value| &value.text)),
        TypeShape::OneOf(choice) => {
            texts.extend(choice.variants.iter().map(|variant| &variant.text));
        }
    }
    texts
}
