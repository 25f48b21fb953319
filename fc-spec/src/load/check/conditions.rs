//! Checks fields that are present, or valid, only for certain values of other fields of the object.

use super::fields::is_enum;
use super::iter::fields;
use super::value::check_field;
use super::value_list::ValueList;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::FIELD;
use crate::language::scalar;
use crate::load::draft::{Draft, Part};
use crate::model::{Field, Text, Type, TypeShape};
use crate::syntax::{Entry, Node};
use crate::text;

/// Checks that a field has at most one condition.
pub(super) fn check_one(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if field.details().condition.is_none() {
            continue;
        }
        let node = part.origin.node;
        if let (Some(when), Some(unless)) = (FIELD.when.entry(node), FIELD.unless.entry(node)) {
            let message = text!(
                "`{field}` 同时有 `when` 和 `unless`",
                "`{field}` has both `when` and `unless`",
                field = field.wire
            );
            let span = unless.key.span();
            let fault = Diagnostic::error(FaultCode::WhenAndUnless, span, message);
            faults.push(fault.also(when.key.span(), text!("另一个条件", "the other condition")));
        }
    }
}

/// Checks that a condition refers to another field of the same object. That field must be required, and its values must
/// be comparable.
pub(super) fn check_fields(draft: &Draft<'_>, faults: &mut Faults) {
    for question in questions(draft) {
        let Question { own, entry, .. } = question;
        let (key, span) = (entry.name(), entry.key.span());
        let fault = |code, message: Text| Diagnostic::error(code, span, message);
        let Some((asked, part)) = question.asked else {
            let message = text!(
                "对象中没有字段 `{key}`，`{own}` 却以它为条件",
                "`{own}` depends on `{key}`, which is not a field of the same object",
                own = own.wire
            );
            let unknown = fault(FaultCode::UnknownSibling, message);
            let others = question.beside.iter().map(|field| field.wire.as_str());
            let note = text!(
                "写同一个对象中的字段；公共字段不能用",
                "name a field of the same object; keys of the envelope cannot be used"
            );
            faults.push(unknown.suggest(nearest(key, others), Some(note)));
            continue;
        };
        if asked.wire == own.wire {
            let message = text!(
                "`{key}` 不能以自己为条件",
                "`{key}` cannot depend on itself"
            );
            faults.push(fault(FaultCode::OwnCondition, message));
        } else if asked.optional {
            let message = text!(
                "`{key}` 是可选的，不能作为条件",
                "`{key}` is optional, so a condition cannot depend on it"
            );
            let fault = fault(FaultCode::ConditionOnOptional, message);
            faults.push(fault.also(part.ty, text!("可选字段", "an optional field")));
        } else if !has_single_values(draft, &asked.ty) {
            let message = text!(
                "条件应为枚举、整数、文本或布尔值，而 `{key}` 不是",
                "a condition needs an enum, integer, text or bool, but `{key}` is not one"
            );
            let fault = fault(FaultCode::ConditionOnWrongType, message);
            faults.push(fault.also_type(part.ty));
        }
    }
}

/// Checks that a condition lists valid values of the field it depends on, each once.
pub(super) fn check_values(draft: &Draft<'_>, faults: &mut Faults) {
    for question in questions(draft) {
        let Some((asked, part)) = question.asked else {
            continue;
        };
        // An unusable field has its own error.
        if asked.wire == question.own.wire || !has_single_values(draft, &asked.ty) {
            continue;
        }
        let list = ValueList {
            wrong: FaultCode::ConditionValue,
            ty: Some((
                part.ty,
                text!(
                    "作为条件的字段的类型",
                    "the type of the field in the condition"
                ),
            )),
            repeated: FaultCode::ConditionTwice,
            message: text!(
                "这个值在条件中出现两次",
                "this value occurs twice in the condition"
            ),
        };
        list.check(
            scalar::each_value(question.entry.value),
            |node| check_field(draft, asked, node),
            faults,
        );
    }
}

/// One entry of a condition: a field and its values.
struct Question<'d, 'a> {
    /// The field that has the condition.
    own: &'d Field,
    /// Every field of the object, including `own`.
    beside: &'d [Field],
    /// The key and the values.
    entry: Entry<'a>,
    /// The field that the condition depends on, if it exists.
    asked: Option<(&'d Field, Part<'a>)>,
}

/// Returns the entries of all conditions, except those about malformed fields.
fn questions<'d, 'a>(draft: &'d Draft<'a>) -> Vec<Question<'d, 'a>> {
    let mut questions = Vec::new();
    for (ty, own, part) in fields(draft) {
        let TypeShape::Struct(shape) = &ty.def.shape else {
            continue;
        };
        if own.details().condition.is_none() {
            continue;
        }
        let node = part.origin.node;
        for condition in [FIELD.when, FIELD.unless] {
            for entry in condition.of(node).into_iter().flat_map(Node::entries) {
                let mut beside = ty.fields();
                let asked = beside.find(|(field, _)| field.wire == entry.name());
                if asked.is_none_or(|(_, part)| !part.broken) {
                    questions.push(Question {
                        own,
                        beside: &shape.fields,
                        entry,
                        asked,
                    });
                }
            }
        }
    }
    questions
}

/// Returns `true` if values of the type are single words, numbers or booleans. Also `true` for an unknown type, which
/// has its own error.
fn has_single_values(draft: &Draft<'_>, ty: &Type) -> bool {
    match ty {
        Type::Bool | Type::Int(_) | Type::String => true,
        Type::Named(named) => !draft.knows(named.name()) || is_enum(draft, ty),
        _ => false,
    }
}
