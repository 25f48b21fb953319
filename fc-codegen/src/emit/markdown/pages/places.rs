//! Coordinate systems and stores, with the messages and types that use them.

use super::shared::{Desk, list};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::rows::Row;
use fc_spec::model::{CoordinateSystem, Kind, Side, Store, TypeDef, TypeShape};
use minijinja::{Value, context};
use std::collections::HashMap;

pub(in crate::emit::markdown) fn places(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let operations = || {
        model
            .operations
            .iter()
            .filter(|it| it.kind() != Kind::Stream)
    };
    let mut systems = HashMap::new();
    let mut stores = HashMap::new();
    // Building all messages is unnecessary if the spec has no systems and no stores.
    if !model.coordinates.is_empty() {
        systems = desk.messages_by(operations(), Row::system);
    }
    if !model.stores.is_empty() {
        stores = desk.messages_by(operations(), Row::store);
    }
    let of_spec = model.coordinates.iter();
    let systems = of_spec.map(|it| system(desk, it, systems.remove(&it.name)));
    let of_spec = model.stores.iter();
    let stores = of_spec.map(|it| store(desk, it, stores.remove(&it.name)));
    context! {
        systems => list(systems),
        stores => list(stores),
    }
}

type Messages = Vec<(Side, Value)>;

fn system(desk: Desk<'_, '_>, system: &CoordinateSystem, messages: Option<Messages>) -> Value {
    let is_given = |ty: &&TypeDef| match &ty.shape {
        TypeShape::Struct(shape) => shape.coordinates.as_ref() == Some(&system.name),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => false,
    };
    let types = desk.book.model.types.iter();
    let shared = types.filter(|ty| ty.body_of.is_none()).filter(is_given);
    context! {
        anchor => Anchor::of("coordinates", &system.name).id(),
        name => &system.name,
        title => desk.lang.text(&system.title),
        about => system.about.as_ref().map(|about| desk.sentence(about)),
        types => list(shared.map(|ty| desk.to(format!("`{}`", ty.name), desk.book.place_of_type(ty)))),
        messages => list(messages.into_iter().flatten().map(|it| it.1)),
        spec => desk.spec(&system.location),
    }
}

fn store(desk: Desk<'_, '_>, store: &Store, messages: Option<Messages>) -> Value {
    let model = desk.book.model;
    let is_kept = |kept: &Option<String>| kept.as_ref() == Some(&store.name);
    let operations = model.operations.iter().filter(|it| is_kept(&it.kept));
    let tables = model.tables.iter().filter(|it| is_kept(&it.kept));
    context! {
        anchor => Anchor::of("store", &store.name).id(),
        name => &store.name,
        title => desk.lang.text(&store.title),
        about => store.about.as_ref().map(|about| desk.sentence(about)),
        survives_restart => store.survives_restart,
        operations => list(operations.map(|it| desk.operation(it))),
        tables => list(tables.map(|table| {
                let place = (Page::Tables, Anchor::of("table", &table.id));
                desk.to(desk.lang.text(&table.title), place)
            })),
        messages => list(messages.into_iter().flatten().map(|it| it.1)),
        spec => desk.spec(&store.location),
    }
}
