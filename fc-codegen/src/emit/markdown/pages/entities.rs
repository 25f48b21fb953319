//! Entities, and the messages that contain their ids.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use crate::emit::markdown::rows::Row;
use fc_spec::model::{Entity, Side, Type};
use minijinja::{Value, context};
use std::collections::HashMap;

pub(in crate::emit::markdown) fn entities(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let mut messages = HashMap::new();
    if !model.entities.is_empty() {
        messages = desk.messages_by(model.operations.iter(), Row::entity);
    }
    let view = |entity: &Entity| {
        let messages = messages.remove(&entity.name).unwrap_or_default();
        let messages = messages.into_iter();
        let (sources, users): (Vec<_>, Vec<_>) = messages.partition(|it| it.0 == Side::Robot);
        context! {
            anchor => Anchor::of("entity", &entity.name).id(),
            name => &entity.name,
            title => desk.lang.text(&entity.title),
            ty => model.id_type(entity).map(Type::to_string),
            sources => list(sources.into_iter().map(|it| it.1)),
            users => list(users.into_iter().map(|it| it.1)),
            spec => desk.spec(&entity.location),
        }
    };
    context! {
        entities => list(model.entities.iter().map(view)),
    }
}
