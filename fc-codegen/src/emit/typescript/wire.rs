//! `wire.ts`: the envelopes, the result codes, and the numbers of the protocol beneath its messages.

use super::context::{Context, is_64_bit, type_of};
use super::operations::head;
use super::schemas::type_schema;
use super::source::{Layout, import_types};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::source::Source;
use crate::surface::package::Spelled;
use fc_spec::model::{
    DigestAlgorithm, EnvelopeField, EnvelopeRole, HeaderField, HeaderQuirk, HeaderRole, HeaderType,
    ResultRole,
};

/// What the runtime bounds where no protocol says anything of it.
const OWN_LIMITS: [(&str, u32); 2] = [("inflateRatio", 256), ("jsonValues", 1 << 20)];

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let package = &context.package;
    let mut out = head(
        "消息之下的一层：包头、公共字段、结果码、端口和各种上限。",
        "The layer below the messages: frame header, envelopes, result codes, ports and limits.",
    );
    import_types(&mut out, &["Struct", "Wire"], "../src/runtime.ts");
    let (zh, en) = (
        "除各自的字段外，每个请求和上报都有的字段。",
        "The keys that every request and every report carries beside its own.",
    );
    envelope(
        &mut out,
        context,
        "RequestEnvelope",
        [zh, en],
        &package.request_envelope,
    );
    let (zh, en) = (
        "除各自的字段外，每个响应和确认都有的字段。",
        "The keys that every response and every acknowledgement carries beside its own.",
    );
    envelope(
        &mut out,
        context,
        "ResponseEnvelope",
        [zh, en],
        &package.response_envelope,
    );
    results(&mut out, context);
    out.blank();
    out.line("/** 协议在消息之下的全部数值。All numbers of the protocol beneath its messages. */");
    Layout::Lines(members(wire(context))).write(&mut out, "export const wire: Wire = ", "");
    out.finish()
}

fn envelope(
    out: &mut Source,
    context: &Context<'_>,
    name: &str,
    docs: [&str; 2],
    fields: &[Spelled<'_, EnvelopeField>],
) {
    let mut about = Docs::default();
    docs.into_iter().for_each(|text| about.paragraph(text));
    out.blank();
    out.docs(&about);
    if fields.is_empty() {
        out.line(format!("export interface {name} {{}}"));
    } else {
        interface(out, context, name, fields);
    }
    let schemas = fields.iter().map(|field| {
        let mut schema = vec![
            ("key", Layout::text(&field.wire)),
            ("type", type_schema(context, &field.ty)),
        ];
        schema.extend(field.optional.then(|| ("optional", Layout::word(true))));
        (field.name.to_string(), Layout::Object(members(schema)))
    });
    out.blank();
    out.docs(&about);
    let schema = vec![
        ("is", Layout::text("struct")),
        ("name", Layout::text(name)),
        ("fields", Layout::Lines(schemas.collect())),
    ];
    Layout::Object(members(schema)).write(
        out,
        &format!("export const {name}: Struct<{name}> = "),
        "",
    );
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
            out.docs(&Docs::of(&field.text));
            out.line(if field.optional {
                format!("{}?: {ty} | undefined", field.name)
            } else {
                format!("{}: {ty}", field.name)
            });
        }
    });
}

fn results(out: &mut Source, context: &Context<'_>) {
    let results = &context.package.results;
    let mut docs = Docs::default();
    docs.paragraph("结果码。只依据它判断成败，不依据旁边的文字。");
    docs.paragraph("Result codes. Go by them and never by the text beside them.");
    if let Some(page) = context.page("reference/results.md") {
        docs.paragraph(page);
    }
    out.blank();
    out.docs(&docs);
    let codes = results.iter().map(|result| result.code.to_string());
    let codes: Vec<String> = codes.chain(["(number & {})".to_owned()]).collect();
    super::messages::union(out, "ResultCode", &codes);
    out.blank();
    out.line("/** {@link ResultCode}：各个值。Its values. */");
    out.enclose("export const ResultCode = {", "} as const", |out| {
        for result in results {
            let mut docs = Docs::of(&result.text);
            docs.text(&result.about);
            out.blank();
            out.docs(&docs);
            out.line(format!("{}: {},", result.name, result.code));
        }
    });
}

fn wire(context: &Context<'_>) -> Vec<(&'static str, Layout)> {
    let model = context.model();
    let (transport, frame) = (&model.transport, &model.frame);
    let (calls, limits) = (&model.calls, &model.limits);
    let number = |value: &dyn ToString| Layout::Number(value.to_string());
    let object = |of: Vec<(&str, Layout)>| Layout::Object(members(of));
    let lines = |of: Vec<(&str, Layout)>| Layout::Lines(members(of));
    let bytes = |bytes: &[u8]| {
        Layout::List(
            bytes
                .iter()
                .map(|byte| Layout::Number(format!("0x{byte:02x}")))
                .collect(),
        )
    };
    let kinds = frame.kinds.each().into_iter();
    let kinds = kinds.map(|kind| {
        object(vec![
            ("value", number(&kind.value)),
            ("role", Layout::text(kind.role.name())),
        ])
    });
    let encodings = frame.encodings.iter();
    let encodings = encodings.map(|it| {
        object(vec![
            ("value", number(&it.value)),
            ("role", Layout::text(it.role.name())),
        ])
    });
    let results = ResultRole::ALL.iter().filter_map(|role| {
        let result = context
            .package
            .results
            .iter()
            .find(|result| result.role == Some(*role))?;
        let code = Layout::word(format!("ResultCode.{}", result.name));
        Some((
            role.name(),
            object(vec![
                ("code", code),
                ("text", Layout::text(&result.text.zh)),
            ]),
        ))
    });
    let envelope = |name: &str, fields: &[Spelled<'_, EnvelopeField>]| {
        let roles = fields.iter().map(|field| {
            let role = match field.role {
                EnvelopeRole::Time => "time",
                EnvelopeRole::ResultCode => "code",
                EnvelopeRole::ResultText => "text",
            };
            (role, Layout::text(&field.name))
        });
        object(
            [("struct", Layout::word(name))]
                .into_iter()
                .chain(roles)
                .collect(),
        )
    };
    let mut bounds = vec![
        ("frameBytes", number(&limits.frame_bytes)),
        ("inflatedBytes", number(&limits.inflated_bytes)),
        ("jsonDepth", number(&limits.json_depth)),
        ("inFlight", number(&limits.in_flight)),
        ("queuedReports", number(&limits.queued_reports)),
        ("connections", number(&limits.connections)),
    ];
    bounds.extend(OWN_LIMITS.map(|(name, value)| (name, number(&value))));
    vec![
        ("name", Layout::text(&model.protocol.id)),
        ("host", Layout::text(&transport.host)),
        ("commandPort", number(&transport.ports.command.number)),
        ("dataPort", number(&transport.ports.data.number)),
        (
            "frame",
            lines(vec![
                ("byteOrder", Layout::text(frame.byte_order.name())),
                ("headerLength", number(&frame.header_len())),
                (
                    "header",
                    Layout::List(frame.header.iter().map(header).collect()),
                ),
                ("requestHead", bytes(&frame.request_head)),
                ("responseHead", bytes(&frame.response_head)),
                ("kinds", Layout::List(kinds.collect())),
                ("encodings", Layout::List(encodings.collect())),
            ]),
        ),
        (
            "envelope",
            lines(vec![
                (
                    "request",
                    envelope("RequestEnvelope", &context.package.request_envelope),
                ),
                (
                    "response",
                    envelope("ResponseEnvelope", &context.package.response_envelope),
                ),
            ]),
        ),
        ("results", lines(results.collect())),
        (
            "defaults",
            lines(vec![
                ("callTimeout", number(&calls.timeout_ms)),
                ("handlerTimeout", number(&calls.handler_timeout_ms)),
                (
                    "maxAge",
                    calls
                        .max_age_ms
                        .map_or(Layout::word("null"), |age| number(&age)),
                ),
                (
                    "ack",
                    object(vec![
                        ("timeout", number(&calls.ack.timeout_ms)),
                        ("retries", number(&calls.ack.retries)),
                    ]),
                ),
                ("limits", lines(bounds)),
            ]),
        ),
    ]
}

fn header(field: &HeaderField) -> Layout {
    let or_null = |word: Option<&str>| word.map_or(Layout::word("null"), Layout::text);
    let ty = if matches!(field.ty, HeaderType::Bytes(_)) {
        "bytes"
    } else {
        "uint"
    };
    Layout::Object(members(vec![
        ("offset", Layout::Number(field.offset.to_string())),
        ("size", Layout::Number(field.ty.size().to_string())),
        ("type", Layout::text(ty)),
        ("role", or_null(field.role.map(HeaderRole::name))),
        (
            "algorithm",
            or_null(field.digest().map(DigestAlgorithm::name)),
        ),
        ("value", Layout::Number(field.value.to_string())),
        (
            "zeroWhenPlain",
            Layout::word(field.has_quirk(HeaderQuirk::ZeroWhenPlain)),
        ),
    ]))
}

fn members(members: Vec<(&str, Layout)>) -> Vec<(String, Layout)> {
    members
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}
