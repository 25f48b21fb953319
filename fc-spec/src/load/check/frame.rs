//! Ports, header, heads, kinds, encodings, limits.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, FrameDraft, Placed};
use crate::load::names;
use crate::model::{
    EncodingRole, HeaderField, HeaderQuirk, HeaderRole, HeaderType, KindRole, PortRole,
};
use crate::syntax::{Node, Span};
use crate::vocabulary::Word;
use std::collections::HashMap;

/// The two ports differ.
pub(super) fn check_ports(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(transport) = &draft.transport else {
        return;
    };
    if let [first, second] = transport.item.ports.as_slice()
        && first.number == second.number
    {
        let span = |port: PortRole| {
            let ports = transport.place.node.get("ports");
            let port = ports.and_then(|ports| ports.get(port.name())?.get("number"));
            port.map_or(transport.place.name(), Node::span)
        };
        faults.push(
            Diagnostic::error(
                FaultCode::SamePort,
                span(PortRole::Data),
                format!("both ports have the number {}", second.number),
            )
            .also(span(PortRole::Command), "first used here"),
        );
    }
}

/// Every header field has a known width, which is that of its role.
pub(super) fn check_header_types(draft: &Draft<'_>, faults: &mut Faults) {
    for field in header(draft) {
        let span = field.place.at("type");
        if field.item.ty.size() == 0 {
            faults.push(
                Diagnostic::error(
                    FaultCode::BadHeaderType,
                    span,
                    "this is not a header field type",
                )
                .note("the types are u8, u16, u32, u64 and `bytes(N)`"),
            );
            continue;
        }
        let expected = match field.item.role {
            Some(HeaderRole::Kind | HeaderRole::Encoding) => HeaderType::U8,
            Some(HeaderRole::Code) => HeaderType::U16,
            Some(HeaderRole::Id | HeaderRole::TotalLength | HeaderRole::PlainLength) => {
                HeaderType::U32
            }
            Some(HeaderRole::Digest) => HeaderType::Bytes(16),
            Some(HeaderRole::Head) if !matches!(field.item.ty, HeaderType::Bytes(_)) => {
                HeaderType::Bytes(field.item.ty.size())
            }
            _ => continue,
        };
        if field.item.ty != expected {
            let spelling = expected.to_string();
            let message = format!("a header field with this role must be {spelling}");
            let fix = format!("write `{spelling}`");
            faults.push(
                Diagnostic::error(FaultCode::HeaderWidth, span, message)
                    .also(field.place.at("role"), "the role")
                    .fix(span, spelling, fix),
            );
        }
    }
}

/// Each role stands once; `status` may be left out.
pub(super) fn check_header_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let used = frame
        .header
        .iter()
        .filter_map(|field| Some((field.item.role?, field.place.at("role"))))
        .collect::<Vec<_>>();
    let needed = |role| role != HeaderRole::Status;
    check_each_once(
        needed,
        &used,
        frame.place.key_at("header"),
        "header field",
        faults,
    );
    if let Some(head) = frame
        .header
        .iter()
        .position(|field| field.item.role == Some(HeaderRole::Head))
        && head > 0
        && let Some(field) = frame.header.get(head)
    {
        faults.push(Diagnostic::error(
            FaultCode::HeadNotFirst,
            field.place.name(),
            "the head is not the first header field, so frames could not be recognised by it",
        ));
    }
}

/// Each role that is `needed` is used, and none of those `used` is used twice.
pub(super) fn check_each_once<R: Word>(
    needed: impl Fn(R) -> bool,
    used: &[(R, Span)],
    at: Span,
    what: &str,
    faults: &mut Faults,
) {
    for role in R::SET.iter().copied() {
        let name = role.word();
        let mut places = used.iter().filter(|(used, _)| *used == role);
        let Some((_, first)) = places.next() else {
            if needed(role) {
                let message = format!("no {what} has the role `{name}`");
                faults.push(Diagnostic::error(FaultCode::RoleMissing, at, message));
            }
            continue;
        };
        for (_, again) in places {
            let message = format!("a second {what} has the role `{name}`");
            faults.push(
                Diagnostic::error(FaultCode::RoleTwice, *again, message)
                    .also(*first, "first used here"),
            );
        }
    }
}

/// `value` and `quirk` stand only where they mean something.
pub(super) fn check_header_values(draft: &Draft<'_>, faults: &mut Faults) {
    for field in header(draft) {
        let item = &field.item;
        if item.has_quirk(HeaderQuirk::ZeroWhenPlain) && item.role != Some(HeaderRole::PlainLength)
        {
            faults.push(Diagnostic::error(
                FaultCode::HeaderQuirk,
                field.place.at("quirk"),
                "`zero_when_plain` only applies to the field with the role `plain_length`",
            ));
        }
        if field.place.node.get("value").is_none() {
            continue;
        }
        let span = field.place.at("value");
        let bits = u32::try_from(item.ty.size().saturating_mul(8)).unwrap_or(u32::MAX);
        let message = if !matches!(item.role, None | Some(HeaderRole::Status)) {
            "the role of this field decides what is sent".to_owned()
        } else if matches!(item.ty, HeaderType::Bytes(_)) {
            "a byte field is sent as zeros and cannot have a value".to_owned()
        } else if bits < 64 && item.value >> bits != 0 {
            format!("{} does not fit into {}", item.value, item.ty)
        } else {
            continue;
        };
        faults.push(Diagnostic::error(FaultCode::HeaderValue, span, message));
    }
}

/// Header fields have names in code, each its own.
pub(super) fn check_header_names(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first = HashMap::new();
    for field in header(draft) {
        let name = field.item.name.as_str();
        let span = field.place.at("name");
        if !names::is_snake(name) {
            faults.push(super::names::unusable(&field.item.wire, field.place.name()));
        } else if let Some(earlier) = first.insert(name, span) {
            let message = format!("two header fields are named `{name}` in code");
            faults.push(
                Diagnostic::error(FaultCode::DuplicateFieldName, span, message)
                    .also(earlier, "first used here")
                    .note("give one of them a `name`"),
            );
        }
    }
}

/// The heads are as long as the head field, and tell requests from responses.
pub(super) fn check_heads(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let span = |key: &str| {
        let heads = frame.place.node.get("heads");
        let head = heads.and_then(|heads| heads.get(key));
        head.map_or(frame.place.name(), Node::span)
    };
    let field = frame
        .header
        .iter()
        .find(|field| field.item.role == Some(HeaderRole::Head));
    for (key, head) in [
        ("request", &frame.request_head),
        ("response", &frame.response_head),
    ] {
        if let Some(field) = field
            && head.len() != field.item.ty.size()
        {
            let message = format!(
                "this head has {} bytes and the header's head field {}",
                head.len(),
                field.item.ty.size()
            );
            faults.push(
                Diagnostic::error(FaultCode::HeadLength, span(key), message)
                    .also(field.place.at("type"), "the head field"),
            );
        }
    }
    if frame.request_head == frame.response_head {
        faults.push(
            Diagnostic::error(
                FaultCode::HeadsEqual,
                span("response"),
                "requests and responses have the same head and cannot be distinguished",
            )
            .also(span("request"), "the head of a request"),
        );
    }
}

/// Streams, commands and reports have one kind each, on the port that the engine uses for them.
pub(super) fn check_kinds(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let used = frame
        .kinds
        .iter()
        .filter(|kind| kind.item.role != KindRole::Reserved)
        .map(|kind| (kind.item.role, kind.place.at("role")))
        .collect::<Vec<_>>();
    check_each_once(
        |role| role != KindRole::Reserved,
        &used,
        frame.place.key_at("kinds"),
        "frame kind",
        faults,
    );
    super::names::check_distinct(
        "frame kinds",
        frame
            .kinds
            .iter()
            .map(|kind| (kind.item.name.as_str(), kind.place.at("name"))),
        faults,
    );
    for kind in &frame.kinds {
        let expected = match kind.item.role {
            KindRole::Stream => (PortRole::Data, "streams"),
            KindRole::Command | KindRole::Report => (PortRole::Command, "commands and reports"),
            KindRole::Reserved => continue,
        };
        let (port, what) = expected;
        if kind.item.port != port {
            let word = port.name();
            let message = format!("{what} are sent on the port `{word}`");
            let span = kind.place.at("port");
            faults.push(Diagnostic::error(FaultCode::KindPort, span, message).fix(
                span,
                word,
                format!("write `{word}`"),
            ));
        }
    }
}

/// Each way of packing has one encoding.
pub(super) fn check_encodings(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let encodings = frame.encodings.iter();
    let used = encodings
        .clone()
        .map(|encoding| (encoding.item.role, encoding.place.at("role")))
        .collect::<Vec<_>>();
    check_each_once(
        |_: EncodingRole| true,
        &used,
        frame.place.key_at("encodings"),
        "encoding",
        faults,
    );
    super::names::check_distinct(
        "encodings",
        encodings.map(|encoding| (encoding.item.name.as_str(), encoding.place.at("name"))),
        faults,
    );
}

/// A frame may be as long as its own header at least.
pub(super) fn check_limits(draft: &Draft<'_>, faults: &mut Faults) {
    let (Some(frame), Some(limits)) = (&draft.frame, &draft.limits) else {
        return;
    };
    let header = header_len(frame);
    if usize::try_from(limits.item.frame_bytes).is_ok_and(|bytes| bytes < header) {
        faults.push(
            Diagnostic::error(
                FaultCode::LimitTooSmall,
                limits.place.at("frame_bytes"),
                format!("no frame can fit: the header alone has {header} bytes"),
            )
            .also(frame.place.key_at("header"), "the header"),
        );
    }
}

fn header_len(frame: &FrameDraft<'_>) -> usize {
    frame.header.iter().fold(0, |length, field| {
        length.saturating_add(field.item.ty.size())
    })
}

fn header<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = &'d Placed<'a, HeaderField>> {
    draft.frame.iter().flat_map(|frame| &frame.header)
}
