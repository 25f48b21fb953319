//! Checks enums and choices.

use super::names::check_distinct;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{CHOICE, ENUM, ENUM_VALUE};
use crate::load::draft::Draft;
use crate::model::{EnumRepr, Number, Scalar, StructType, TypeShape};
use crate::text;
use std::collections::HashSet;

/// Checks that an enum has values that fit its type, and that a choice has variants.
pub(super) fn check_values(draft: &Draft<'_>, faults: &mut Faults) {
    for ty in &draft.types {
        match &ty.def.shape {
            TypeShape::Enum(shape) => {
                if shape.values.is_empty() {
                    let span = ty.origin.at(ENUM.values);
                    let message = text!(
                        "`{name}` 没有取值",
                        "`{name}` has no values",
                        name = ty.def.name
                    );
                    faults.push(Diagnostic::error(FaultCode::EmptyEnum, span, message));
                }
                if let EnumRepr::Int(kind) = shape.repr {
                    let (least, most) = kind.range();
                    for (value, part) in shape.values.iter().zip(&ty.parts) {
                        let fits = matches!(value.wire, Scalar::Number(Number::Int(value))
                            if (least..=most).contains(&value));
                        if !fits && !part.broken {
                            let message = text!(
                                "这不是 {kind} 的值",
                                "this is not a value of {kind}",
                                kind = kind.name()
                            );
                            let span = part.origin.name();
                            let fault = Diagnostic::error(FaultCode::EnumValueType, span, message);
                            faults.push(fault.also(
                                ty.origin.at(ENUM.r#enum),
                                text!("发送时的类型", "the type that is sent"),
                            ));
                        }
                    }
                }
            }
            TypeShape::OneOf(choice) if choice.variants.len() < 2 => {
                let span = ty.origin.at(CHOICE.one_of);
                let message = text!(
                    "多选一至少要有两个选项",
                    "a choice needs at least two variants"
                );
                faults.push(Diagnostic::error(FaultCode::EmptyEnum, span, message));
            }
            TypeShape::OneOf(_) | TypeShape::Struct(_) => {}
        }
    }
}

/// Checks that values of an enum, and variants of a choice, have distinct names.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    for ty in &draft.types {
        match &ty.def.shape {
            TypeShape::Enum(shape) => {
                let parts = shape.values.iter().zip(&ty.parts);
                let names = parts
                    .map(|(value, part)| (value.name.as_str(), part.origin.at(ENUM_VALUE.name)));
                check_distinct(&text!("枚举值", "values of the enum"), names, faults);
            }
            TypeShape::OneOf(choice) => {
                let parts = choice.variants.iter().zip(&ty.parts);
                let names =
                    parts.map(|(variant, part)| (variant.name.as_str(), part.origin.name()));
                check_distinct(&text!("选项", "variants of the choice"), names, faults);
            }
            TypeShape::Struct(_) => {}
        }
    }
}

/// Checks that every variant can be reached. A decoder takes the first variant whose required keys are all present. A
/// variant that requires all keys of an earlier one is unreachable.
pub(super) fn check_variants(draft: &Draft<'_>, faults: &mut Faults) {
    for ty in &draft.types {
        let TypeShape::OneOf(choice) = &ty.def.shape else {
            continue;
        };
        let mut earlier: Vec<(&str, HashSet<&str>, crate::source::Span)> = Vec::new();
        for (variant, part) in choice.variants.iter().zip(&ty.parts) {
            let Some(shape) = draft.struct_named(variant.ty.name()) else {
                continue;
            };
            let required = required_keys(shape);
            let span = part.origin.name();
            let hiding = earlier
                .iter()
                .find(|(_, keys, _)| keys.is_subset(&required));
            if let Some((name, _, at)) = hiding {
                let message = text!(
                    "`{variant}` 有 `{name}` 的全部必填键，总会被当成 `{name}`",
                    "`{variant}` has all required keys of `{name}`, so it is always read as `{name}`",
                    variant = variant.name
                );
                faults.push(
                    Diagnostic::error(FaultCode::SameVariants, span, message)
                        .also(*at, text!("先匹配这个", "matched first"))
                        .note(text!(
                            "把必填键更多的选项放在前面",
                            "put the variant with more required keys first"
                        )),
                );
            }
            earlier.push((&variant.name, required, span));
        }
    }
}

fn required_keys(shape: &StructType) -> HashSet<&str> {
    let required = shape.fields.iter().filter(|field| !field.optional);
    required.map(|field| field.wire.as_str()).collect()
}
