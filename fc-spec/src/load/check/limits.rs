//! Checks that the limits have room for the spec's own messages.

use super::expand::bodies;
use super::frame::header_len;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{FRAME, LIMITS};
use crate::load::draft::{Draft, TypeDraft};
use crate::model::{Example, Field, Type, TypeShape};
use crate::text;
use std::collections::HashMap;

/// Checks that a frame may be at least as long as its header.
pub(super) fn check_header(draft: &Draft<'_>, faults: &mut Faults) {
    let (Some(frame), Some(limits)) = (&draft.frame, &draft.limits) else {
        return;
    };
    let header = header_len(frame);
    if usize::try_from(limits.item.frame_bytes).is_ok_and(|bytes| bytes < header) {
        let message = text!(
            "上限放不下任何帧：包头就有 {header} 字节",
            "the limit is too small for any frame: the header alone has {header} bytes"
        );
        let span = limits.origin.at(LIMITS.frame_bytes);
        let fault = Diagnostic::error(FaultCode::LimitTooSmall, span, message);
        faults.push(fault.also(
            frame.origin.key_at(FRAME.header),
            text!("包头", "the header"),
        ));
    }
}

/// Checks that each body of the spec, with its examples, fits into the limits for nesting, inflated data and
/// uncompressed frames. In `order`, each type comes after those that it contains.
pub(super) fn check_bodies(draft: &Draft<'_>, order: &[usize], faults: &mut Faults) {
    let Some(limits) = &draft.limits else {
        return;
    };
    let mut known = HashMap::new();
    for index in order {
        let ty = draft.types.get(*index);
        known.extend(ty.map(|ty| (*index, extent(draft, ty, &known))));
    }
    let bodies: Vec<_> = bodies(draft)
        .filter_map(|(index, ty)| Some((known.get(&index)?, ty)))
        .collect();
    if let Some((Extent { levels, .. }, body)) = bodies.iter().max_by_key(|(it, _)| it.levels)
        && *levels > limits.item.json_depth
    {
        let message = text!(
            "报文嵌套 {levels} 层，超过这个上限",
            "messages of this spec are nested {levels} levels deep"
        );
        let span = limits.origin.at(LIMITS.json_depth);
        let fault = Diagnostic::error(FaultCode::LimitTooSmall, span, message);
        let deepest = text!("嵌套最深的消息体", "the most deeply nested body");
        faults.push(fault.also(body.origin.name(), deepest));
    }
    let Some((Extent { bytes, .. }, body)) = bodies.iter().max_by_key(|(it, _)| it.bytes) else {
        return;
    };
    let longest = || text!("最长的消息体", "the longest body");
    if *bytes > u64::from(limits.item.inflated_bytes) {
        let message = text!(
            "报文的正文至少有 {bytes} 字节，超过这个上限",
            "messages of this spec have bodies of at least {bytes} bytes"
        );
        let span = limits.origin.at(LIMITS.inflated_bytes);
        let fault = Diagnostic::error(FaultCode::LimitTooSmall, span, message);
        faults.push(fault.also(body.origin.name(), longest()));
    }
    let header = draft.frame.as_ref().map_or(0, header_len);
    let header = u64::try_from(header).unwrap_or(u64::MAX);
    let limit = u64::from(limits.item.frame_bytes);
    let frame = bytes.saturating_add(header);
    if frame > limit && header <= limit {
        let message = text!(
            "不压缩时，报文的帧至少有 {frame} 字节，超过这个上限",
            "uncompressed messages of this spec have frames of at least {frame} bytes"
        );
        let span = limits.origin.at(LIMITS.frame_bytes);
        let fault = Diagnostic::error(FaultCode::LimitTooSmall, span, message);
        faults.push(fault.also(body.origin.name(), longest()));
    }
}

/// A lower bound for the JSON of a type, with the keys of its example.
#[derive(Clone, Copy, Default)]
struct Extent {
    /// Levels of nesting: objects, lists, and those in examples of `json`. A number has none.
    levels: u32,
    /// Bytes of text.
    bytes: u64,
}

/// Returns the extent of a type. `known` holds those of the types that it contains.
fn extent(draft: &Draft<'_>, ty: &TypeDraft<'_>, known: &HashMap<usize, Extent>) -> Extent {
    let named = |name: &str| {
        let inner = draft.type_index.get(name);
        let inner = inner.and_then(|inner| known.get(inner));
        inner.copied().unwrap_or_default()
    };
    match &ty.def.shape {
        TypeShape::Struct(shape) => {
            // Two braces minus the comma that the last key does not have.
            let mut whole = Extent {
                levels: 1,
                bytes: 1,
            };
            for field in &shape.fields {
                let inner = extent_of_field(field, named);
                whole.levels = whole.levels.max(inner.levels.saturating_add(1));
                // A key under a condition may exclude another one.
                if field.details().condition.is_none() && field.example != Example::Absent {
                    // Two quotation marks, a colon and a comma.
                    let key = u64::try_from(field.wire.len()).unwrap_or(u64::MAX);
                    let entry = key.saturating_add(4).saturating_add(inner.bytes);
                    whole.bytes = whole.bytes.saturating_add(entry);
                }
            }
            whole.bytes = whole.bytes.max(2);
            whole
        }
        // A choice is sent as the object of its variant.
        TypeShape::OneOf(choice) => {
            let variants = choice.variants.iter().map(|it| named(it.ty.name()));
            variants.fold(Extent::default(), |most, it| Extent {
                levels: most.levels.max(it.levels),
                bytes: most.bytes.max(it.bytes),
            })
        }
        TypeShape::Enum(_) => Extent {
            levels: 0,
            bytes: 1,
        },
    }
}

fn extent_of_field(field: &Field, named: impl Fn(&str) -> Extent) -> Extent {
    let mut lists = 0;
    let mut ty = &field.ty;
    while let Type::Array(item) = ty {
        lists += 1;
        ty = item;
    }
    let inner = match ty {
        Type::Named(inner) => named(inner.name()),
        _ => Extent::default(),
    };
    let mut extent = Extent {
        levels: inner.levels.saturating_add(lists),
        bytes: match ty {
            _ if lists > 0 => 2,
            Type::Named(_) => inner.bytes,
            Type::String | Type::Base64 => 2,
            _ => 1,
        },
    };
    // An example of a named type uses names of values, which may be longer than the values.
    if let Example::Given(value) = &field.example
        && ty.innermost().is_none()
    {
        let text = value.to_string();
        extent.levels = extent.levels.max(value.levels());
        extent.bytes = u64::try_from(text.len()).unwrap_or(u64::MAX);
    }
    extent
}
