//! The protocol itself: header, envelopes, result codes, ports and limits.

use super::group::parts;
use super::messages::both;
use super::text::{STYLE, integer, literal, plain_codec, type_of};
use crate::emit::stub::about;
use crate::emit::stub::context::Context;
use crate::emit::stub::docs::Docs;
use crate::emit::stub::source::Source;
use crate::surface::group::Group;
use crate::surface::package::Spelled;
use fc_spec::model::{
    ByteOrder, DigestAlgorithm, EncodingRole, EnvelopeField, HeaderField, HeaderQuirk, HeaderRole,
    ResultRole,
};

/// The file.
pub fn file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> Source {
    let mut out = Source::new(&STYLE);
    protocol(&mut out, context, groups);
    let package = &context.package;
    for (name, said, fields) in [
        (
            "RequestEnvelope",
            &about::REQUEST_ENVELOPE,
            &package.request_envelope,
        ),
        (
            "ResponseEnvelope",
            &about::RESPONSE_ENVELOPE,
            &package.response_envelope,
        ),
    ] {
        out.blank();
        out.docs(&Docs::said(said));
        envelope(&mut out, context, name, fields);
    }
    out.blank();
    results(&mut out, context);
    out
}

fn protocol(out: &mut Source, context: &Context<'_>, groups: &[Group<'_, '_>]) {
    let model = context.model();
    let (frame, kinds) = (&model.frame, &model.frame.kinds);
    out.docs(&about::protocol(model));
    out.block(
        format!("public object {} : Protocol()", context.package.name),
        |out| {
            let mut value = |name: &str, ty: &str, value: String| {
                out.line(format!("override val {name}: {ty} get() = {value}"));
            };
            value("name", "String", literal(&model.protocol.id));
            value("host", "String", literal(&model.transport.host));
            value(
                "commandPort",
                "Int",
                model.transport.ports.command.number.to_string(),
            );
            value(
                "dataPort",
                "Int",
                model.transport.ports.data.number.to_string(),
            );
            for (name, kind) in [
                ("streamKind", &kinds.stream),
                ("commandKind", &kinds.command),
                ("reportKind", &kinds.report),
            ] {
                value(name, "Int", kind.value.to_string());
            }
            let encoding = |role| frame.encoding(role).map(|encoding| encoding.value);
            let plain = encoding(EncodingRole::Plain).unwrap_or_default();
            value("plainEncoding", "Int", plain.to_string());
            if let Some(gzip) = encoding(EncodingRole::Gzip) {
                value("gzipEncoding", "Int?", gzip.to_string());
            }
            let zero = frame.has_quirk(HeaderQuirk::ZeroWhenPlain);
            value("takesZeroPlainLength", "Boolean", zero.to_string());
            value(
                "requestEnvelope",
                "MessageType<*>",
                "RequestEnvelope".to_owned(),
            );
            value(
                "responseEnvelope",
                "MessageType<*>",
                "ResponseEnvelope".to_owned(),
            );
            let reserved: Vec<String> = kinds
                .reserved
                .iter()
                .map(|it| it.value.to_string())
                .collect();
            out.line(format!(
                "override val reservedKinds: Set<Int> = setOf({})",
                reserved.join(", ")
            ));
            out.line(format!(
                "override val requestHead: Bytes = {}",
                bytes(&frame.request_head)
            ));
            out.line(format!(
                "override val responseHead: Bytes = {}",
                bytes(&frame.response_head)
            ));
            out.blank();
            let is_big = frame.byte_order == ByteOrder::Big;
            let fields: Vec<String> = context
                .package
                .header
                .iter()
                .map(|it| header(it.of))
                .collect();
            out.enclose(
                "override val header: HeaderLayout = HeaderLayout(",
                ")",
                |out| {
                    out.line(format!("{is_big},"));
                    out.lines("listOf(", &fields, "),");
                },
            );
            out.blank();
            out.enclose("override val results: Results = Results(", ")", |out| {
                for role in ResultRole::ALL {
                    let result = model.results.iter().find(|it| it.role == Some(*role));
                    let (code, text) = result.map_or((0, ""), |it| (it.code, &*it.text.zh));
                    out.line(format!("ResultText({code}, {}),", literal(text)));
                }
            });
            out.blank();
            defaults(out, context);
            operations(out, groups);
        },
    );
}

/// The commands and reports, which know the protocol as little as the runtime does.
fn operations(out: &mut Source, groups: &[Group<'_, '_>]) {
    let lists = |name: &str, has: fn(&Group<'_, '_>) -> bool| {
        let parts = parts(groups, "Operations", has).into_iter();
        parts.map(|part| format!("{part}.{name}()")).collect()
    };
    let commands: Vec<String> = lists("commands", |it| !it.commands.is_empty());
    let reports: Vec<String> = lists("reports", |it| !it.reports.is_empty());
    for (name, ty, lists) in [
        ("commands", "Command<*, *>", commands),
        ("reports", "Report<*>", reports),
    ] {
        let open = format!("override val {name}: List<{ty}> by lazy {{");
        out.blank();
        out.enclose(&open, "}", |out| {
            if lists.is_empty() {
                out.line("emptyList()");
            } else {
                out.lines("listOf(", &lists, ").flatten()");
            }
        });
    }
}

fn bytes(bytes: &[u8]) -> String {
    let bytes: Vec<String> = bytes
        .iter()
        .map(|byte| byte.cast_signed().to_string())
        .collect();
    format!("Bytes.of(byteArrayOf({}))", bytes.join(", "))
}

fn header(field: &HeaderField) -> String {
    let size = field.ty.size();
    match field.role {
        Some(HeaderRole::Digest) => {
            let is_crc = field.digest() == Some(DigestAlgorithm::Crc32);
            let algorithm = if is_crc { "CRC32" } else { "MD5" };
            format!("HeaderField.digest(DigestAlgorithm.{algorithm})")
        }
        None | Some(HeaderRole::Status) => format!("HeaderField.constant({size}, {})", field.value),
        Some(role) => {
            format!(
                "HeaderField.of(HeaderRole.{}, {size})",
                role.name().to_uppercase()
            )
        }
    }
}

fn defaults(out: &mut Source, context: &Context<'_>) {
    let (calls, limits) = (&context.model().calls, &context.model().limits);
    out.enclose("override val defaults: Defaults = Defaults(", ")", |out| {
        out.line(format!(
            "callTimeout = {},",
            integer(calls.timeout_ms.into())
        ));
        out.line(format!(
            "handlerTimeout = {},",
            integer(calls.handler_timeout_ms.into())
        ));
        out.line(format!(
            "ack = AckPolicy({}, {}),",
            calls.ack.timeout_ms, calls.ack.retries
        ));
        out.enclose("limits = Limits(", "),", |out| {
            for (name, value) in [
                ("frameBytes", limits.frame_bytes),
                ("inflatedBytes", limits.inflated_bytes),
                ("jsonDepth", limits.json_depth),
                ("inFlight", limits.in_flight),
                ("queuedReports", limits.queued_reports),
                ("connections", limits.connections),
            ] {
                out.line(format!("{name} = {},", integer(value.into())));
            }
        });
        if let Some(age) = calls.max_age_ms {
            out.line(format!("maxAge = {},", integer(age.into())));
        }
    });
}

fn envelope(
    out: &mut Source,
    context: &Context<'_>,
    name: &str,
    fields: &[Spelled<'_, EnvelopeField>],
) {
    let head =
        format!("public class {name} private constructor(content: Content) : Message(content)");
    out.block(head, |out| {
        for field in fields {
            let mark = if field.optional { "?" } else { "" };
            let (property, constant) = (&field.name, field.of.name.to_uppercase());
            let ty = type_of(context, &field.ty);
            out.blank();
            out.docs(&Docs::of(&field.text));
            out.line(format!(
                "public val {property}: {ty}{mark} get() = get({constant})"
            ));
        }
        out.blank();
        out.line(format!(
            "override val messageType: MessageType<{name}> get() = {name}"
        ));
        out.blank();
        out.docs(&both("此类型。", "The type."));
        out.block(
            format!("public companion object : MessageType<{name}>(\"{name}\")"),
            |out| {
                for field in fields {
                    let how = if field.optional {
                        "optional"
                    } else {
                        "required"
                    };
                    let (wire, codec) = (literal(&field.wire), plain_codec(&field.ty));
                    let role = field.role.name().to_uppercase();
                    let constant = field.of.name.to_uppercase();
                    out.line(format!(
                        "private val {constant} = {how}({wire}, {codec}).role(EnvelopeRole.{role})"
                    ));
                }
                out.blank();
                out.line(format!(
                    "override fun create(content: Content): {name} = {name}(content)"
                ));
            },
        );
    });
}

fn results(out: &mut Source, context: &Context<'_>) {
    out.docs(&about::results(context));
    out.block(
        "public class ResultCode private constructor(wire: Long) : IntValue(wire)",
        |out| {
            out.line("override val enumType: EnumType<ResultCode> get() = ResultCode");
            out.blank();
            out.docs(&both(
                "随结果码发送的文字。",
                "The text sent with the code.",
            ));
            out.line("public val text: String get() = texts[wire] ?: \"\"");
            out.blank();
            out.docs(&both("以此结果码拒绝。", "The refusal with this code."));
            out.line("public fun refusal(): Refusal = Refusal(wire, text)");
            out.blank();
            out.docs(&both("规范中的全部结果码。", "The codes of the spec."));
            out.block(
                "public companion object : IntEnumType<ResultCode>(\"ResultCode\", Types.I64)",
                |out| {
                    let results = &context.package.results;
                    for result in results {
                        out.blank();
                        out.docs(&about::result(result.of));
                        out.line("@JvmField");
                        let name = &result.name;
                        out.line(format!(
                            "public val {name}: ResultCode = named({}, \"{name}\")",
                            result.code
                        ));
                    }
                    let texts = results.iter();
                    let texts: Vec<String> = texts
                        .map(|it| format!("{}L to {}", it.code, literal(&it.text.zh)))
                        .collect();
                    out.blank();
                    out.lines("private val texts: Map<Long, String> = mapOf(", &texts, ")");
                    out.blank();
                    out.docs(&both("`wire` 对应的结果码。", "The code for `wire`."));
                    out.line("@JvmStatic");
                    out.line("override fun of(wire: Long): ResultCode = super.of(wire)");
                    out.blank();
                    out.line("override fun create(wire: Long): ResultCode = ResultCode(wire)");
                },
            );
        },
    );
}
