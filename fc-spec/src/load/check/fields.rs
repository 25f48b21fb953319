//! Checks the keys of fields.

use super::iter::{fields, typed_fields};
use super::value::{check_constraints, check_type};
use super::value_list::ValueList;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{FIELD, TEXT};
use crate::load::draft::Draft;
use crate::load::lower::USUAL_OBJECT;
use crate::model::{
    BodyState, Example, Field, Lang, Number, Pattern, PatternError, Quirk, Scalar, Text, Type,
    TypeShape, Value, WireForm,
};
use crate::text;

/// Checks that a field in the short form has a named type, whose title describes the field.
pub(super) fn check_short_forms(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if part.borrows_text && !matches!(field.ty, Type::Named(_)) {
            let message = text!(
                "`{field}` 没有说明",
                "`{field}` has no description",
                field = field.wire
            );
            let note = text!(
                "写成 `{{ type: …, zh: …, en: … }}`；简写只用于命名类型，以类型的标题说明字段",
                "write `{{ type: …, zh: …, en: … }}`; the short form is for named types, whose title describes the field"
            );
            let fault = Diagnostic::error(FaultCode::ShortForm, part.ty, message);
            faults.push(fault.note(note));
        }
    }
}

/// Checks that an inline object has a description, unless it is the usual `data`.
pub(super) fn check_texts(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        let node = part.origin.node;
        let is_inline = node.as_mapping().is_some() && FIELD.r#type.of(node).is_none();
        if !is_inline {
            continue;
        }
        let span = part.origin.name();
        let [has_zh, has_en] = [TEXT.zh, TEXT.en].map(|key| key.of(node).is_some());
        if field.wire == USUAL_OBJECT && !has_zh && !has_en {
            continue;
        }
        let lacks_zh = !has_zh && draft.texts.require(Lang::Zh, has_en);
        let lacks_en = !has_en && draft.texts.require(Lang::En, has_zh);
        let message = match (lacks_zh, lacks_en) {
            (true, true) => text!(
                "这个内嵌对象既没有中文，也没有英文",
                "this inline object has neither a Chinese nor an English text"
            ),
            (true, false) => text!(
                "这个内嵌对象缺少中文 `zh`",
                "the Chinese text `zh` of this inline object is missing"
            ),
            (false, true) => text!(
                "这个内嵌对象缺少英文 `en`",
                "the English text `en` of this inline object is missing"
            ),
            (false, false) => continue,
        };
        let fault = Diagnostic::error(FaultCode::MissingTranslation, span, message);
        faults.push(fault.note(text!(
            "写成 `{{ fields: {{ … }}, zh: …, en: … }}`",
            "write `{{ fields: {{ … }}, zh: …, en: … }}`"
        )));
    }
}

/// Checks that `min` and `max` belong to numbers, fit into the type, and are in order.
pub(super) fn check_bounds(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        for (key, bound) in [
            (FIELD.min, field.details().constraints.min.as_ref()),
            (FIELD.max, field.details().constraints.max.as_ref()),
        ] {
            let Some(bound) = bound else {
                continue;
            };
            let span = part.origin.at(key);
            match field.ty {
                Type::Int(kind) => {
                    let (least, most) = kind.range();
                    let fits =
                        matches!(bound, Number::Int(value) if (least..=most).contains(value));
                    if !fits {
                        let message = text!(
                            "这不是 {kind} 的值",
                            "this is not a value of {kind}",
                            kind = kind.name()
                        );
                        let fault = Diagnostic::error(FaultCode::BoundsBeyondType, span, message);
                        faults.push(fault.also_type(part.ty));
                    }
                }
                Type::Float(_) => {}
                _ => {
                    let message = misfit(key.name, field, &text!("数值", "a number"));
                    let fault = Diagnostic::error(FaultCode::BoundsOnWrongType, span, message);
                    faults.push(fault.also_type(part.ty));
                }
            }
        }
        if field.details().constraints.is_inverted() {
            let message = text!("`min` 大于 `max`", "`min` is larger than `max`");
            let span = part.origin.at(FIELD.min);
            let fault = Diagnostic::error(FaultCode::MinAboveMax, span, message);
            faults.push(fault.also(part.origin.at(FIELD.max), text!("最大值", "the largest")));
        }
    }
}

/// Returns the message about a key that does not apply to the type of the field.
pub(super) fn misfit(key: &str, field: &Field, expected: &Text) -> Text {
    text!(
        "`{key}` 应用于{expected}，而 `{field}` 不是",
        "`{key}` needs {expected}, but `{field}` is not one",
        field = field.wire,
        expected = expected
    )
}

/// Checks that `length` belongs to strings, bytes and lists, and is in order.
pub(super) fn check_lengths(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some((least, most)) = field.details().constraints.length else {
            continue;
        };
        let span = part.origin.at(FIELD.length);
        if !matches!(field.ty, Type::String | Type::Base64 | Type::Array(_)) {
            let expected = text!("字符串、base64 或列表", "a string, base64 or list");
            let message = misfit(FIELD.length.name, field, &expected);
            let fault = Diagnostic::error(FaultCode::LengthOnWrongType, span, message);
            faults.push(fault.also_type(part.ty));
        }
        if least > most {
            let message = text!(
                "最小长度 {least} 大于最大长度 {most}",
                "the minimum length, {least}, is larger than the maximum, {most}"
            );
            let fault = Diagnostic::error(FaultCode::LengthInverted, span, message);
            faults.push(fault.fix(
                span,
                format!("[{most}, {least}]"),
                text!("交换两者", "swap them"),
            ));
        }
    }
}

/// Checks that `pattern` belongs to strings and is a regular expression.
pub(super) fn check_patterns(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some(pattern) = FIELD.pattern.read(part.origin.node) else {
            continue;
        };
        let span = part.origin.at(FIELD.pattern);
        if field.ty != Type::String {
            let message = misfit(FIELD.pattern.name, field, &text!("字符串", "a string"));
            let fault = Diagnostic::error(FaultCode::PatternOnWrongType, span, message);
            faults.push(fault.also_type(part.ty));
        }
        if let Err(error) = Pattern::new(pattern) {
            let message = match error {
                PatternError::Syntax(_) => {
                    text!("这不是正则表达式", "this is not a regular expression")
                }
                PatternError::NotPortable(_) | PatternError::TooLarge => text!(
                    "不是所有语言都支持这个正则表达式",
                    "not every language supports this regular expression"
                ),
            };
            let fault = Diagnostic::error(FaultCode::BadPattern, span, message);
            faults.push(fault.note(error.text()));
        }
    }
}

/// Checks that `only` belongs to enums and lists valid values, each once.
pub(super) fn check_only(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        if field.details().constraints.only.is_empty() {
            continue;
        }
        if !is_enum(draft, &field.ty) {
            let span = part.origin.at(FIELD.only);
            let message = misfit(FIELD.only.name, field, &text!("枚举", "an enum"));
            let fault = Diagnostic::error(FaultCode::OnlyOnWrongType, span, message);
            faults.push(fault.also_type(part.ty));
            continue;
        }
        let list = ValueList {
            wrong: FaultCode::OnlyValue,
            ty: Some((part.ty, text!("枚举", "the enum"))),
            repeated: FaultCode::OnlyTwice,
            message: text!("这个值出现两次", "this value occurs twice"),
        };
        list.check(
            FIELD.only.items(part.origin.node),
            |node| check_type(draft, &field.ty, node),
            faults,
        );
    }
}

/// Returns `true` for an enum. Also `true` for an unknown type, which has its own error.
pub(super) fn is_enum(draft: &Draft<'_>, ty: &Type) -> bool {
    let is_named = matches!(ty, Type::Named(_));
    is_named && matches!(draft.shape(ty), None | Some(TypeShape::Enum(_)))
}

/// Checks that `default` belongs to optional fields and matches their type and bounds.
pub(super) fn check_defaults(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        let Some(default) = &field.details().default else {
            continue;
        };
        let span = part.origin.at(FIELD.default);
        if !field.optional {
            let message = text!(
                "`{field}` 是必填，不能有默认值",
                "`{field}` is required, so it cannot have a default",
                field = field.wire
            );
            let fault = Diagnostic::error(FaultCode::DefaultOnRequired, span, message);
            faults.push(fault.also(
                part.ty,
                text!(
                    "去掉默认值，或者在类型后面加 `?` 改为可选",
                    "remove the default, or add `?` to the type to make it optional"
                ),
            ));
        }
        if is_default(draft, &field.ty, default) {
            if let Some(node) = FIELD.default.of(part.origin.node) {
                let code = FaultCode::DefaultConstraint;
                let broken = check_constraints(field, node, &Value::from(default));
                faults.extend(broken.into_iter().map(|it| Diagnostic { code, ..it }));
            }
        } else {
            let message = text!(
                "这个值不符合 `{field}` 的类型",
                "this is not a value of the type of `{field}`",
                field = field.wire
            );
            let fault = Diagnostic::error(FaultCode::DefaultType, span, message);
            faults.push(fault.also_type(part.ty));
        }
    }
}

fn is_default(draft: &Draft<'_>, ty: &Type, default: &Scalar) -> bool {
    match (ty, default) {
        (Type::Bool, Scalar::Bool(_))
        | (Type::Float(_), Scalar::Number(_))
        | (Type::TimestampMs | Type::TimestampS, Scalar::Number(Number::Int(_)))
        | (Type::String, Scalar::String(_)) => true,
        (Type::Int(kind), Scalar::Number(Number::Int(value))) => {
            let (least, most) = kind.range();
            (least..=most).contains(value)
        }
        (Type::Named(_), default) => match draft.shape(ty) {
            Some(TypeShape::Enum(shape)) => shape.values.iter().any(|value| value.wire == *default),
            Some(_) => false,
            // An unknown type has its own error.
            None => true,
        },
        _ => false,
    }
}

/// Checks that quirks belong to types whose decoding they can relax.
pub(super) fn check_quirks(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let quirks = &field.details().quirks;
        if quirks.is_empty() {
            continue;
        }
        for (quirk, node) in quirks.iter().zip(FIELD.quirk.items(part.origin.node)) {
            let (expected, fits) = match quirk {
                Quirk::EmptyIsAbsent => (text!("可选字段", "an optional field"), field.optional),
                Quirk::LenientNumber => (
                    text!("数值", "a number"),
                    matches!(
                        field.ty,
                        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS
                    ),
                ),
                Quirk::LenientBool => (text!("布尔值", "a bool"), field.ty == Type::Bool),
            };
            if !fits {
                let (code, span) = (FaultCode::QuirkOnWrongType, node.span());
                let fault = Diagnostic::error(code, span, misfit(quirk.name(), field, &expected));
                faults.push(fault.also_type(part.ty));
            }
        }
    }
}

/// Checks that `wire: string` belongs to numbers and bools, and `wire: number` to bools.
pub(super) fn check_wire_forms(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let (expected, fits) = match field.wire_form {
            WireForm::Plain => continue,
            WireForm::String => (
                text!("数值或布尔值", "a number or bool"),
                matches!(
                    field.ty,
                    Type::Bool
                        | Type::Int(_)
                        | Type::Float(_)
                        | Type::TimestampMs
                        | Type::TimestampS
                ),
            ),
            WireForm::Number => (text!("布尔值", "a bool"), field.ty == Type::Bool),
        };
        if !fits {
            let said = format!("{}: {}", FIELD.wire.name, field.wire_form.name());
            let (code, span) = (FaultCode::WireOnWrongType, part.origin.at(FIELD.wire));
            let fault = Diagnostic::error(code, span, misfit(&said, field, &expected));
            faults.push(fault.also_type(part.ty));
        }
    }
}

/// Checks that a body that is lost, or free by design, has no fields.
pub(super) fn check_open_bodies(draft: &Draft<'_>, faults: &mut Faults) {
    for ty in &draft.types {
        if let TypeShape::Struct(shape) = &ty.def.shape
            && let state @ (BodyState::Open | BodyState::Free) = shape.state
            && let Some(part) = ty.parts.first()
        {
            let message = text!(
                "标为 `{state}` 的消息体不能有字段",
                "a body that is `{state}` cannot have fields",
                state = state.name()
            );
            let fault = Diagnostic::error(FaultCode::OpenBodyFields, part.origin.name(), message);
            faults.push(fault.note(match state {
                BodyState::Free => text!(
                    "删去 `free`：未知的键本来就原样保留",
                    "remove `free`: receivers keep unknown keys anyway"
                ),
                _ => text!(
                    "这些字段在源文档中有依据时，改写为 `inferred`",
                    "write `inferred` if the source document gives evidence for these fields"
                ),
            }));
        }
    }
}

/// Returns `true` if examples leave out a required field.
pub(super) fn is_absent_required(field: &Field) -> bool {
    field.example == Example::Absent && !field.optional
}
