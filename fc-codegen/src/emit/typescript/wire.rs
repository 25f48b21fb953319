//! `wire.ts`: the envelopes, the result codes, and the numbers below the messages.

use super::context::{Context, is_64_bit, type_of};
use super::layout::{Layout, Members};
use super::operations::ack_policy;
use super::schemas::type_schema;
use super::source::{head, named, property};
use crate::package::about::{self, Envelope};
use crate::package::docs::Docs;
use crate::package::items::Spelled;
use crate::package::language::Case;
use crate::package::source::Source;
use crate::package::wire::WireFacts;
use fc_spec::model::{
    DigestAlgorithm, EnvelopeField, EnvelopeRole, HeaderField, HeaderQuirk, HeaderRole, HeaderType,
};

/// Limits of the runtime that the spec does not set.
const OWN_LIMITS: [(&str, u32); 2] = [("inflateRatio", 256), ("jsonValues", 1 << 20)];

pub fn file(context: &Context<'_>) -> String {
    let mut out = head(context, about::WIRE);
    named(
        &mut out,
        "import type",
        ["Struct", "Wire"],
        "../src/runtime.ts",
    );
    for envelope in about::envelopes(context) {
        self::envelope(&mut out, context, &envelope);
    }
    results(&mut out, context);
    out.template("wire", &[]);
    wire(context).write(&mut out, "export const wire: Wire = ", "");
    out.finish()
}

fn envelope(out: &mut Source, context: &Context<'_>, envelope: &Envelope<'_, '_>) {
    let (name, fields) = (envelope.name, envelope.fields);
    let docs = &Docs::said(envelope.about);
    out.documented(docs);
    if fields.is_empty() {
        out.line(format!("export interface {name} {{}}"));
    } else {
        interface(out, context, name, fields);
    }
    let schemas = fields.iter().map(|field| {
        let schema = Members::default()
            .with("key", Layout::text(&field.wire))
            .with("type", type_schema(context, &field.ty))
            .with("optional", Layout::flag(field.optional));
        (&*field.name, schema.object())
    });
    let members = [
        ("is", Layout::text("struct")),
        ("name", Layout::text(name)),
        ("fields", Layout::lines(schemas)),
    ];
    let head = format!("export const {name}: Struct<{name}> = ");
    out.documented(docs);
    Layout::object(members).write(out, &head, "");
}

fn interface(
    out: &mut Source,
    context: &Context<'_>,
    name: &str,
    fields: &[Spelled<'_, EnvelopeField>],
) {
    out.block(format!("export interface {name}"), |out| {
        for field in fields {
            let ty = type_of(context, &field.ty, is_64_bit(&field.ty));
            out.blank();
            out.docs(&Docs::titled(&field.text));
            out.line(property(&field.name, &ty, field.optional));
        }
    });
}

fn results(out: &mut Source, context: &Context<'_>) {
    let results = &context.package.results;
    let docs = about::results(context);
    out.blank();
    out.docs(&docs);
    let codes = results.iter().map(|result| result.code.to_string());
    let codes: Vec<String> = codes.chain(["(number & {})".to_owned()]).collect();
    super::messages::union(out, "ResultCode", &codes);
    out.blank();
    out.template("values", &[("name", "ResultCode")]);
    out.enclose("export const ResultCode = {", "} as const", |out| {
        for result in results {
            out.documented(&about::result(result.of));
            out.line(format!("{}: {},", result.name, result.code));
        }
    });
}

fn wire(context: &Context<'_>) -> Layout {
    let model = context.model();
    let (ports, calls) = (&model.transport.ports, &model.calls);
    let wire = WireFacts::build(context);
    let results = wire.results.iter().filter_map(|fact| {
        let result = fact.result?;
        let code = Layout::word(format!("ResultCode.{}", result.name));
        let result = Layout::object([("code", code), ("text", Layout::text(&result.text.zh))]);
        Some((fact.role, result))
    });
    let defaults = [
        ("callTimeout", Layout::number(calls.timeout_ms)),
        ("handlerTimeout", Layout::number(calls.handler_timeout_ms)),
        (
            "maxAge",
            calls
                .max_age_ms
                .map_or_else(|| Layout::word("null"), Layout::number),
        ),
        ("ack", ack_policy(calls.ack)),
        ("limits", limits(&wire)),
    ];
    let envelopes = [
        (
            "request",
            roles("RequestEnvelope", &context.package.request_envelope),
        ),
        (
            "response",
            roles("ResponseEnvelope", &context.package.response_envelope),
        ),
    ];
    Layout::lines([
        ("name", Layout::text(&model.protocol.id)),
        ("host", Layout::text(&model.transport.host)),
        ("commandPort", Layout::number(ports.command.number)),
        ("dataPort", Layout::number(ports.data.number)),
        ("frame", frame(context)),
        ("envelope", Layout::lines(envelopes)),
        ("results", Layout::lines(results)),
        ("defaults", Layout::lines(defaults)),
    ])
}

fn limits(wire: &WireFacts<'_, '_>) -> Layout {
    let limits = wire.limits.iter();
    let limits = limits.map(|(name, value)| (Case::Camel.apply(name), *value));
    let own = OWN_LIMITS.map(|(name, value)| (name.into(), value));
    Layout::lines(
        limits
            .chain(own)
            .map(|(name, value)| (name, Layout::number(value))),
    )
}

/// Returns an envelope, with the role of each of its fields.
fn roles(name: &str, fields: &[Spelled<'_, EnvelopeField>]) -> Layout {
    let roles = fields.iter().map(|field| {
        let role = match field.role {
            EnvelopeRole::Time => "time",
            EnvelopeRole::ResultCode => "code",
            EnvelopeRole::ResultText => "text",
        };
        (role, Layout::text(&field.name))
    });
    Layout::object([("struct", Layout::word(name))].into_iter().chain(roles))
}

fn frame(context: &Context<'_>) -> Layout {
    let frame = &context.model().frame;
    let bytes = |bytes: &[u8]| {
        Layout::list(
            bytes
                .iter()
                .map(|byte| Layout::Number(format!("0x{byte:02x}"))),
        )
    };
    let numbered = |value: u8, role: &str| {
        Layout::object([
            ("value", Layout::number(value)),
            ("role", Layout::text(role)),
        ])
    };
    let headers = frame.header.iter().map(|it| Layout::object(header(it)));
    let kinds = frame.kinds.each().into_iter();
    let encodings = frame.encodings.iter();
    Layout::lines([
        ("byteOrder", Layout::text(frame.byte_order.name())),
        (
            "headerLength",
            Layout::Number(frame.header_len().to_string()),
        ),
        ("header", Layout::list(headers)),
        ("requestHead", bytes(&frame.request_head)),
        ("responseHead", bytes(&frame.response_head)),
        (
            "kinds",
            Layout::list(kinds.map(|it| numbered(it.value, it.role.name()))),
        ),
        (
            "encodings",
            Layout::list(encodings.map(|it| numbered(it.value, it.role.name()))),
        ),
    ])
}

/// Returns the numbers of a header field.
pub fn header(field: &HeaderField) -> [(&'static str, Layout); 7] {
    let ty = match field.ty {
        HeaderType::Bytes(_) => "bytes",
        _ => "uint",
    };
    let zero_when_plain = field.has_quirk(HeaderQuirk::ZeroWhenPlain);
    [
        ("offset", Layout::Number(field.offset.to_string())),
        ("size", Layout::Number(field.ty.size().to_string())),
        ("type", Layout::text(ty)),
        (
            "role",
            Layout::text_or_null(field.role.map(HeaderRole::name)),
        ),
        (
            "algorithm",
            Layout::text_or_null(field.digest().map(DigestAlgorithm::name)),
        ),
        ("value", Layout::number(field.value)),
        ("zeroWhenPlain", Layout::word(zero_when_plain.to_string())),
    ]
}
