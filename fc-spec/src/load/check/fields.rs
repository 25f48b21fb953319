//! What a field says about itself.

use super::each::{fields, typed_fields};
use super::value::{Mismatch, check_constraints, check_type};
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::load::grammar::{FIELD, TEXT};
use crate::load::scalar;
use crate::model::{
    BodyState, Example, Field, Number, Quirk, Scalar, Type, TypeShape, Value, WireForm,
};
use crate::syntax::{Node, Span};
use regex_lite::Regex;

/// A field in the short form has a named type, whose title describes it.
pub(super) fn check_short_forms(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if part.borrows_text && !matches!(field.ty, Type::Named(_)) {
            let message = format!("`{}` has no description", field.wire);
            faults.push(
                Diagnostic::error(FaultCode::ShortForm, part.ty, message)
                    .note("write `{ type: …, zh: …, en: … }`; the short form is for named types, whose title describes the field"),
            );
        }
    }
}

/// An object in place is described, unless it is the usual `data`.
pub(super) fn check_texts(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        let node = part.place.node;
        let is_inline = node.as_mapping().is_some() && FIELD.r#type.of(node).is_none();
        if !is_inline {
            continue;
        }
        let span = part.place.name();
        let zh = field.text.zh.is_empty() && TEXT.zh.of(node).is_none();
        let en = field.text.en.is_empty() && TEXT.en.of(node).is_none();
        let message = match (zh, en) {
            (true, true) => "this inline object has neither a Chinese nor an English text",
            (true, false) => "the Chinese text `zh` of this inline object is missing",
            (false, true) => "the English text `en` of this inline object is missing",
            (false, false) => continue,
        };
        let fault = Diagnostic::error(FaultCode::MissingTranslation, span, message);
        faults.push(fault.note("write `{ fields: { … }, zh: …, en: … }`"));
    }
}

/// `min` and `max` stand on numbers, within what their type holds, in order.
pub(super) fn check_bounds(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        for (key, bound) in [
            (FIELD.min, field.details().min.as_ref()),
            (FIELD.max, field.details().max.as_ref()),
        ] {
            let Some(bound) = bound else {
                continue;
            };
            let span = part.place.at(key);
            match field.ty {
                Type::Int(kind) => {
                    let (least, most) = kind.range();
                    let fits =
                        matches!(bound, Number::Int(value) if (least..=most).contains(value));
                    if !fits {
                        let message = format!("this is not a value of {}", kind.name());
                        faults.push(
                            Diagnostic::error(FaultCode::BoundsBeyondType, span, message)
                                .also(part.ty, "the type"),
                        );
                    }
                }
                Type::Float(_) => {}
                _ => faults.push(wrong_type(
                    FaultCode::BoundsOnWrongType,
                    key.name,
                    "a number",
                    field,
                    (span, part.ty),
                )),
            }
        }
        if let (Some(min), Some(max)) = (&field.details().min, &field.details().max)
            && scalar::compare(min, max).is_gt()
        {
            faults.push(
                Diagnostic::error(
                    FaultCode::MinAboveMax,
                    part.place.at(FIELD.min),
                    "`min` is larger than `max`",
                )
                .also(part.place.at(FIELD.max), "the largest"),
            );
        }
    }
}

/// A key that the type of the field has no use for.
fn wrong_type(
    code: FaultCode,
    key: &str,
    expected: &str,
    field: &Field,
    (span, ty): (Span, Span),
) -> Diagnostic {
    let message = format!("`{key}` is for {expected}, which `{}` is not", field.wire);
    Diagnostic::error(code, span, message).also(ty, "the type")
}

/// `length` stands on strings, bytes and lists, in order.
pub(super) fn check_lengths(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some((least, most)) = field.details().length else {
            continue;
        };
        let span = part.place.at(FIELD.length);
        if !matches!(field.ty, Type::String | Type::Base64 | Type::Array(_)) {
            let expected = "a string, base64 or list";
            let spans = (span, part.ty);
            faults.push(wrong_type(
                FaultCode::LengthOnWrongType,
                FIELD.length.name,
                expected,
                field,
                spans,
            ));
        }
        if least > most {
            faults.push(
                Diagnostic::error(
                    FaultCode::LengthInverted,
                    span,
                    format!("the minimum length, {least}, is larger than the maximum, {most}"),
                )
                .fix(span, format!("[{most}, {least}]"), "swap them"),
            );
        }
    }
}

/// `pattern` stands on strings and is a regular expression.
pub(super) fn check_patterns(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let Some(pattern) = &field.details().pattern else {
            continue;
        };
        let span = part.place.at(FIELD.pattern);
        if field.ty != Type::String {
            let spans = (span, part.ty);
            faults.push(wrong_type(
                FaultCode::PatternOnWrongType,
                FIELD.pattern.name,
                "a string",
                field,
                spans,
            ));
        }
        if let Err(error) = Regex::new(&format!("^(?:{pattern})$")) {
            let message = "this is not a regular expression";
            faults.push(
                Diagnostic::error(FaultCode::BadPattern, span, message).note(error.to_string()),
            );
        }
    }
}

/// `only` stands on enums and names values of theirs, each once.
pub(super) fn check_only(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        if field.details().only.is_empty() {
            continue;
        }
        if !is_enum(draft, &field.ty) {
            let spans = (part.place.at(FIELD.only), part.ty);
            faults.push(wrong_type(
                FaultCode::OnlyOnWrongType,
                FIELD.only.name,
                "an enum",
                field,
                spans,
            ));
            continue;
        }
        let mut earlier: Vec<Node<'_>> = Vec::new();
        for node in FIELD.only.items(part.place.node) {
            let mut found = Vec::new();
            check_type(draft, &field.ty, node, &mut found);
            faults.extend(found.into_iter().map(|mismatch| {
                let code = FaultCode::OnlyValue;
                let fault = Mismatch { code, ..mismatch }.into_fault();
                fault.also(part.ty, "the enum")
            }));
            let wire = scalar::scalar(node);
            match earlier.iter().find(|it| scalar::scalar(**it) == wire) {
                Some(first) => {
                    let message = "this value is taken already";
                    let fault = Diagnostic::error(FaultCode::OnlyTwice, node.span(), message);
                    faults.push(fault.also(first.span(), "here"));
                }
                None => earlier.push(node),
            }
        }
    }
}

/// Whether it is an enum, or may be: an unknown type is reported as such.
fn is_enum(draft: &Draft<'_>, ty: &Type) -> bool {
    let Type::Named(named) = ty else { return false };
    let shape = draft.type_named(named.name()).map(|ty| &ty.def.shape);
    matches!(shape, None | Some(TypeShape::Enum(_)))
}

/// `default` stands on optional fields, is a value of their type and keeps within their bounds.
pub(super) fn check_defaults(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        let Some(default) = &field.details().default else {
            continue;
        };
        let span = part.place.at(FIELD.default);
        if !field.optional {
            faults.push(
                Diagnostic::error(
                    FaultCode::DefaultOnRequired,
                    span,
                    format!(
                        "`{}` is never absent, so it cannot have a default",
                        field.wire
                    ),
                )
                .also(part.ty, "a `?` after the type makes it optional"),
            );
        }
        if is_default(draft, &field.ty, default) {
            if let Some(node) = FIELD.default.of(part.place.node) {
                let mut found = Vec::new();
                check_constraints(field, node, &Value::from(default), &mut found);
                faults.extend(found.into_iter().map(|mismatch| {
                    let code = FaultCode::DefaultConstraint;
                    Mismatch { code, ..mismatch }.into_fault()
                }));
            }
        } else {
            faults.push(
                Diagnostic::error(
                    FaultCode::DefaultType,
                    span,
                    format!("this is not a value of the type of `{}`", field.wire),
                )
                .also(part.ty, "the type"),
            );
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
        (Type::Named(named), default) => match draft
            .type_named(named.name())
            .map(|ty| &ty.def.shape)
        {
            Some(TypeShape::Enum(shape)) => shape.values.iter().any(|value| value.wire == *default),
            Some(_) => false,
            // An unknown type is reported as such.
            None => true,
        },
        _ => false,
    }
}

/// Quirks stand on types whose decoding they can relax.
pub(super) fn check_quirks(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let quirks = &field.details().quirks;
        if quirks.is_empty() {
            continue;
        }
        for (quirk, node) in quirks.iter().zip(FIELD.quirk.items(part.place.node)) {
            let (expected, fits) = match quirk {
                Quirk::EmptyIsAbsent => ("an optional field", field.optional),
                Quirk::LenientNumber => (
                    "a number",
                    matches!(
                        field.ty,
                        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS
                    ),
                ),
                Quirk::LenientBool => ("a bool", field.ty == Type::Bool),
            };
            if !fits {
                let spans = (node.span(), part.ty);
                faults.push(wrong_type(
                    FaultCode::QuirkOnWrongType,
                    quirk.name(),
                    expected,
                    field,
                    spans,
                ));
            }
        }
    }
}

/// `wire: string` stands on what is no string anyway, `wire: number` on bools.
pub(super) fn check_wire_forms(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in typed_fields(draft) {
        let (expected, fits) = match field.wire_form {
            WireForm::Plain => continue,
            WireForm::String => (
                "a number or bool",
                matches!(
                    field.ty,
                    Type::Bool
                        | Type::Int(_)
                        | Type::Float(_)
                        | Type::TimestampMs
                        | Type::TimestampS
                ),
            ),
            WireForm::Number => ("a bool", field.ty == Type::Bool),
        };
        if !fits {
            let spans = (part.place.at(FIELD.wire), part.ty);
            let said = format!("{}: {}", FIELD.wire.name, field.wire_form.name());
            faults.push(wrong_type(
                FaultCode::WireOnWrongType,
                &said,
                expected,
                field,
                spans,
            ));
        }
    }
}

/// A lost body has no fields.
pub(super) fn check_open_bodies(draft: &Draft<'_>, faults: &mut Faults) {
    for ty in &draft.types {
        if let TypeShape::Struct(shape) = &ty.def.shape
            && shape.state == BodyState::Open
            && let Some(part) = ty.parts.first()
        {
            faults.push(
                Diagnostic::error(
                    FaultCode::OpenBodyFields,
                    part.place.name(),
                    "an open body cannot have fields: nothing is known about it",
                )
                .note("use `inferred` if the source document gives evidence for these fields"),
            );
        }
    }
}

/// Whether a required field is left out of examples is no question.
pub(super) fn is_absent_required(field: &Field) -> bool {
    field.example == Example::Absent && !field.optional
}
