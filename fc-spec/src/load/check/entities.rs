//! Entities, and the fields that refer to them.

use super::each::fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::FIELD;
use crate::load::draft::Draft;
use crate::model::{Type, TypeShape};
use crate::names;
use crate::source::Span;
use crate::text;
use std::collections::{HashMap, HashSet};

/// `refers` stands on what can be an id: integers, strings and lists of them.
pub(super) fn check_ids(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if field.details().refers.is_none() || is_id(field.ty.item()) {
            continue;
        }
        // That a type is unknown is reported; what it is good for is no question.
        let named = field.ty.innermost();
        if named.is_some_and(|named| draft.type_named(named.name()).is_none()) {
            continue;
        }
        let message = text!(
            "`{refers}` 应用于整数、字符串或它们的列表，而 `{field}` 不是",
            "`{refers}` needs an integer, a string or a list of them, but `{field}` is not one",
            refers = FIELD.refers.name,
            field = field.wire
        );
        let span = part.place.at(FIELD.refers);
        let fault = Diagnostic::error(FaultCode::RefersOnWrongType, span, message);
        faults.push(fault.also(part.ty, text!("类型", "the type")));
    }
}

/// The ids of an entity have one type: what comes from one message can be sent in another. How a field sends it is its
/// own affair.
pub(super) fn check_types(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, (&Type, Span)> = HashMap::new();
    for (_, field, part) in fields(draft) {
        let ty = field.ty.item();
        let Some(entity) = field.details().refers.as_deref().filter(|_| is_id(ty)) else {
            continue;
        };
        let (known, span) = *first.entry(entity).or_insert((ty, part.ty));
        if known != ty {
            let message = text!(
                "`{entity}` 的 ID 应为 `{known}`，与别处相同",
                "expected `{known}`, the type of the other ids of `{entity}`"
            );
            let fault = Diagnostic::error(FaultCode::IdTypes, part.ty, message);
            faults.push(fault.also(span, text!("首次出现在这里", "first used here")));
        }
    }
}

/// What a field refers to is declared.
pub(super) fn check_declared(draft: &Draft<'_>, faults: &mut Faults) {
    let declared = declared(draft);
    for (_, field, part) in fields(draft) {
        let refers = field.details().refers.as_deref();
        // What is no name has been reported.
        let name = refers.filter(|name| names::is_snake(name));
        let Some(name) = name.filter(|name| !declared.contains(name)) else {
            continue;
        };
        let span = part.place.at(FIELD.refers);
        let message = text!("没有实体 `{name}`", "there is no entity `{name}`");
        let fault = Diagnostic::error(FaultCode::UnknownEntity, span, message);
        faults.push(match nearest(name, declared.iter().copied()) {
            Some(near) => fault.fix(
                span,
                near,
                text!("是否想写 `{near}`？", "did you mean `{near}`?"),
            ),
            None => fault.note(text!(
                "在 `entities:` 下声明",
                "declare it under `entities:`"
            )),
        });
    }
}

/// Every entity has a field that refers to it. The entity that a slip stands for is not reported a second time.
pub(super) fn check_unused(draft: &Draft<'_>, faults: &mut Faults) {
    let declared = declared(draft);
    let mut used: HashSet<&str> = HashSet::new();
    for ty in &draft.types {
        if let TypeShape::Struct(shape) = &ty.def.shape {
            let fields = shape.fields.iter();
            used.extend(fields.filter_map(|field| field.details().refers.as_deref()));
        }
    }
    let slips: Vec<&str> = used.difference(&declared).copied().collect();
    for slip in slips {
        used.extend(nearest(slip, declared.iter().copied()));
    }
    for entity in &draft.entities {
        let name = entity.item.name.as_str();
        if !used.contains(name) {
            let message = text!(
                "没有字段指向实体 `{name}`",
                "no field refers to the entity `{name}`"
            );
            let span = entity.place.name();
            let fault = Diagnostic::error(FaultCode::UnusedEntity, span, message);
            faults.push(fault.note(text!(
                "在存放它的 ID 的字段上写 `refers`，或将它删除",
                "write `refers` on a field that holds its IDs, or delete it"
            )));
        }
    }
}

/// Names of the entities.
fn declared<'d>(draft: &'d Draft<'_>) -> HashSet<&'d str> {
    let entities = draft.entities.iter();
    entities.map(|entity| entity.item.name.as_str()).collect()
}

fn is_id(ty: &Type) -> bool {
    matches!(ty, Type::Int(_) | Type::String)
}
