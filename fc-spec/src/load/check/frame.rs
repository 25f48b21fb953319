//! Checks ports, header, heads, kinds and encodings.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{
    COMMON, ENCODING, FRAME, FRAME_KIND, HEADER_FIELD, HEADS, Key, PORT, TRANSPORT,
};
use crate::load::draft::{Draft, FrameDraft, Sourced};
use crate::model::{
    EncodingRole, HeaderField, HeaderQuirk, HeaderRole, HeaderType, KindRole, PortRole, Text,
};
use crate::names;
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use crate::vocabulary::Word;
use std::collections::HashMap;

/// Checks that the two ports differ.
pub(super) fn check_ports(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(transport) = &draft.transport else {
        return;
    };
    let [first, second] = transport.item.ports.each();
    if first.number == second.number {
        let span = |port: PortRole| {
            let ports = TRANSPORT.ports.of(transport.origin.node);
            let port = PORT
                .number
                .of(ports.and_then(|ports| ports.get(port.name())));
            port.map_or(transport.origin.name(), Node::span)
        };
        let message = text!(
            "两个端口的号码都是 {number}",
            "both ports have the number {number}",
            number = second.number
        );
        let fault = Diagnostic::error(FaultCode::SamePort, span(PortRole::Data), message);
        faults.push(fault.also_first(span(PortRole::Command)));
    }
}

/// Checks that every header field has a known width, which fits its role.
pub(super) fn check_header_types(draft: &Draft<'_>, faults: &mut Faults) {
    for field in header(draft) {
        let span = field.origin.at(HEADER_FIELD.r#type);
        if field.item.ty.size() == 0 {
            let message = text!(
                "包头字段的类型应为 u8、u16、u32、u64 或 `bytes(N)`",
                "expected a header field type: u8, u16, u32, u64 or `bytes(N)`"
            );
            let fault = Diagnostic::error(FaultCode::BadHeaderType, span, message);
            faults.push(fault.note(text!(
                "类型有 u8、u16、u32、u64 和 `bytes(N)`",
                "the types are u8, u16, u32, u64 and `bytes(N)`"
            )));
            continue;
        }
        let ty = field.item.ty;
        let is_bytes = matches!(ty, HeaderType::Bytes(_));
        let expected = match field.item.role {
            None => continue,
            Some(HeaderRole::Head) if is_bytes => continue,
            Some(HeaderRole::Head) => HeaderType::Bytes(ty.size()),
            // A status has a numeric value of any width.
            Some(HeaderRole::Status) if !is_bytes => continue,
            Some(HeaderRole::Status | HeaderRole::Kind | HeaderRole::Encoding) => HeaderType::U8,
            Some(HeaderRole::Code) => HeaderType::U16,
            // With only 256 ids, a late response would soon match another request.
            Some(HeaderRole::Id) if ty == HeaderType::U16 => continue,
            Some(HeaderRole::Id | HeaderRole::TotalLength | HeaderRole::PlainLength) => {
                HeaderType::U32
            }
            Some(HeaderRole::Digest) => {
                match field.item.digest().map(|word| word.field_type().parse()) {
                    Some(Ok(expected)) => expected,
                    _ => continue,
                }
            }
        };
        if field.item.ty != expected {
            let spelling = expected.to_string();
            let wanted = match field.item.role {
                Some(HeaderRole::Id) => text!("u16 或 {spelling}", "u16 or {spelling}"),
                Some(HeaderRole::Status) => {
                    text!("整数，例如 {spelling}", "an integer, such as {spelling}")
                }
                _ => text!("{spelling}", "{spelling}"),
            };
            let message = text!(
                "这种角色的包头字段，类型应为{wanted}",
                "a header field with this role must be {wanted}",
                wanted = wanted.spaced()
            );
            let role = field.origin.at(HEADER_FIELD.role);
            let fault = Diagnostic::error(FaultCode::HeaderWidth, span, message);
            faults.push(fault.also(role, text!("角色", "the role")).write(spelling));
        }
    }
}

/// Checks that each role occurs once. A frame may omit the optional ones.
pub(super) fn check_header_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let used = frame.header.iter();
    let used = used.filter_map(|it| Some((it.item.role?, it.origin.at(HEADER_FIELD.role))));
    let needed = |role| match role {
        HeaderRole::Head
        | HeaderRole::Kind
        | HeaderRole::Code
        | HeaderRole::Id
        | HeaderRole::TotalLength => true,
        HeaderRole::Encoding
        | HeaderRole::Status
        | HeaderRole::PlainLength
        | HeaderRole::Digest => false,
    };
    check_each_once(
        needed,
        used,
        frame.origin.key_at(FRAME.header),
        &text!("包头字段", "header field"),
        faults,
    );
    let mut fields = frame.header.iter().enumerate();
    let head = fields.find(|(_, field)| field.item.role == Some(HeaderRole::Head));
    if let Some((1.., field)) = head {
        let message = text!(
            "帧头应为第一个包头字段",
            "the head must be the first header field"
        );
        let span = field.origin.name();
        faults.push(Diagnostic::error(FaultCode::HeadNotFirst, span, message));
    }
}

/// Reports each role that is `needed` but not in `used`, and each role that occurs twice in `used`.
pub(super) fn check_each_once<R: Word>(
    needed: impl Fn(R) -> bool,
    used: impl IntoIterator<Item = (R, Span)>,
    at: Span,
    what: &Text,
    faults: &mut Faults,
) {
    let used: Vec<(R, Span)> = used.into_iter().collect();
    for role in R::SET.iter().copied() {
        let name = role.word();
        let mut places = used.iter().filter(|(used, _)| *used == role);
        let Some((_, first)) = places.next() else {
            if needed(role) {
                let message = text!(
                    "缺少角色为 `{name}` 的{what}",
                    "no {what} has the role `{name}`",
                    what = what
                );
                faults.push(Diagnostic::error(FaultCode::RoleMissing, at, message));
            }
            continue;
        };
        for (_, again) in places {
            let message = text!(
                "又有一个角色为 `{name}` 的{what}",
                "a second {what} has the role `{name}`",
                what = what
            );
            faults
                .push(Diagnostic::error(FaultCode::RoleTwice, *again, message).also_first(*first));
        }
    }
}

/// Checks that `value`, `algorithm` and `quirk` apply to their field.
pub(super) fn check_header_values(draft: &Draft<'_>, faults: &mut Faults) {
    for field in header(draft) {
        let item = &field.item;
        if item.has_quirk(HeaderQuirk::ZeroWhenPlain) && item.role != Some(HeaderRole::PlainLength)
        {
            let message = text!(
                "`zero_when_plain` 只适用于角色为 `plain_length` 的字段",
                "`zero_when_plain` only applies to the field with the role `plain_length`"
            );
            let span = field.origin.at(HEADER_FIELD.quirk);
            faults.push(Diagnostic::error(FaultCode::HeaderQuirk, span, message));
        }
        if HEADER_FIELD.algorithm.of(field.origin.node).is_some() && item.digest().is_none() {
            let message = text!(
                "只有角色为 `digest` 的字段才有算法",
                "only the field with the role `digest` has an algorithm"
            );
            let span = field.origin.at(HEADER_FIELD.algorithm);
            let fault = Diagnostic::error(FaultCode::AlgorithmWithoutDigest, span, message);
            faults.push(fault);
        }
        if HEADER_FIELD.value.of(field.origin.node).is_none() {
            continue;
        }
        let span = field.origin.at(HEADER_FIELD.value);
        let bits = u32::try_from(item.ty.size().saturating_mul(8)).unwrap_or(u32::MAX);
        let message = if !item.is_sent_as_value() {
            text!(
                "角色决定这个字段发送的值，不能写 `value`",
                "the role of this field decides its value, so it takes no `value`"
            )
        } else if matches!(item.ty, HeaderType::Bytes(_)) {
            text!(
                "字节字段发送全零，不能有值",
                "a byte field is sent as zeros and cannot have a value"
            )
        } else if bits < 64 && item.value >> bits != 0 {
            text!(
                "{ty} 放不下 {value}",
                "{value} does not fit into {ty}",
                value = item.value,
                ty = item.ty
            )
        } else {
            continue;
        };
        faults.push(Diagnostic::error(FaultCode::HeaderValue, span, message));
    }
}

/// Checks that header fields have distinct names in code.
pub(super) fn check_header_names(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first = HashMap::new();
    for field in header(draft) {
        let name = field.item.name.as_str();
        let span = field.origin.at(COMMON.name);
        faults.extend(super::names::hidden(&field.item.wire, field.origin.name()));
        if !names::is_snake(name) {
            faults.push(super::names::unusable(
                &field.item.wire,
                field.origin.name(),
            ));
        } else if let Some(earlier) = first.insert(name, span) {
            let message = text!(
                "有两个包头字段在代码中都叫 `{name}`",
                "two header fields are named `{name}` in code"
            );
            faults.push(
                Diagnostic::error(FaultCode::DuplicateFieldName, span, message)
                    .also_first(earlier)
                    .note(text!("给其中一个写上 `name`", "give one of them a `name`")),
            );
        }
    }
}

/// Checks that the heads are as long as the head field and differ between requests and responses.
pub(super) fn check_heads(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let span = |key: Key<_>| {
        let head = key.of(FRAME.heads.of(frame.origin.node));
        head.map_or(frame.origin.name(), Node::span)
    };
    let field = frame
        .header
        .iter()
        .find(|field| field.item.role == Some(HeaderRole::Head));
    for (key, head) in [
        (HEADS.request, &frame.request_head),
        (HEADS.response, &frame.response_head),
    ] {
        if let Some(field) = field
            && head.len() != field.item.ty.size()
        {
            let message = text!(
                "帧头应为 {size} 字节，实际为 {bytes} 字节",
                "expected a head of {size} bytes, found {bytes}",
                bytes = head.len(),
                size = field.item.ty.size()
            );
            let fault = Diagnostic::error(FaultCode::HeadLength, span(key), message);
            faults.push(fault.also(
                field.origin.at(HEADER_FIELD.r#type),
                text!("帧头字段", "the head field"),
            ));
        }
    }
    if frame.request_head == frame.response_head {
        let message = text!(
            "请求和响应的帧头相同，无法区分",
            "requests and responses have the same head and cannot be distinguished"
        );
        let fault = Diagnostic::error(FaultCode::HeadsEqual, span(HEADS.response), message);
        faults.push(fault.also(
            span(HEADS.request),
            text!("请求的帧头", "the head of a request"),
        ));
    }
}

/// Checks that streams, commands and reports have one kind each, on the port that the runtime uses for them.
pub(super) fn check_kinds(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let used = frame.kinds.iter();
    let used = used.map(|kind| (kind.item.role, kind.origin.at(FRAME_KIND.role)));
    check_each_once(
        |role| role != KindRole::Reserved,
        used.filter(|(role, _)| *role != KindRole::Reserved),
        frame.origin.key_at(FRAME.kinds),
        &text!("数据类型", "frame kind"),
        faults,
    );
    super::names::check_distinct(
        &text!("数据类型", "frame kinds"),
        frame
            .kinds
            .iter()
            .map(|kind| (kind.item.name.as_str(), kind.origin.at(FRAME_KIND.name))),
        faults,
    );
    for kind in &frame.kinds {
        let expected = match kind.item.role {
            KindRole::Stream => (PortRole::Data, text!("数据流", "streams")),
            KindRole::Command | KindRole::Report => (
                PortRole::Command,
                text!("指令和上报", "commands and reports"),
            ),
            KindRole::Reserved => continue,
        };
        let (port, what) = expected;
        if kind.item.port != port {
            let word = port.name();
            let message = text!(
                "{what}的端口应为 `{word}`",
                "{what} need the port `{word}`",
                what = what
            );
            let span = kind.origin.at(FRAME_KIND.port);
            faults.push(Diagnostic::error(FaultCode::KindPort, span, message).write(word));
        }
    }
}

/// Checks that each encoding role occurs at most once, and plain at least once if the header has an encoding field.
/// Also checks that the header has the fields that a receiver needs.
pub(super) fn check_encodings(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(frame) = &draft.frame else {
        return;
    };
    let encodings = frame.encodings.iter();
    let used = encodings
        .clone()
        .map(|encoding| (encoding.item.role, encoding.origin.at(ENCODING.role)));
    let origin = frame.origin.key_at(FRAME.encodings);
    let has = |role| (frame.header.iter()).any(|field| field.item.role == Some(role));
    let mut lacking = |role: HeaderRole, why: &Text| {
        let message = text!(
            "没有角色为 `{role}` 的包头字段，{why}",
            "no header field has the role `{role}`, {why}",
            role = role.name(),
            why = why
        );
        let fault = Diagnostic::error(FaultCode::RoleMissing, origin, message);
        faults.push(fault.also(
            frame.origin.key_at(FRAME.header),
            text!("包头", "the header"),
        ));
    };
    let is_packed = used.clone().any(|(role, _)| role == EncodingRole::Gzip);
    if !has(HeaderRole::Encoding) && !frame.encodings.is_empty() {
        let why = text!(
            "无法区分一帧用了哪一种",
            "so a frame cannot show which of these it has"
        );
        lacking(HeaderRole::Encoding, &why);
    } else if !has(HeaderRole::PlainLength) && is_packed {
        let why = text!("而压缩的数据需要它", "which compressed data needs");
        lacking(HeaderRole::PlainLength, &why);
    }
    let needed = |role| role == EncodingRole::Plain && has(HeaderRole::Encoding);
    check_each_once(needed, used, origin, &text!("压缩方式", "encoding"), faults);
    super::names::check_distinct(
        &text!("压缩方式", "encodings"),
        encodings.map(|encoding| {
            (
                encoding.item.name.as_str(),
                encoding.origin.at(ENCODING.name),
            )
        }),
        faults,
    );
}

/// Returns the length of the header in bytes.
pub(super) fn header_len(frame: &FrameDraft<'_>) -> usize {
    frame.header.iter().fold(0, |length, field| {
        length.saturating_add(field.item.ty.size())
    })
}

fn header<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = &'d Sourced<'a, HeaderField>> {
    draft.frame.iter().flat_map(|frame| &frame.header)
}
