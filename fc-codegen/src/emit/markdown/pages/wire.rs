//! Transport, frame, envelope, timeouts and limits.

use super::shared::{Desk, list};
use crate::emit::markdown::bytes::{frame_view, letter, ruler, spaced};
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::rows::{odd_name, scalar};
use crate::emit::markdown::words::Word as _;
use crate::emit::packed;
use crate::emit::vectors::json_cases::{JsonCase, json_cases};
use crate::sample::{Profile, SAMPLE_ID};
use fc_spec::model::{
    Answer, Direction, EncodingRole, EnvelopeField, HeaderField, HeaderQuirk, HeaderRole, Kind,
    Subject,
};
use minijinja::value::Serde;
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn wire(desk: Desk<'_, '_>) -> Value {
    let model = desk.book.model;
    let lang = desk.lang;
    let layout = &model.frame;
    let kinds = layout.kinds.each().into_iter().map(|kind| {
        context! {
            value => format!("0x{:02X}", kind.value),
            name => &kind.name,
            role => kind.role.word(lang),
            port => kind.port.word(lang),
            text => lang.text(&kind.text),
        }
    });
    let encodings = layout.encodings.iter().map(|encoding| {
        context! {
            value => encoding.value,
            name => &encoding.name,
            role => encoding.role.word(lang),
            text => lang.text(&encoding.text),
        }
    });
    let fields = layout.header.iter().enumerate();
    let is_of_envelope = |answer: &&Answer| matches!(answer.subject, Subject::Envelope(_));
    context! {
        host => &model.transport.host,
        ports => desk.ports(),
        byte_order => layout.byte_order.word(lang),
        header_len => layout.header_len(),
        ruler => ruler(layout),
        fields => list(fields.map(|(index, field)| header(desk, index, field))),
        request_head => spaced(&layout.request_head),
        response_head => spaced(&layout.response_head),
        kinds => list(kinds),
        encodings => list(encodings),
        data => lang.text(&layout.data),
        json_rules => list(model.json.iter().map(|(rule, text)| context! {
                title => rule.word(lang),
                text => lang.text(text),
            })),
        json_examples => json_examples(),
        digest => (layout.field(HeaderRole::Digest)).and_then(|field| Some(field.digest()?.term())),
        compresses => layout.encoding(EncodingRole::Gzip).is_some(),
        has_plain_length => layout.field(HeaderRole::PlainLength).is_some(),
        has_result => model.envelope.result_code().is_some(),
        envelopes => list(Direction::ALL.iter().map(|direction| envelope(desk, *direction))),
        example => example(desk),
        calls => Serde(model.calls),
        limits => Serde(&model.limits),
        transport_answers => desk.answers_to(&Subject::Transport),
        frame_answers => desk.answers(frame_answers(desk)),
        envelope_answers => desk.answers(model.answers.iter().filter(is_of_envelope)),
        results => desk.link(Page::Results, Anchor::none()),
    }
}

fn json_examples() -> Vec<Value> {
    let shown = json_cases().into_iter().filter(|case| case.shown);
    let view = |case: JsonCase| {
        context! {
            ty => case.ty,
            body => match std::str::from_utf8(&case.body) {
                Ok(text) if !text.starts_with('\u{FEFF}') => text.to_owned(),
                _ => spaced(&case.body),
            },
            refused => case.outcome.is_err(),
            outcome => case.outcome.unwrap_or_else(str::to_owned),
        }
    };
    shown.map(view).collect()
}

fn header(desk: Desk<'_, '_>, index: usize, field: &HeaderField) -> Value {
    context! {
        anchor => Anchor::of("header", &field.name).id(),
        letter => letter(index),
        offset => field.offset,
        size => field.ty.size(),
        wire => &field.wire,
        code_name => odd_name(&field.wire, &field.name),
        ty => field.ty.to_string(),
        role => field.role.map(|role| role.word(desk.lang)),
        value => field.is_sent_as_value().then_some(field.value),
        zero_when_plain => field.has_quirk(HeaderQuirk::ZeroWhenPlain),
        text => desk.lang.text(&field.text),
        aliases => desk.lang.aliases(&field.aliases),
    }
}

fn envelope(desk: Desk<'_, '_>, direction: Direction) -> Value {
    let role = |field: &EnvelopeField| {
        context! {
            key => &field.wire,
            role => field.role.word(desk.lang),
            example => scalar(&field.example),
            aliases => desk.lang.aliases(&field.aliases),
        }
    };
    let none = fc_spec::model::Value::Object(Vec::new());
    let roles = desk.book.samples.envelope(direction);
    context! {
        side => direction.name(),
        rows => Serde(desk.envelope_rows(direction)),
        roles => list(roles.iter().map(role)),
        json => desk
            .book
            .samples
            .enveloped(direction, none, Profile::Example)
            .pretty(),
    }
}

fn example(desk: Desk<'_, '_>) -> Option<Value> {
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
    Some(context! {
        title => desk.lang.text(&operation.title),
        href => desk.link(Page::Operation(operation), Anchor::none()),
        plain => view(EncodingRole::Plain)?,
        gzip => layout
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
