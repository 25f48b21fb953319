//! `protocol.rs`: frame header, envelopes, result codes, and the protocol with its numbers.

use super::context::{Context, page_of};
use super::enums::{other_name, other_variant};
use super::literal::literal;
use super::source::Source;
use crate::package::about::{self, Envelope};
use crate::package::digits::grouped;
use crate::package::docs::Docs;
use crate::package::facts;
use crate::package::items::Spelled;
use crate::package::joined::Joined;
use crate::package::language::Case;
use crate::package::wire::WireFacts;
use fc_spec::model::{DigestAlgorithm, HeaderField, HeaderQuirk, HeaderType};

/// Generates `protocol.rs`.
pub fn protocol_file(context: &Context<'_>) -> String {
    let mut out = context.source();
    out.inner_docs(&Docs::said(about::WIRE));
    out.blank();
    out.import("super::descriptors", &["OPERATIONS"]);
    out.import("fc_derive", &["Envelope", "Header", "Message", "OpenEnum"]);
    out.import(
        "fc_runtime",
        &[
            "AckPolicy",
            "Defaults",
            "Limits",
            "OperationInfo",
            "Protocol",
            "Refusal",
            "ResultText",
            "Results",
        ],
    );
    out.import("std::time", &["Duration"]);
    out.blank();
    protocol(&mut out, context);
    out.blank();
    header(&mut out, context);
    for envelope in about::envelopes(context) {
        out.blank();
        self::envelope(&mut out, context, &envelope);
    }
    out.blank();
    results(&mut out, context);
    streams(&mut out, context);
    out.finish()
}

fn protocol(out: &mut Source, context: &Context<'_>) {
    out.docs(&about::protocol(context.model()));
    out.line("#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]");
    let name = &context.package.name;
    out.line(format!("pub struct {name};"));
    out.blank();
    let wire = &WireFacts::build(context);
    out.block(format!("impl Protocol for {name}"), |out| {
        out.template("protocol_impl", &[]);
        out.blank();
        constants(out, wire);
        out.blank();
        out.enclose("const RESULTS: Results = Results {", "};", |out| {
            for result in &wire.results {
                let (code, text) = result.code_and_text();
                out.enclose(&format!("{}: ResultText {{", result.role), "},", |out| {
                    out.line(format!("code: {},", grouped(code.into())));
                    out.line(format!("text: {},", literal(text)));
                });
            }
        });
        out.blank();
        defaults(out, wire);
        out.template("operations", &[]);
    });
}

fn constants(out: &mut Source, wire: &WireFacts<'_, '_>) {
    let frame = &wire.frame;
    let mut constant = |name: &str, ty: &str, value: &str| {
        let name = Case::Screaming.apply(name);
        out.line(format!("const {name}: {ty} = {value};"));
    };
    constant("name", "&'static str", &literal(wire.name));
    constant("host", "&'static str", &literal(wire.host));
    for (name, number) in &wire.ports {
        constant(name, "u16", &grouped((*number).into()));
    }
    for (name, head) in frame.heads {
        constant(name, "&'static [u8]", &bytes(head));
    }
    for (name, kind) in frame.kinds {
        constant(name, "u8", &format!("0x{kind:02X}"));
    }
    constant(
        "reserved_kinds",
        "&'static [u8]",
        &bytes(&frame.reserved_kinds),
    );
    constant("PLAIN", "u8", &frame.plain.to_string());
    constant("GZIP", "Option<u8>", &format!("{:?}", frame.gzip));
    let zero = frame.takes_zero_plain_length;
    constant("zero_plain_length", "bool", &zero.to_string());
}

fn defaults(out: &mut Source, wire: &WireFacts<'_, '_>) {
    let duration = |ms: u32| {
        if ms > 0 && ms.is_multiple_of(1000) {
            format!("Duration::from_secs({})", grouped((ms / 1000).into()))
        } else {
            format!("Duration::from_millis({})", grouped(ms.into()))
        }
    };
    let max_age = wire
        .max_age_ms
        .map_or_else(|| "None".to_owned(), |ms| format!("Some({})", duration(ms)));
    out.enclose("const DEFAULTS: Defaults = Defaults {", "};", |out| {
        for (name, ms) in &wire.times {
            out.line(format!("{name}: {},", duration(*ms)));
        }
        out.line(format!("max_age: {max_age},"));
        out.enclose("ack: AckPolicy {", "},", |out| {
            out.line(format!("timeout: {},", duration(wire.ack.timeout_ms)));
            out.line(format!("retries: {},", wire.ack.retries));
        });
        out.enclose("limits: Limits {", "},", |out| {
            for (name, value) in wire.limits {
                out.line(format!("{name}: {},", grouped(value.into())));
            }
            // The runtime sets these limits; the protocol does not.
            for name in ["inflate_ratio", "json_values", "json_list_bytes"] {
                out.line(format!("{name}: Limits::{},", name.to_uppercase()));
            }
        });
    });
}

fn header(out: &mut Source, context: &Context<'_>) {
    let frame = &context.model().frame;
    let length = frame.header_len();
    let zh = format!("包头，共 {length} 字节，其后是数据区。");
    let en = format!("The header: {length} bytes before the data area.");
    let mut docs = Docs::said([zh, en]);
    docs.text(&frame.data);
    if let Some(page) = context.page("reference/wire.md") {
        docs.paragraph(page);
    }
    out.docs(&docs);
    out.line("#[derive(Clone, Copy, Debug, PartialEq, Eq, Header)]");
    let order = frame.byte_order.name();
    out.line(format!("#[fc(byte_order = \"{order}\")]"));
    out.block("pub struct FrameHeader", |out| {
        for field in &context.package.header {
            header_field(out, field);
        }
    });
}

fn header_field(out: &mut Source, field: &Spelled<'_, HeaderField>) {
    let mut docs = Docs::titled(&field.text);
    let mut fact = format!("`{}`, offset {}.", field.wire, field.offset);
    if field.has_quirk(HeaderQuirk::ZeroWhenPlain) {
        fact.push_str(" 0 is accepted on a frame that is not compressed.");
    }
    docs.paragraph(fact);
    out.documented(&docs);
    let mut items = Vec::new();
    if let Some(role) = field.role {
        items.push(format!("role = \"{}\"", role.name()));
    }
    if let Some(algorithm) = field.digest()
        && algorithm != DigestAlgorithm::Md5
    {
        items.push(format!("algorithm = \"{}\"", algorithm.name()));
    }
    if field.is_sent_as_value() {
        items.push(format!("value = {}", field.value));
    }
    out.attribute("#[fc(", &items, ")]");
    let ty = match field.ty {
        HeaderType::U8 => "u8".to_owned(),
        HeaderType::U16 => "u16".to_owned(),
        HeaderType::U32 => "u32".to_owned(),
        HeaderType::U64 => "u64".to_owned(),
        HeaderType::Bytes(length) => format!("[u8; {length}]"),
    };
    out.line(format!("pub {}: {ty},", field.name));
}

fn envelope(out: &mut Source, context: &Context<'_>, envelope: &Envelope<'_, '_>) {
    let fields = envelope.fields;
    out.docs(&Docs::said(envelope.about));
    let defaults = fields.iter().all(|field| field.optional);
    out.line(if defaults {
        "#[derive(Clone, Debug, Default, PartialEq, Message, Envelope)]"
    } else {
        "#[derive(Clone, Debug, PartialEq, Message, Envelope)]"
    });
    out.line(format!("#[fc(envelope = \"{}\")]", envelope.side));
    out.block(format!("pub struct {}", envelope.name), |out| {
        for field in fields {
            out.documented(&Docs::titled(&field.text));
            let name = &field.name;
            let mut items = Vec::new();
            if *name != field.wire {
                items.push(format!("key = {}", literal(&field.wire)));
            }
            let role = field.role.name();
            items.push(format!("role = \"{role}\""));
            out.attribute("#[fc(", &items, ")]");
            let rust = context.rust_type(&field.ty);
            out.line(if field.optional {
                format!("pub {name}: Option<{rust}>,")
            } else {
                format!("pub {name}: {rust},")
            });
        }
    });
}

fn results(out: &mut Source, context: &Context<'_>) {
    let docs = about::results(context);
    out.docs(&docs);
    let results = &context.package.results;
    let other = other_name(|name| results.iter().any(|result| result.name == name));
    out.line("#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, OpenEnum)]");
    out.line("#[fc(repr = i64)]");
    out.block("pub enum ResultCode", |out| {
        for result in results {
            out.documented(&about::result(result.of));
            out.line(format!("#[fc(value = {})]", result.code));
            out.line(format!("{},", result.name));
        }
        other_variant(out, &other, ["结果码", "code"], "i64");
    });
    out.template("text_of_result", &[]);
    out.deeper(3, |out| {
        for result in results {
            let text = literal(&result.text.zh);
            out.line(format!("Self::{} => {text},", result.name));
        }
    });
    out.template("refusal", &[("other", &other)]);
}

/// Writes the codes of the streams, if there are any. A stream of bytes has no type that could hold its code.
fn streams(out: &mut Source, context: &Context<'_>) {
    let streams = &context.package.streams;
    if streams.is_empty() {
        return;
    }
    out.template("stream_code", &[]);
    let other = other_name(|name| streams.iter().any(|stream| stream.name == name));
    out.block("pub enum StreamCode", |out| {
        for stream in streams {
            let mut docs = facts::operation_docs(stream);
            docs.paragraph(facts::operation_facts(context.style, stream));
            docs.paragraph(context.links(&stream.location, &page_of(stream)));
            out.documented(&docs);
            out.line(format!("#[fc(value = {})]", stream.code.spelling));
            out.line(format!("{},", stream.name));
        }
        other_variant(out, &other, ["功能码", "code"], "u16");
    });
}

/// Returns bytes as a slice: `&[0xFC, 0xAA]`.
fn bytes(bytes: &[u8]) -> String {
    let items = bytes.iter().map(|byte| format!("0x{byte:02X}"));
    format!("&[{}]", items.joined(", "))
}
