//! Coordinate systems and stores, with the messages and types that use them.

use super::shared::{Desk, MessageView};
use crate::emit::markdown::links::{Anchor, Link, Page};
use crate::emit::markdown::rows::Row;
use crate::emit::markdown::words;
use fc_spec::model::{CoordinateSystem, Direction, Operation, Store, TypeDef, TypeShape};
use serde::Serialize;
use std::collections::HashMap;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct PlacesView {
    systems: Vec<SystemView>,
    stores: Vec<StoreView>,
}

#[derive(Debug, Serialize)]
struct SystemView {
    anchor: String,
    name: String,
    title: String,
    about: Option<String>,
    /// The shared structs in this coordinate system.
    types: Vec<Link>,
    messages: Vec<MessageView>,
    spec: Link,
}

#[derive(Debug, Serialize)]
struct StoreView {
    anchor: String,
    name: String,
    title: String,
    about: Option<String>,
    survives_restart: Option<bool>,
    operations: Vec<Link>,
    tables: Vec<Link>,
    messages: Vec<MessageView>,
    spec: Link,
}

pub(in crate::emit::markdown) fn places(desk: Desk<'_, '_>) -> PlacesView {
    let model = desk.book.model;
    let mut systems = HashMap::new();
    let mut stores = HashMap::new();
    // Building all messages is unnecessary if the spec has no systems and no stores.
    if !model.coordinates.is_empty() {
        systems = messages(desk, Row::system);
    }
    if !model.stores.is_empty() {
        stores = messages(desk, Row::store);
    }
    PlacesView {
        systems: model
            .coordinates
            .iter()
            .map(|it| system(desk, it, systems.remove(&it.name)))
            .collect(),
        stores: model
            .stores
            .iter()
            .map(|it| store(desk, it, stores.remove(&it.name)))
            .collect(),
    }
}

fn system(
    desk: Desk<'_, '_>,
    system: &CoordinateSystem,
    messages: Option<Vec<MessageView>>,
) -> SystemView {
    let is_given = |ty: &&TypeDef| match &ty.shape {
        TypeShape::Struct(shape) => shape.coordinates.as_ref() == Some(&system.name),
        TypeShape::Enum(_) | TypeShape::OneOf(_) => false,
    };
    let types = desk.book.model.types.iter();
    let shared = types.filter(|ty| ty.body_of.is_none()).filter(is_given);
    SystemView {
        anchor: Anchor::of("coordinates", &system.name).id(),
        name: system.name.clone(),
        title: desk.lang.text(&system.title).to_owned(),
        about: system.about.as_ref().map(|about| desk.sentence(about)),
        types: shared
            .map(|ty| Link {
                text: format!("`{}`", ty.name),
                href: desk.page.link(desk.book.place_of_type(ty)),
            })
            .collect(),
        messages: messages.unwrap_or_default(),
        spec: desk.spec(&system.location),
    }
}

fn store(desk: Desk<'_, '_>, store: &Store, messages: Option<Vec<MessageView>>) -> StoreView {
    let model = desk.book.model;
    let is_kept = |kept: &Option<String>| kept.as_ref() == Some(&store.name);
    let operations = model.operations.iter().filter(|it| is_kept(&it.kept));
    let tables = model.tables.iter().filter(|it| is_kept(&it.kept));
    StoreView {
        anchor: Anchor::of("store", &store.name).id(),
        name: store.name.clone(),
        title: desk.lang.text(&store.title).to_owned(),
        about: store.about.as_ref().map(|about| desk.sentence(about)),
        survives_restart: store.survives_restart,
        operations: operations.map(|it| desk.operation(it)).collect(),
        tables: tables
            .map(|table| Link {
                text: desk.lang.text(&table.title).to_owned(),
                href: desk.link(Page::Tables, Anchor::of("table", &table.id)),
            })
            .collect(),
        messages: messages.unwrap_or_default(),
        spec: desk.spec(&store.location),
    }
}

/// Returns the messages with fields for which `key` returns a name, by that name.
fn messages(
    desk: Desk<'_, '_>,
    key: impl Fn(&Row) -> Option<&str>,
) -> HashMap<String, Vec<MessageView>> {
    let mut found: HashMap<String, Vec<MessageView>> = HashMap::new();
    let operations = desk.book.model.operations.iter();
    for (operation, messages) in operations.filter_map(|it| Some((it, it.messages()?))) {
        for &direction in Direction::ALL {
            let body = messages.body(direction);
            for (name, fields) in desk.fields_by(operation, direction, body, &key) {
                let list = found.entry(name).or_default();
                list.push(message(desk, operation, direction, fields));
            }
        }
    }
    found
}

fn message(
    desk: Desk<'_, '_>,
    operation: &Operation,
    direction: Direction,
    fields: Vec<Link>,
) -> MessageView {
    MessageView {
        operation: desk.operation(operation),
        side: words::side(operation.kind(), direction, desk.lang),
        fields,
    }
}
