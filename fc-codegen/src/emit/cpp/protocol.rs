//! The protocol as a value: header, envelopes, result codes, ports, limits and operations.

use super::groups::NamedGroup;
use super::layout::{Includes, integer, literal};
use super::messages::effect_name;
use super::types::namespace;
use crate::emit::stub::about;
use crate::emit::stub::context::{Context, page_of};
use crate::emit::stub::docs::Docs;
use crate::emit::stub::facts;
use crate::emit::stub::source::Source;
use crate::surface::package::Spelled;
use fc_spec::model::{
    ByteOrder, Cadence, DigestAlgorithm, Direction, EncodingRole, EnvelopeField, EnvelopeRole,
    Exchange, HeaderField, HeaderQuirk, HeaderRole, Kind, Operation, ResultRole, Type,
};

/// The header.
pub fn header(context: &Context<'_>) -> String {
    let space = &namespace(context);
    let mut out = Source::cpp();
    out.line("#pragma once");
    out.blank();
    let mut includes = Includes::default();
    includes.standard("cstdint");
    includes.standard("string_view");
    includes.own("fc_runtime/call.hpp");
    includes.own("fc_runtime/protocol.hpp");
    includes.lines(&mut out);
    out.blank();
    out.namespace(space, |out| {
        out.docs(&about::protocol(context.model()));
        out.line("[[nodiscard]] const fc_runtime::Protocol& protocol();");
        out.blank();
        results(out, context);
        streams(out, context);
    });
    out.finish()
}

fn results(out: &mut Source, context: &Context<'_>) {
    out.docs(&about::results(context));
    out.enclose("enum class ResultCode : std::int64_t {", "};", |out| {
        for result in &context.package.results {
            out.docs(&about::result(result.of));
            out.line(format!(
                "{} = {},",
                result.name,
                integer(result.code.into())
            ));
        }
    });
    out.blank();
    out.line("/// 随结果码发送的文字。The text sent with the code.");
    out.line("[[nodiscard]] std::string_view text(ResultCode code) noexcept;");
    out.line("/// 以此结果码拒绝。A refusal with this code.");
    out.line("[[nodiscard]] fc_runtime::Refusal refusal(ResultCode code);");
}

/// The codes of the streams, if there are any: their bytes have no type to hold the code.
fn streams(out: &mut Source, context: &Context<'_>) {
    if context.package.streams.is_empty() {
        return;
    }
    out.blank();
    let what = ["数据流的功能码。", "Codes of streams."];
    out.docs(&Docs::said(&what));
    out.enclose("enum class StreamCode : std::uint16_t {", "};", |out| {
        for stream in &context.package.streams {
            let mut docs = facts::operation_docs(stream);
            docs.paragraph(facts::operation_facts(context.style, stream));
            docs.paragraph(context.links(&stream.location, &page_of(stream)));
            out.docs(&docs);
            out.line(format!("{} = {},", stream.name, stream.code.spelling));
        }
    });
}

/// The source.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let space = &namespace(context);
    let mut out = Source::cpp();
    out.line(format!("#include \"{space}/protocol.hpp\""));
    out.blank();
    out.line("#include <limits>");
    out.blank();
    out.line(format!("#include \"{space}/messages.hpp\""));
    out.blank();
    out.line("// Tables, a line for each entry.");
    out.line("// clang-format off");
    out.blank();
    out.namespace(space, |out| {
        out.line("namespace {");
        out.blank();
        out.line("using namespace std::string_view_literals;");
        out.blank();
        out.enclose("fc_runtime::Protocol make_protocol() {", "}", |out| {
            out.line("fc_runtime::Protocol protocol;");
            addresses(out, context);
            header_layout(out, context);
            frames(out, context);
            envelope(out, "request", &context.package.request_envelope);
            envelope(out, "response", &context.package.response_envelope);
            defaults(out, context);
            for group in groups {
                out.line(format!("{}(protocol.operations);", group.function("add")));
            }
            out.line("return protocol;");
        });
        out.blank();
        out.line("}  // namespace");
        out.blank();
        out.enclose("const fc_runtime::Protocol& protocol() {", "}", |out| {
            out.line("static const fc_runtime::Protocol made = make_protocol();");
            out.line("return made;");
        });
        out.blank();
        out.enclose(
            "std::string_view text(ResultCode code) noexcept {",
            "}",
            |out| {
                out.enclose("switch (code) {", "}", |out| {
                    for result in &context.package.results {
                        let text = literal(&result.text.zh);
                        out.line(format!("case ResultCode::{}: return {text};", result.name));
                    }
                });
                out.line("return {};");
            },
        );
        out.blank();
        out.enclose(
            "fc_runtime::Refusal refusal(ResultCode code) {",
            "}",
            |out| {
                out.line("return {static_cast<std::int64_t>(code), std::string(text(code))};");
            },
        );
    });
    out.finish()
}

fn addresses(out: &mut Source, context: &Context<'_>) {
    let model = context.model();
    let ports = &model.transport.ports;
    out.line(format!("protocol.name = {};", literal(&model.protocol.id)));
    out.line(format!(
        "protocol.host = {};",
        literal(&model.transport.host)
    ));
    out.line(format!("protocol.command_port = {};", ports.command.number));
    out.line(format!("protocol.data_port = {};", ports.data.number));
}

fn header_layout(out: &mut Source, context: &Context<'_>) {
    let frame = &context.model().frame;
    out.line(format!("protocol.header.length = {};", frame.header_len()));
    let is_big = frame.byte_order == ByteOrder::Big;
    out.line(format!("protocol.header.big_endian = {is_big};"));
    out.enclose("protocol.header.fields = {", "};", |out| {
        for field in &context.package.header {
            header_field(out, field);
        }
    });
    let digests = context
        .package
        .header
        .iter()
        .find_map(|field| field.digest());
    let digest = match digests {
        None => "None",
        Some(DigestAlgorithm::Md5) => "Md5",
        Some(DigestAlgorithm::Crc32) => "Crc32",
    };
    out.line(format!(
        "protocol.header.digest = fc_runtime::DigestAlgorithm::{digest};"
    ));
}

fn header_field(out: &mut Source, field: &Spelled<'_, HeaderField>) {
    let role = match field.role {
        Some(HeaderRole::Head) => "Head",
        Some(HeaderRole::Kind) => "Kind",
        Some(HeaderRole::Code) => "Code",
        Some(HeaderRole::Id) => "Id",
        Some(HeaderRole::Encoding) => "Encoding",
        Some(HeaderRole::TotalLength) => "TotalLength",
        Some(HeaderRole::PlainLength) => "PlainLength",
        Some(HeaderRole::Digest) => "Digest",
        Some(HeaderRole::Status) | None => "Fixed",
    };
    out.line(format!(
        "{{fc_runtime::HeaderRole::{role}, {}, {}, {}}},  // {}",
        field.offset,
        field.of.ty.size(),
        integer(field.value.into()),
        field.wire
    ));
}

/// Bytes as a string literal.
fn bytes(bytes: &[u8]) -> String {
    let escaped: Vec<String> = bytes.iter().map(|it| format!("\\x{it:02X}")).collect();
    format!("\"{}\"sv", escaped.concat())
}

fn frames(out: &mut Source, context: &Context<'_>) {
    let frame = &context.model().frame;
    let kinds = &frame.kinds;
    out.line(format!(
        "protocol.request_head = {};",
        bytes(&frame.request_head)
    ));
    out.line(format!(
        "protocol.response_head = {};",
        bytes(&frame.response_head)
    ));
    out.line(format!("protocol.stream_kind = {};", kinds.stream.value));
    out.line(format!("protocol.command_kind = {};", kinds.command.value));
    out.line(format!("protocol.report_kind = {};", kinds.report.value));
    let reserved: Vec<String> = kinds
        .reserved
        .iter()
        .map(|it| it.value.to_string())
        .collect();
    out.line(format!(
        "protocol.reserved_kinds = {{{}}};",
        reserved.join(", ")
    ));
    let encoding = |role| frame.encoding(role).map(|encoding| encoding.value);
    let plain = encoding(EncodingRole::Plain).unwrap_or_default();
    out.line(format!("protocol.plain_encoding = {plain};"));
    if let Some(gzip) = encoding(EncodingRole::Gzip) {
        out.line(format!("protocol.gzip_encoding = std::uint8_t{{{gzip}}};"));
    }
    let zero = frame.has_quirk(HeaderQuirk::ZeroWhenPlain);
    out.line(format!("protocol.zero_plain_length = {zero};"));
    for role in ResultRole::ALL {
        let mut results = context.model().results.iter();
        if let Some(result) = results.find(|result| result.role == Some(*role)) {
            out.line(format!(
                "protocol.results.{} = {{{}, {}}};",
                role.name(),
                integer(result.code.into()),
                literal(&result.text.zh)
            ));
        }
    }
}

fn envelope(out: &mut Source, side: &str, keys: &[Spelled<'_, EnvelopeField>]) {
    out.enclose(&format!("protocol.{side}_envelope = {{"), "};", |out| {
        for key in keys {
            let role = match key.role {
                EnvelopeRole::Time => "Time",
                EnvelopeRole::ResultCode => "ResultCode",
                EnvelopeRole::ResultText => "ResultText",
            };
            let range = match &key.of.ty {
                Type::Int(kind) => {
                    let ty = super::types::integer_type(kind.name());
                    let limit = |what| format!("std::numeric_limits<{ty}>::{what}()");
                    format!(".min({}).max({})", limit("min"), limit("max"))
                }
                _ => String::new(),
            };
            out.line(format!(
                "{{fc_runtime::EnvelopeRole::{role}, fc_runtime::Field({}){range}, {}}},",
                literal(&key.wire),
                key.optional
            ));
        }
    });
}

fn defaults(out: &mut Source, context: &Context<'_>) {
    let calls = &context.model().calls;
    let limits = &context.model().limits;
    let duration = |ms: u32| format!("std::chrono::milliseconds({ms})");
    out.line(format!(
        "protocol.defaults.call_timeout = {};",
        duration(calls.timeout_ms)
    ));
    let handler = duration(calls.handler_timeout_ms);
    out.line(format!("protocol.defaults.handler_timeout = {handler};"));
    if let Some(age) = calls.max_age_ms {
        out.line(format!("protocol.defaults.max_age = {};", duration(age)));
    }
    let (timeout, retries) = (duration(calls.ack.timeout_ms), calls.ack.retries);
    out.line(format!("protocol.defaults.ack = {{{timeout}, {retries}}};"));
    for (name, value) in [
        ("frame_bytes", limits.frame_bytes),
        ("inflated_bytes", limits.inflated_bytes),
        ("json_depth", limits.json_depth),
        ("in_flight", limits.in_flight),
        ("queued_reports", limits.queued_reports),
        ("connections", limits.connections),
    ] {
        out.line(format!("protocol.defaults.limits.{name} = {value};"));
    }
}

/// What tells the protocol of a group's operations, as the header declares it.
pub fn declare_operations(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.line("/// 把这一组的指令、上报和数据流加到 `protocol().operations` 中。");
    out.line("/// Adds the operations of the group to those of `protocol()`.");
    let open = format!("void add_{}(", group.id);
    let parameters = ["std::vector<fc_runtime::OperationInfo>& operations".to_owned()];
    out.parameters(&open, &parameters, ");");
}

/// The function for that.
pub fn operations(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let open = format!(
        "void add_{}(std::vector<fc_runtime::OperationInfo>& operations) {{",
        group.id
    );
    out.enclose(&open, "}", |out| {
        for operation in &group.operations {
            operation_info(out, context, operation);
        }
    });
}

fn operation_info(out: &mut Source, context: &Context<'_>, operation: &Operation) {
    let kind = match operation.kind() {
        Kind::Command => "Command",
        Kind::Report => "Report",
        Kind::Stream => "Stream",
    };
    let code = match operation.code.value {
        Some(_) => format!("std::uint16_t{{{}}}", operation.code.spelling),
        None => "std::nullopt".to_owned(),
    };
    let effect = operation.effect().map_or("Unknown", effect_name);
    let ack = match &operation.exchange {
        Exchange::Report { ack, .. } => {
            format!(
                "fc_runtime::AckPolicy{{std::chrono::milliseconds({}), {}}}",
                ack.timeout_ms, ack.retries
            )
        }
        _ => "std::nullopt".to_owned(),
    };
    let interval = match operation.cadence() {
        Some(Cadence::EveryMs(ms)) => format!("std::chrono::milliseconds({ms})"),
        _ => "std::nullopt".to_owned(),
    };
    let body = |direction| match operation.body(direction) {
        Some(body) => format!("fc_runtime::type_info<{}>()", context.name_of(&body.ty)),
        None => "std::nullopt".to_owned(),
    };
    out.line(format!(
        "operations.push_back({{{}, {code}, fc_runtime::OperationKind::{kind}, fc_runtime::Effect::{effect}, {}, {}, {ack}, {interval}, {}, {}}});",
        literal(&operation.name),
        literal(&operation.title.zh),
        literal(&operation.title.en),
        body(Direction::Request),
        body(Direction::Response)
    ));
}
