//! Transport, frame, envelope, timeouts and limits.

use super::shared::{AnswerView, Desk};
use crate::emit::markdown::bytes::{FrameView, frame_view, letter, ruler, spaced};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::rows::{Row, odd_name, scalar};
use crate::emit::markdown::words::Word as _;
use crate::sample::frame::frame;
use crate::sample::{FrameInput, JsonCase, Profile, json_cases};
use fc_spec::model::{
    Answer, CallDefaults, Direction, EncodingRole, EnvelopeField, HeaderField, HeaderQuirk,
    HeaderRole, Kind, Limits, Subject,
};
use serde::Serialize;

/// All that its template shows.
#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct WireView {
    host: String,
    ports: Vec<PortView>,
    byte_order: &'static str,
    header_len: usize,
    ruler: String,
    fields: Vec<HeaderView>,
    request_head: String,
    response_head: String,
    kinds: Vec<KindView>,
    encodings: Vec<EncodingView>,
    data: String,
    json_rules: Vec<JsonRuleView>,
    json_examples: Vec<JsonExampleView>,
    envelopes: Vec<EnvelopeView>,
    example: Option<ExampleView>,
    calls: CallsView,
    limits: LimitsView,
    transport_answers: Vec<AnswerView>,
    frame_answers: Vec<AnswerView>,
    envelope_answers: Vec<AnswerView>,
    results: String,
}

#[derive(Debug, Serialize)]
struct PortView {
    number: u16,
    role: &'static str,
    text: String,
}

#[derive(Debug, Serialize)]
struct HeaderView {
    anchor: String,
    letter: String,
    offset: usize,
    size: usize,
    wire: String,
    /// Name in code, where the wire's spelling does not give it.
    code_name: Option<String>,
    ty: String,
    role: Option<&'static str>,
    /// What is sent, for a field that only travels.
    value: Option<u64>,
    zero_when_plain: bool,
    text: String,
    aliases: Vec<String>,
}

#[derive(Debug, Serialize)]
struct KindView {
    value: String,
    name: String,
    role: &'static str,
    port: &'static str,
    text: String,
}

#[derive(Debug, Serialize)]
struct EncodingView {
    value: u8,
    name: String,
    role: &'static str,
    text: String,
}

#[derive(Debug, Serialize)]
struct JsonRuleView {
    title: &'static str,
    text: String,
}

/// What becomes of a body.
#[derive(Debug, Serialize)]
struct JsonExampleView {
    ty: &'static str,
    /// As text, or as bytes where it is none that a page could show; empty if it has none.
    body: String,
    /// The body written again, or the name of the error.
    outcome: String,
    refused: bool,
}

#[derive(Debug, Serialize)]
struct EnvelopeView {
    /// `request`, `response`.
    side: &'static str,
    rows: Vec<Row>,
    roles: Vec<RoleView>,
    json: String,
}

#[derive(Debug, Serialize)]
struct RoleView {
    key: String,
    role: &'static str,
    example: String,
    aliases: Vec<String>,
}

/// One command's request as it travels, plain and compressed.
#[derive(Debug, Serialize)]
struct ExampleView {
    title: String,
    href: String,
    plain: FrameView,
    gzip: FrameView,
}

#[derive(Debug, Serialize)]
struct CallsView {
    timeout_ms: u32,
    handler_timeout_ms: u32,
    max_age_ms: Option<u32>,
    ack_timeout_ms: u32,
    ack_retries: u32,
}

#[derive(Debug, Serialize)]
struct LimitsView {
    frame_bytes: u32,
    inflated_bytes: u32,
    json_depth: u32,
    in_flight: u32,
    queued_reports: u32,
    connections: u32,
}

pub(in crate::emit::markdown) fn wire(desk: Desk<'_, '_>) -> WireView {
    let model = desk.book.model;
    let lang = desk.lang;
    let layout = &model.frame;
    let ports = model.transport.ports.iter().map(|port| PortView {
        number: port.number,
        role: port.role.word(lang),
        text: lang.text(&port.text).to_owned(),
    });
    let kinds = layout.kinds.iter().map(|kind| KindView {
        value: format!("0x{:02X}", kind.value),
        name: kind.name.clone(),
        role: kind.role.word(lang),
        port: kind.port.word(lang),
        text: lang.text(&kind.text).to_owned(),
    });
    let encodings = layout.encodings.iter().map(|encoding| EncodingView {
        value: encoding.value,
        name: encoding.name.clone(),
        role: encoding.role.word(lang),
        text: lang.text(&encoding.text).to_owned(),
    });
    let fields = layout.header.iter().enumerate();
    WireView {
        host: model.transport.host.clone(),
        ports: ports.collect(),
        byte_order: layout.byte_order.word(lang),
        header_len: layout.header_len(),
        ruler: ruler(layout),
        fields: fields
            .map(|(index, field)| header(desk, index, field))
            .collect(),
        request_head: spaced(&layout.request_head),
        response_head: spaced(&layout.response_head),
        kinds: kinds.collect(),
        encodings: encodings.collect(),
        data: lang.text(&layout.data).to_owned(),
        json_rules: model
            .json
            .iter()
            .map(|(rule, text)| JsonRuleView {
                title: rule.word(lang),
                text: lang.text(text).to_owned(),
            })
            .collect(),
        json_examples: json_examples(),
        envelopes: Direction::ALL
            .iter()
            .map(|direction| envelope(desk, *direction))
            .collect(),
        example: example(desk),
        calls: calls(model.calls),
        limits: limits(&model.limits),
        transport_answers: desk.answers(desk.book.answers_to(&Subject::Transport)),
        frame_answers: desk.answers(&frame_answers(desk)),
        envelope_answers: desk.answers(&envelope_answers(desk)),
        results: desk.link(Page::Results, Anchor::none()),
    }
}

fn json_examples() -> Vec<JsonExampleView> {
    let shown = json_cases().into_iter().filter(|case| case.shown);
    let view = |case: JsonCase| JsonExampleView {
        ty: case.ty,
        body: match std::str::from_utf8(&case.body) {
            Ok(text) if !text.starts_with('\u{FEFF}') => text.to_owned(),
            _ => spaced(&case.body),
        },
        refused: case.outcome.is_err(),
        outcome: case.outcome.unwrap_or_else(str::to_owned),
    };
    shown.map(view).collect()
}

fn header(desk: Desk<'_, '_>, index: usize, field: &HeaderField) -> HeaderView {
    HeaderView {
        anchor: Anchor::of("header", &field.name).id(),
        letter: letter(index),
        offset: field.offset,
        size: field.ty.size(),
        wire: field.wire.clone(),
        code_name: odd_name(&field.wire, &field.name),
        ty: field.ty.to_string(),
        role: field.role.map(|role| role.word(desk.lang)),
        value: matches!(field.role, None | Some(HeaderRole::Status)).then_some(field.value),
        zero_when_plain: field.has_quirk(HeaderQuirk::ZeroWhenPlain),
        text: desk.lang.text(&field.text).to_owned(),
        aliases: desk.lang.aliases(&field.aliases),
    }
}

fn envelope(desk: Desk<'_, '_>, direction: Direction) -> EnvelopeView {
    let role = |field: &EnvelopeField| RoleView {
        key: field.wire.clone(),
        role: field.role.word(desk.lang),
        example: scalar(&field.example),
        aliases: desk.lang.aliases(&field.aliases),
    };
    let none = fc_spec::model::Value::Object(Vec::new());
    EnvelopeView {
        side: direction.name(),
        rows: desk.rows().message(direction, None),
        roles: desk
            .book
            .samples
            .envelope(direction)
            .iter()
            .map(role)
            .collect(),
        json: desk
            .book
            .samples
            .enveloped(direction, none, Profile::Example)
            .pretty(),
    }
}

fn example(desk: Desk<'_, '_>) -> Option<ExampleView> {
    let layout = &desk.book.model.frame;
    let is_example = |kind: Kind, code: Option<u16>| kind == Kind::Command && code.is_some();
    let mut operations = desk.book.model.operations.iter();
    let operation =
        operations.find(|operation| is_example(operation.kind, operation.code.value))?;
    let direction = Direction::Response;
    let data = desk
        .book
        .samples
        .message(operation, direction, Profile::Example)
        .to_string();
    let view = |encoding| {
        let input = FrameInput::of(layout, operation, direction, encoding)?;
        Some(frame_view(
            layout,
            &frame(layout, input, data.as_bytes()),
            desk.lang,
        ))
    };
    Some(ExampleView {
        title: desk.lang.text(&operation.title).to_owned(),
        href: desk.link(Page::Operation(operation), Anchor::none()),
        plain: view(EncodingRole::Plain)?,
        gzip: view(EncodingRole::Gzip)?,
    })
}

fn calls(calls: CallDefaults) -> CallsView {
    CallsView {
        timeout_ms: calls.timeout_ms,
        handler_timeout_ms: calls.handler_timeout_ms,
        max_age_ms: calls.max_age_ms,
        ack_timeout_ms: calls.ack.timeout_ms,
        ack_retries: calls.ack.retries,
    }
}

fn limits(limits: &Limits) -> LimitsView {
    LimitsView {
        frame_bytes: limits.frame_bytes,
        inflated_bytes: limits.inflated_bytes,
        json_depth: limits.json_depth,
        in_flight: limits.in_flight,
        queued_reports: limits.queued_reports,
        connections: limits.connections,
    }
}

/// Answers at the frame and at its header fields, under either of a field's names.
fn frame_answers<'m>(desk: Desk<'_, 'm>) -> Vec<&'m Answer> {
    let mut answers = desk.book.answers_to(&Subject::Frame(None)).to_vec();
    for field in &desk.book.model.frame.header {
        answers.extend(
            desk.book
                .answers_to(&Subject::Frame(Some(field.name.clone()))),
        );
        if field.wire != field.name {
            answers.extend(
                desk.book
                    .answers_to(&Subject::Frame(Some(field.wire.clone()))),
            );
        }
    }
    answers
}

/// Answers at the envelope and at its keys, each once.
fn envelope_answers<'m>(desk: Desk<'_, 'm>) -> Vec<&'m Answer> {
    let mut answers = Vec::new();
    for answer in &desk.book.model.answers {
        if matches!(answer.subject, Subject::Envelope(_)) {
            answers.push(answer);
        }
    }
    answers
}
