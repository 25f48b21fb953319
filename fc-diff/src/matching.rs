//! Pairs the operations, types and fields of two models.
//!
//! Operations match by name, otherwise by kind and code. Types match by their place in a message, so that a named type
//! matches the inline object that it replaced. Types outside messages match by name.

use crate::finding::Senders;
use fc_spec::model::{Direction, WireForm};
use fc_spec::model::{
    EnvelopeField, Example, Field, Model, OneOf, Operation, ResultCode, Side, Type, TypeDef,
    TypeId, TypeShape, Value, Variant,
};
use std::collections::{BTreeMap, HashMap, HashSet};

/// An old item and its new version, or an item without a counterpart.
pub(crate) enum Pair<'m, T> {
    Both(&'m T, &'m T),
    Removed(&'m T),
    Added(&'m T),
}

impl<'m, T> Pair<'m, T> {
    /// Returns both versions of an item, or `None` if only one model has it.
    pub(crate) fn both(&self) -> Option<(&'m T, &'m T)> {
        match self {
            Self::Both(old, new) => Some((old, new)),
            Self::Removed(_) | Self::Added(_) => None,
        }
    }
}

/// Pairs the operations.
pub(crate) fn operations<'m>(old: &'m Model, new: &'m Model) -> Vec<Pair<'m, Operation>> {
    let by_name: HashMap<&str, &Operation> = new
        .operations
        .iter()
        .map(|it| (it.name.as_str(), it))
        .collect();
    let old_names: HashSet<&str> = old.operations.iter().map(|it| it.name.as_str()).collect();
    let place = |it: &Operation| it.code.value.map(|code| (it.kind(), code));
    let unmatched = new
        .operations
        .iter()
        .filter(|it| !old_names.contains(it.name.as_str()));
    let mut by_code: HashMap<_, &Operation> =
        unmatched.filter_map(|it| Some((place(it)?, it))).collect();
    let mut renamed = HashSet::new();
    let mut pairs = Vec::new();
    for operation in &old.operations {
        let found = by_name.get(operation.name.as_str()).copied();
        let found = found.or_else(|| by_code.remove(&place(operation)?));
        pairs.push(match found {
            Some(found) => {
                if found.name != operation.name {
                    renamed.insert(found.name.as_str());
                }
                Pair::Both(operation, found)
            }
            None => Pair::Removed(operation),
        });
    }
    let added = new
        .operations
        .iter()
        .filter(|it| !old_names.contains(it.name.as_str()) && !renamed.contains(it.name.as_str()));
    pairs.extend(added.map(Pair::Added));
    pairs
}

/// Pairs the fields of an object: by key, then by a key in `also`, then by name.
pub(crate) fn fields<'m>(old: &'m [Field], new: &'m [Field]) -> Vec<Pair<'m, Field>> {
    let takes = |field: &Field, key: &String| field.details().also.contains(key);
    align(
        old,
        new,
        &[
            &|one, other| one.wire == other.wire,
            &|one, other| takes(other, &one.wire),
            &|one, other| takes(one, &other.wire),
            &|one, other| one.name == other.name,
        ],
    )
}

/// Pairs the variants of a choice by name.
pub(crate) fn variants<'m>(old: &'m OneOf, new: &'m OneOf) -> Vec<Pair<'m, Variant>> {
    align(
        &old.variants,
        &new.variants,
        &[&|one, other| one.name == other.name],
    )
}

/// Pairs the results: by name, then by code.
pub(crate) fn results<'m>(old: &'m Model, new: &'m Model) -> Vec<Pair<'m, ResultCode>> {
    align(
        &old.results,
        &new.results,
        &[&|one, other| one.name == other.name, &|one, other| {
            one.code == other.code
        }],
    )
}

/// Decides by one property whether two items match.
pub(crate) type Same<'s, T> = &'s dyn Fn(&T, &T) -> bool;

/// Pairs items in several passes. Each pass uses one way to match.
pub(crate) fn align<'m, T>(old: &'m [T], new: &'m [T], ways: &[Same<'_, T>]) -> Vec<Pair<'m, T>> {
    let mut taken = vec![false; new.len()];
    let mut found: Vec<Option<&T>> = vec![None; old.len()];
    for same in ways {
        for (one, found) in old.iter().zip(&mut found) {
            if found.is_some() {
                continue;
            }
            let mut others = new.iter().zip(&mut taken);
            if let Some((other, taken)) = others.find(|(other, taken)| !**taken && same(one, other))
            {
                *taken = true;
                *found = Some(other);
            }
        }
    }
    let matched = old.iter().zip(found).map(|(one, other)| match other {
        Some(other) => Pair::Both(one, other),
        None => Pair::Removed(one),
    });
    let added = new.iter().zip(taken).filter(|(_, taken)| !taken);
    matched
        .chain(added.map(|(it, _)| Pair::Added(it)))
        .collect()
}

/// Returns the keys of an envelope as fields of an object.
pub(crate) fn envelope(keys: &[EnvelopeField]) -> Vec<Field> {
    let field = |key: &EnvelopeField| Field {
        wire: key.wire.clone(),
        name: key.name.clone(),
        ty: key.ty.clone(),
        optional: key.optional,
        text: key.text.clone(),
        example: Example::Given(Value::from(&key.example)),
        wire_form: WireForm::Plain,
        sensitive: false,
        details: None,
    };
    keys.iter().map(field).collect()
}

/// A type of the old version and its counterpart.
#[derive(Clone, Copy)]
pub(crate) struct TypePair<'m> {
    pub(crate) old: &'m TypeDef,
    pub(crate) new: &'m TypeDef,
    /// The senders of messages that contain it.
    pub(crate) senders: Senders,
}

/// The types of two models, paired.
pub(crate) struct TypePairs<'m> {
    pub(crate) both: Vec<TypePair<'m>>,
    pub(crate) removed: Vec<&'m TypeDef>,
    pub(crate) added: Vec<&'m TypeDef>,
}

/// Returns the sender of a direction of an operation.
pub(crate) fn sender(operation: &Operation, direction: Direction) -> Side {
    match (direction, operation.sender) {
        (Direction::Request, sender) => sender,
        (Direction::Response, Side::App) => Side::Robot,
        (Direction::Response, Side::Robot) => Side::App,
    }
}

/// Pairs the types.
pub(crate) fn types<'m>(
    old: &'m Model,
    new: &'m Model,
    operations: &[Pair<'m, Operation>],
) -> TypePairs<'m> {
    let mut walk = Walk {
        old: &old.types,
        new: &new.types,
        found: BTreeMap::new(),
        open: Vec::new(),
    };
    let operations = operations.iter().filter_map(Pair::both);
    for (one, other) in operations.filter(|(one, other)| one.kind() == other.kind()) {
        for direction in Direction::ALL {
            if let (Some(old), Some(new)) = (one.body(*direction), other.body(*direction)) {
                walk.meet(
                    old.ty.id(),
                    new.ty.id(),
                    Senders::of(sender(one, *direction)),
                );
            }
        }
    }
    for (one, other) in [
        (&old.envelope.request, &new.envelope.request),
        (&old.envelope.response, &new.envelope.response),
    ] {
        walk.meet_fields(&envelope(one), &envelope(other), Senders::BOTH);
    }
    // Rows of tables are never sent.
    for table in &old.tables {
        if let Some(other) = new.tables.iter().find(|it| it.id == table.id) {
            walk.meet(table.row.id(), other.row.id(), Senders::default());
        }
    }
    walk.run();
    let names = new.types.iter().zip(0..);
    let by_name: HashMap<&str, usize> = names.map(|(ty, at)| (&*ty.name, at)).collect();
    // Types outside messages match by name.
    for (index, ty) in old.types.iter().enumerate() {
        if let Some(other) = by_name.get(ty.name.as_str())
            && !walk.has_met(index)
        {
            walk.meet_at(index, *other, Senders::default());
        }
    }
    walk.run();
    let met_new: HashSet<usize> = walk.found.keys().map(|(_, new)| *new).collect();
    let removed = walk
        .old
        .iter()
        .zip(0..)
        .filter(|(_, at)| !walk.has_met(*at));
    let added = walk
        .new
        .iter()
        .zip(0..)
        .filter(|(_, at)| !met_new.contains(at));
    let both = walk.found.iter().filter_map(|((one, other), senders)| {
        Some(TypePair {
            old: walk.old.get(*one)?,
            new: walk.new.get(*other)?,
            senders: *senders,
        })
    });
    TypePairs {
        both: both.collect(),
        removed: removed.map(|(ty, _)| ty).collect(),
        added: added.map(|(ty, _)| ty).collect(),
    }
}

/// Walks two models in parallel, from message to message.
struct Walk<'m> {
    old: &'m [TypeDef],
    new: &'m [TypeDef],
    found: BTreeMap<(usize, usize), Senders>,
    open: Vec<(usize, usize, Senders)>,
}

impl Walk<'_> {
    fn meet(&mut self, old: TypeId, new: TypeId, senders: Senders) {
        self.meet_at(old.index(), new.index(), senders);
    }

    fn meet_at(&mut self, old: usize, new: usize, senders: Senders) {
        let known = self.found.contains_key(&(old, new));
        let grew = self.found.entry((old, new)).or_default().add(senders);
        if grew || !known {
            self.open.push((old, new, senders));
        }
    }

    /// Returns `true` if the old type with this index has a counterpart.
    fn has_met(&self, old: usize) -> bool {
        self.found
            .range((old, 0)..=(old, usize::MAX))
            .next()
            .is_some()
    }

    fn run(&mut self) {
        while let Some((old, new, senders)) = self.open.pop() {
            let (Some(old), Some(new)) = (self.old.get(old), self.new.get(new)) else {
                continue;
            };
            match (&old.shape, &new.shape) {
                (TypeShape::Struct(old), TypeShape::Struct(new)) => {
                    self.meet_fields(&old.fields, &new.fields, senders);
                }
                (TypeShape::OneOf(old), TypeShape::OneOf(new)) => {
                    for (old, new) in variants(old, new).iter().filter_map(Pair::both) {
                        self.meet(old.ty.id(), new.ty.id(), senders);
                    }
                }
                _ => {}
            }
        }
    }

    fn meet_fields(&mut self, old: &[Field], new: &[Field], senders: Senders) {
        let pairs = fields(old, new);
        let pairs = pairs.iter().filter_map(Pair::both);
        for (one, other) in pairs.filter_map(|(old, new)| named(&old.ty, &new.ty)) {
            self.meet(one, other, senders);
        }
    }
}

/// Returns the named types of two types inside the same number of lists.
pub(crate) fn named(old: &Type, new: &Type) -> Option<(TypeId, TypeId)> {
    match (old, new) {
        (Type::Array(old), Type::Array(new)) => named(old, new),
        (Type::Named(old), Type::Named(new)) => Some((old.id(), new.id())),
        _ => None,
    }
}
