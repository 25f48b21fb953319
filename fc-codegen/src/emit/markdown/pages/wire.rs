//! Transport, frame, envelope, timeouts and limits.

use super::shared::{AnswerView, Desk, PortView};
use crate::emit::markdown::bytes::{FrameView, frame_view, letter, ruler, spaced};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::rows::{Row, odd_name, scalar};
use crate::emit::markdown::words::Word as _;
use crate::emit::packed;
use crate::emit::vectors::json_cases::{JsonCase, json_cases};
use crate::sample::{Profile, SAMPLE_ID};
use fc_spec::model::{
    Answer, CallDefaults, Direction, EncodingRole, EnvelopeField, HeaderField, HeaderQuirk,
    HeaderRole, Kind, Limits, Subject,
};
use serde::Serialize;

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
    /// The name of the digest.
    digest: Option<&'static str>,
    compresses: bool,
    has_plain_length: bool,
    envelopes: Vec<EnvelopeView>,
    has_result: bool,
    example: Option<ExampleView>,
    calls: CallDefaults,
    limits: Limits,
    transport_answers: Vec<AnswerView>,
    frame_answers: Vec<AnswerView>,
    envelope_answers: Vec<AnswerView>,
    results: String,
}

#[derive(Debug, Serialize)]
struct HeaderView {
    anchor: String,
    letter: String,
    offset: usize,
    size: usize,
    wire: String,
    /// The name in code, if it does not follow from the wire name.
    code_name: Option<String>,
    ty: String,
    role: Option<&'static str>,
    /// The fixed value, for a field that no role fills.
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

/// An example of reading a body.
#[derive(Debug, Serialize)]
struct JsonExampleView {
    ty: &'static str,
    /// The body as text, or as bytes if a page cannot show it; empty for no body.
    body: String,
    /// The body in canonical form, or the name of the error.
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

/// The request of one command, plain and compressed.
#[derive(Debug, Serialize)]
struct ExampleView {
    title: String,
    href: String,
    plain: FrameView,
    gzip: Option<FrameView>,
}

pub(in crate::emit::markdown) fn wire(desk: Desk<'_, '_>) -> WireView {
    let model = desk.book.model;
    let lang = desk.lang;
    let layout = &model.frame;
    let kinds = layout.kinds.each().into_iter().map(|kind| KindView {
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
    let is_of_envelope = |answer: &&Answer| matches!(answer.subject, Subject::Envelope(_));
    WireView {
        host: model.transport.host.clone(),
        ports: desk.ports(),
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
        digest: (layout.field(HeaderRole::Digest)).and_then(|field| Some(field.digest()?.term())),
        compresses: layout.encoding(EncodingRole::Gzip).is_some(),
        has_plain_length: layout.field(HeaderRole::PlainLength).is_some(),
        has_result: model.envelope.result_code().is_some(),
        envelopes: Direction::ALL
            .iter()
            .map(|direction| envelope(desk, *direction))
            .collect(),
        example: example(desk),
        calls: model.calls,
        limits: model.limits.clone(),
        transport_answers: desk.answers_to(&Subject::Transport),
        frame_answers: desk.answers(frame_answers(desk)),
        envelope_answers: desk.answers(model.answers.iter().filter(is_of_envelope)),
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
        value: field.is_sent_as_value().then_some(field.value),
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
        rows: desk.rows().envelope(direction),
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
    let is_example = |kind: Kind, code: Option<u16>| kind == Kind::Command && code.is_some();
    let layout = &desk.book.model.frame;
    let mut operations = desk.book.model.operations.iter();
    let operation =
        operations.find(|operation| is_example(operation.kind(), operation.code.value))?;
    let direction = Direction::Response;
    let data = desk.book.samples.data(operation, direction);
    let reflector = &desk.book.reflector;
    let id = reflector.id(operation, direction, SAMPLE_ID)?;
    let view = |encoding| {
        let frame = packed::frame(reflector, id, encoding, &data);
        frame_view(reflector, &frame, desk.lang)
    };
    Some(ExampleView {
        title: desk.lang.text(&operation.title).to_owned(),
        href: desk.link(Page::Operation(operation), Anchor::none()),
        plain: view(EncodingRole::Plain)?,
        gzip: layout
            .encoding(EncodingRole::Gzip)
            .and_then(|_| view(EncodingRole::Gzip)),
    })
}

/// Returns the answers to the frame and its header fields, for both names of a field.
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
