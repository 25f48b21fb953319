//! The protocol: header, envelopes, result codes, ports and limits.

use super::expr::bytes;
use super::group::parts;
use super::text::{integer, literal, plain_codec, type_of};
use crate::package::about;
use crate::package::context::Context;
use crate::package::docs::Docs;
use crate::package::group::Group;
use crate::package::items::Spelled;
use crate::package::joined::Joined;
use crate::package::language::Case;
use crate::package::source::Source;
use crate::package::wire::WireFacts;
use fc_spec::model::{DigestAlgorithm, EnvelopeField, HeaderField, HeaderRole};

/// Generates `Protocol.kt`.
pub fn protocol_file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> Source {
    let mut out = context.source();
    protocol(&mut out, context, groups);
    for envelope in about::envelopes(context) {
        out.documented(&Docs::said(envelope.about));
        self::envelope(&mut out, context, envelope.name, envelope.fields);
    }
    out.blank();
    results(&mut out, context);
    out
}

fn protocol(out: &mut Source, context: &Context<'_>, groups: &[Group<'_, '_>]) {
    let wire = &WireFacts::build(context);
    let frame = &wire.frame;
    out.docs(&about::protocol(context.model()));
    let head = format!("public object {} : Protocol()", context.package.name);
    out.block(head, |out| {
        let mut value = |name: &str, ty: &str, value: String| {
            out.line(format!("override val {name}: {ty} get() = {value}"));
        };
        value("name", "String", literal(wire.name));
        value("host", "String", literal(wire.host));
        for (name, number) in &wire.ports {
            value(&Case::Camel.apply(name), "Int", number.to_string());
        }
        for (name, kind) in frame.kinds {
            value(&format!("{name}Kind"), "Int", kind.to_string());
        }
        value("plainEncoding", "Int", frame.plain.to_string());
        if let Some(gzip) = frame.gzip {
            value("gzipEncoding", "Int?", gzip.to_string());
        }
        let zero = frame.takes_zero_plain_length;
        value("takesZeroPlainLength", "Boolean", zero.to_string());
        for envelope in ["requestEnvelope", "responseEnvelope"] {
            let ty = Case::Pascal.apply(envelope).into_owned();
            value(envelope, "MessageType<*>", ty);
        }
        let reserved = frame.reserved_kinds.iter().map(u8::to_string).joined(", ");
        out.line(format!(
            "override val reservedKinds: Set<Int> = setOf({reserved})"
        ));
        for (name, head) in frame.heads {
            let (name, head) = (Case::Camel.apply(name), bytes(head));
            out.line(format!("override val {name}: Bytes = {head}"));
        }
        out.blank();
        let fields: Vec<String> = frame.header.iter().map(|it| header(it)).collect();
        let open = "override val header: HeaderLayout = HeaderLayout(";
        out.enclose(open, ")", |out| {
            out.line(format!("{},", frame.is_big_endian()));
            out.lines("listOf(", &fields, "),");
        });
        out.blank();
        out.enclose("override val results: Results = Results(", ")", |out| {
            for result in &wire.results {
                let (code, text) = result.code_and_text();
                out.line(format!("ResultText({code}, {}),", literal(text)));
            }
        });
        out.blank();
        defaults(out, wire);
        operations(out, groups);
    });
}

/// Writes the lists of commands and reports, which do not refer to the protocol.
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

fn header(field: &HeaderField) -> String {
    let size = field.ty.size();
    match field.role {
        Some(HeaderRole::Digest) => {
            let algorithm = field.digest().map_or("md5", DigestAlgorithm::name);
            let algorithm = Case::Screaming.apply(algorithm);
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

fn defaults(out: &mut Source, wire: &WireFacts<'_, '_>) {
    let value = |out: &mut Source, name: &str, value: u32| {
        let name = Case::Camel.apply(name);
        out.line(format!("{name} = {},", integer(value.into())));
    };
    out.enclose("override val defaults: Defaults = Defaults(", ")", |out| {
        for (name, ms) in &wire.times {
            value(out, name, *ms);
        }
        let ack = wire.ack;
        out.line(format!(
            "ack = AckPolicy({}, {}),",
            ack.timeout_ms, ack.retries
        ));
        out.enclose("limits = Limits(", "),", |out| {
            for (name, limit) in wire.limits {
                value(out, name, limit);
            }
        });
        if let Some(age) = wire.max_age_ms {
            value(out, "max_age", age);
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
            out.documented(&Docs::titled(&field.text));
            out.line(format!(
                "public val {property}: {ty}{mark} get() = get({constant})"
            ));
        }
        out.blank();
        out.line(format!(
            "override val messageType: MessageType<{name}> get() = {name}"
        ));
        out.blank();
        out.template("envelope", &[("name", name)]);
        out.enclose("", "}", |out| {
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
        });
    });
}

fn results(out: &mut Source, context: &Context<'_>) {
    out.docs(&about::results(context));
    out.template("result_code", &[]);
    out.deeper(2, |out| {
        let results = &context.package.results;
        for (index, result) in results.iter().enumerate() {
            if index > 0 {
                out.blank();
            }
            out.docs(&about::result(result.of));
            let (value, wire) = (&result.name, result.code.to_string());
            let name = "ResultCode";
            out.template(
                "value",
                &[("value", value), ("name", name), ("wire", &wire)],
            );
        }
        let texts = results.iter();
        let texts = texts.map(|it| format!("{}L to {}", it.code, literal(&it.text.zh)));
        out.blank();
        let open = "private val texts: Map<Long, String> = mapOf(";
        out.lines(open, &texts.collect::<Vec<_>>(), ")");
    });
    out.template("result_of", &[]);
}
