//! What lies below the messages.

use super::body::port_name;
use super::build::{
    aliases, described, list, number, object, or_null, scalar, size, string, text, type_name,
};
use fc_spec::model::{
    ByteOrder, CodeRange, Encoding, EncodingRole, EnvelopeField, EnvelopeRole, Frame, FrameKind,
    HeaderField, HeaderRole, HeaderType, KindRole, Model, Party, Port, RangeUse, ResultCode,
    ResultRole, RetiredCode, Value,
};
use std::collections::HashSet;

/// `protocol`.
pub(super) fn protocol(model: &Model) -> Value {
    let protocol = &model.protocol;
    described(
        [
            ("id", string(&protocol.id)),
            ("version", string(&protocol.version)),
        ],
        &protocol.title,
        [
            ("about", text(&protocol.about)),
            ("robot", party(&protocol.robot)),
            ("app", party(&protocol.app)),
            ("host", string(&model.transport.host)),
            ("ports", list(&model.transport.ports, port)),
            ("frame", frame(&model.frame)),
            ("json", json(model)),
            (
                "envelope",
                object([
                    ("request", list(&model.envelope.request, envelope_field)),
                    ("response", list(&model.envelope.response, envelope_field)),
                ]),
            ),
            ("calls", calls(model)),
            ("limits", limits(model)),
        ],
    )
}

fn party(party: &Party) -> Value {
    described([], &party.title, [("about", text(&party.about))])
}

fn port(port: &Port) -> Value {
    described(
        [
            ("role", string(port_name(port.role))),
            ("number", number(port.number)),
        ],
        &port.text,
        [],
    )
}

fn frame(frame: &Frame) -> Value {
    let bytes = |bytes: &[u8]| list(bytes, |byte| number(*byte));
    described(
        [
            (
                "byte_order",
                string(match frame.byte_order {
                    ByteOrder::Big => "big",
                    ByteOrder::Little => "little",
                }),
            ),
            ("header_bytes", size(frame.header_len())),
            ("header", list(&frame.header, header_field)),
            ("request_head", bytes(&frame.request_head)),
            ("response_head", bytes(&frame.response_head)),
            ("kinds", list(&frame.kinds, frame_kind)),
            ("encodings", list(&frame.encodings, encoding)),
        ],
        &frame.data,
        [],
    )
}

fn json(model: &Model) -> Value {
    let rules = model.json.iter();
    Value::Object(
        rules
            .map(|(rule, said)| (rule.name().to_owned(), text(said)))
            .collect(),
    )
}

fn header_field(field: &HeaderField) -> Value {
    let ty = match field.ty {
        HeaderType::U8 => "u8".to_owned(),
        HeaderType::U16 => "u16".to_owned(),
        HeaderType::U32 => "u32".to_owned(),
        HeaderType::U64 => "u64".to_owned(),
        HeaderType::Bytes(length) => format!("bytes({length})"),
    };
    let role = |role| {
        string(match role {
            HeaderRole::Head => "head",
            HeaderRole::Kind => "kind",
            HeaderRole::Code => "code",
            HeaderRole::Id => "id",
            HeaderRole::Encoding => "encoding",
            HeaderRole::Status => "status",
            HeaderRole::TotalLength => "total_length",
            HeaderRole::PlainLength => "plain_length",
            HeaderRole::Digest => "digest",
        })
    };
    described(
        [
            ("wire", string(&field.wire)),
            ("name", string(&field.name)),
            ("type", Value::String(ty)),
            ("offset", size(field.offset)),
            ("size", size(field.ty.size())),
            ("role", or_null(field.role, role)),
            ("value", number(field.value)),
        ],
        &field.text,
        [("aliases", aliases(&field.aliases))],
    )
}

fn frame_kind(kind: &FrameKind) -> Value {
    let role = match kind.role {
        KindRole::Stream => "stream",
        KindRole::Command => "command",
        KindRole::Report => "report",
        KindRole::Reserved => "reserved",
    };
    described(
        [
            ("value", number(kind.value)),
            ("name", string(&kind.name)),
            ("role", string(role)),
            ("port", string(port_name(kind.port))),
        ],
        &kind.text,
        [],
    )
}

fn encoding(encoding: &Encoding) -> Value {
    let role = match encoding.role {
        EncodingRole::Plain => "plain",
        EncodingRole::Gzip => "gzip",
    };
    described(
        [
            ("value", number(encoding.value)),
            ("name", string(&encoding.name)),
            ("role", string(role)),
        ],
        &encoding.text,
        [],
    )
}

fn envelope_field(field: &EnvelopeField) -> Value {
    let role = match field.role {
        EnvelopeRole::Time => "time",
        EnvelopeRole::ResultCode => "result_code",
        EnvelopeRole::ResultText => "result_text",
    };
    described(
        [
            ("wire", string(&field.wire)),
            ("name", string(&field.name)),
            ("type", Value::String(type_name(&field.ty))),
            ("optional", Value::Bool(field.optional)),
            ("role", string(role)),
            ("example", scalar(&field.example)),
        ],
        &field.text,
        [("aliases", aliases(&field.aliases))],
    )
}

fn calls(model: &Model) -> Value {
    let calls = model.calls;
    object([
        ("timeout_ms", number(calls.timeout_ms)),
        ("handler_timeout_ms", number(calls.handler_timeout_ms)),
        ("max_age_ms", or_null(calls.max_age_ms, number)),
        (
            "ack",
            object([
                ("timeout_ms", number(calls.ack.timeout_ms)),
                ("retries", number(calls.ack.retries)),
            ]),
        ),
    ])
}

fn limits(model: &Model) -> Value {
    let limits = &model.limits;
    object([
        ("frame_bytes", number(limits.frame_bytes)),
        ("inflated_bytes", number(limits.inflated_bytes)),
        ("json_depth", number(limits.json_depth)),
        ("in_flight", number(limits.in_flight)),
        ("queued_reports", number(limits.queued_reports)),
        ("connections", number(limits.connections)),
    ])
}

/// An entry of `result_codes`.
pub(super) fn result_code(result: &ResultCode) -> Value {
    let role = |role| {
        string(match role {
            ResultRole::Success => "success",
            ResultRole::Protocol => "protocol",
            ResultRole::Timeout => "timeout",
            ResultRole::Invalid => "invalid",
            ResultRole::Expired => "expired",
        })
    };
    described(
        [
            ("code", number(result.code)),
            ("name", string(&result.name)),
            ("role", or_null(result.role, role)),
        ],
        &result.text,
        [("about", text(&result.about))],
    )
}

/// An entry of `retired_codes`.
pub(super) fn retired(retired: &RetiredCode) -> Value {
    described([("code", number(retired.code))], &retired.text, [])
}

/// `ranges`.
pub(super) fn ranges(model: &Model) -> Value {
    let used: HashSet<u16> = model
        .operations
        .iter()
        .filter_map(|operation| operation.code.value)
        .chain(model.retired.iter().map(|retired| retired.code))
        .collect();
    list(&model.ranges, |range| self::range(range, &used))
}

fn range(range: &CodeRange, used: &HashSet<u16>) -> Value {
    let usage = match range.usage {
        RangeUse::PassThrough => "pass_through",
        RangeUse::Commands => "commands",
        RangeUse::Reports => "reports",
        RangeUse::Reserved => "reserved",
        RangeUse::Historic => "historic",
    };
    let counts_up = matches!(range.usage, RangeUse::Commands | RangeUse::Reports);
    let next = counts_up
        .then(|| (range.first..=range.last).find(|code| !used.contains(code)))
        .flatten();
    described(
        [
            ("from", number(range.first)),
            ("to", number(range.last)),
            ("use", string(usage)),
            ("next", or_null(next, number)),
        ],
        &range.text,
        [],
    )
}
