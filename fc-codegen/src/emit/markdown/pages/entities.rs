//! Entities, and the messages that contain their ids.

use super::shared::{Desk, MessageView};
use crate::emit::markdown::links::{Anchor, Link};
use crate::emit::markdown::rows::Row;
use crate::emit::markdown::words;
use fc_spec::model::{Direction, Entity, Operation, Side, Type};
use serde::Serialize;
use std::collections::HashMap;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct EntitiesView {
    entities: Vec<EntityView>,
}

#[derive(Debug, Serialize)]
struct EntityView {
    anchor: String,
    name: String,
    title: String,
    /// The type of its ids.
    ty: Option<String>,
    /// Messages that give an app its ids.
    sources: Vec<MessageView>,
    /// Messages in which an app uses its ids.
    users: Vec<MessageView>,
    spec: Link,
}

pub(in crate::emit::markdown) fn entities(desk: Desk<'_, '_>) -> EntitiesView {
    let model = desk.book.model;
    let mut messages = messages(desk);
    let view = |entity: &Entity| {
        let [sources, users] = messages.remove(entity.name.as_str()).unwrap_or_default();
        EntityView {
            anchor: Anchor::of("entity", &entity.name).id(),
            name: entity.name.clone(),
            title: desk.lang.text(&entity.title).to_owned(),
            ty: model.id_type(entity).map(Type::to_string),
            sources,
            users,
            spec: desk.spec(&entity.location),
        }
    };
    EntitiesView {
        entities: model.entities.iter().map(view).collect(),
    }
}

/// Returns the messages from the robot and those from apps, by the entity whose ids they contain.
fn messages(desk: Desk<'_, '_>) -> HashMap<String, [Vec<MessageView>; 2]> {
    let mut found: HashMap<String, [Vec<MessageView>; 2]> = HashMap::new();
    let model = desk.book.model;
    if model.entities.is_empty() {
        return found;
    }
    for operation in &model.operations {
        for &direction in operation.directions() {
            let Some(body) = operation.body(direction) else {
                continue;
            };
            for (entity, fields) in desk.fields_by(operation, direction, body, Row::entity) {
                let [sources, users] = found.entry(entity).or_default();
                let list = match sender(operation, direction) {
                    Side::Robot => sources,
                    Side::App => users,
                };
                list.push(MessageView {
                    operation: desk.operation(operation),
                    side: words::side(operation.kind(), direction, desk.lang),
                    fields,
                });
            }
        }
    }
    found
}

fn sender(operation: &Operation, direction: Direction) -> Side {
    match (operation.sender, direction) {
        (Side::Robot, Direction::Request) | (Side::App, Direction::Response) => Side::Robot,
        (Side::App, Direction::Request) | (Side::Robot, Direction::Response) => Side::App,
    }
}
