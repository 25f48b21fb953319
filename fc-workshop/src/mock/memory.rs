//! The state of a robot: its processes, stored values, and the commands that it has accepted.

use crate::paths;
use fc_spec::model::{
    Accepted, Direction, Effect, EnumType, Field, Model, Operation, Type, TypeShape, Value,
};
use std::collections::{HashMap, HashSet};

/// The state of a robot.
#[derive(Debug)]
pub(super) struct Memory {
    /// The enums with states: of a process, or of a precondition. A value follows once a report has shown it.
    states: HashMap<String, Option<Value>>,
    /// Values that commands have set. The spec limits their number.
    stored: Vec<Stored>,
    /// Names of the commands that were accepted.
    accepted: HashSet<String>,
}

/// A value that a command has set.
#[derive(Debug)]
struct Stored {
    key: StoredKey,
    value: Value,
}

/// The store, wire key and type of a field that is kept.
#[derive(Debug, PartialEq)]
struct StoredKey {
    store: String,
    wire: String,
    ty: Type,
}

impl Memory {
    /// Returns the state of a robot that has just started.
    pub(super) fn new(model: &Model) -> Self {
        let is_process = |shape: &TypeShape| shape.enumeration().is_some_and(EnumType::is_process);
        let processes = model.types.iter().filter(|ty| is_process(&ty.shape));
        let accepted = model.operations.iter().filter_map(Operation::accepted);
        let accepted = accepted.flat_map(Accepted::state_sets);
        let accepted = accepted.map(|set| model.types.get(&set.ty));
        let states = processes.chain(accepted);
        Self {
            states: states.map(|ty| (ty.name.clone(), None)).collect(),
            stored: Vec::new(),
            accepted: HashSet::new(),
        }
    }

    /// Returns the precondition that refuses a command now, in words, or `None`. A state that no report has shown refuses
    /// nothing.
    pub(super) fn objection(&self, model: &Model, command: &Operation) -> Option<String> {
        let accepted = command.accepted()?;
        let mut before = accepted.after.iter();
        if let Some(missing) = before.find(|name| !self.accepted.contains(*name)) {
            return Some(format!("send {missing} first"));
        }
        accepted.state_sets().iter().find_map(|set| {
            let name = &model.types.get(&set.ty).name;
            let now = self.states.get(name)?.as_ref()?;
            let is_accepted = set.values.iter().any(|value| Value::from(value) == *now);
            (!is_accepted).then(|| format!("not accepted while {name} is {now}"))
        })
    }

    /// Notes that a command was accepted, and keeps the values that it sets.
    pub(super) fn accept(&mut self, model: &Model, command: &Operation, request: &Value) {
        self.accepted.insert(command.name.clone());
        let is_change = command
            .effect()
            .is_some_and(|effect| effect != Effect::Read);
        let Some(body) = command.body(Direction::Request).filter(|_| is_change) else {
            return;
        };
        let mut request = request.clone();
        let shape = model.types.structure(&body.ty);
        paths::visit(model, shape, &mut request, &mut |field, value| {
            let Some(key) = stored_key(model, command, field) else {
                return;
            };
            let value = value.clone();
            let mut stored = self.stored.iter_mut();
            match stored.find(|stored| stored.key == key) {
                Some(stored) => stored.value = value,
                None => self.stored.push(Stored { key, value }),
            }
        });
    }

    /// Notes the states in a report.
    pub(super) fn observe(&mut self, model: &Model, report: &Operation, message: &Value) {
        let Some(body) = report.body(Direction::Request) else {
            return;
        };
        let shape = model.types.structure(&body.ty);
        paths::visit(model, shape, &mut message.clone(), &mut |field, value| {
            if let Type::Named(named) = &field.ty
                && let Some(state) = self.states.get_mut(&model.types.get(named).name)
            {
                *state = Some(value.clone());
            }
        });
    }

    /// Puts states and stored values into a message.
    pub(super) fn fill(
        &self,
        model: &Model,
        operation: &Operation,
        direction: Direction,
        message: &mut Value,
    ) {
        let Some(body) = operation.body(direction) else {
            return;
        };
        let shape = model.types.structure(&body.ty);
        paths::visit(model, shape, message, &mut |field, value| {
            let state = match &field.ty {
                Type::Named(named) => self.states.get(&model.types.get(named).name),
                _ => None,
            };
            let stored = || {
                let key = stored_key(model, operation, field)?;
                let mut stored = self.stored.iter();
                stored.find(|stored| stored.key == key).map(|it| &it.value)
            };
            let state = state.and_then(Option::as_ref);
            if let Some(known) = state.or_else(stored) {
                value.clone_from(known);
            }
        });
    }
}

/// Returns the key of a field that is kept, or `None` for another field. The fields of an object are kept separately.
fn stored_key(model: &Model, operation: &Operation, field: &Field) -> Option<StoredKey> {
    if let Type::Named(named) = &field.ty
        && !matches!(model.types.get(named).shape, TypeShape::Enum(_))
    {
        return None;
    }
    let store = field.details().kept.as_ref().or(operation.kept.as_ref())?;
    Some(StoredKey {
        store: store.clone(),
        wire: field.wire.clone(),
        ty: field.ty.clone(),
    })
}
