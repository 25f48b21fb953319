//! Entities, and the messages that contain their ids.

use super::shared::{Desk, list};
use crate::emit::markdown::links::Anchor;
use crate::emit::markdown::rows::Row;
use fc_spec::model::{Direction, Entity, Operation, Side, Type};
use minijinja::{Value, context};
use std::collections::HashMap;

pub(in crate::emit::markdown) fn entities(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let mut messages = messages(desk);
    let view = |entity: &Entity| {
        let [sources, users] = messages.remove(entity.name.as_str()).unwrap_or_default();
        context! {
            anchor => Anchor::of("entity", &entity.name).id(),
            name => &entity.name,
            title => desk.lang.text(&entity.title),
            ty => model.id_type(entity).map(Type::to_string),
            sources,
            users,
            spec => desk.spec(&entity.location),
        }
    };
    context! {
        entities => list(model.entities.iter().map(view)),
    }
}

/// Returns the messages from the robot and those from apps, by the entity whose ids they contain.
fn messages(desk: Desk<'_, '_>) -> HashMap<String, [Vec<Value>; 2]> {
    let mut found: HashMap<String, [Vec<Value>; 2]> = HashMap::new();
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
                list.push(desk.message(operation, direction, fields));
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
