//! The protocol as a value: header, envelopes, result codes, ports, limits and operations.

use super::groups::NamedGroup;
use super::layout::{Includes, float, header_file, integer, literal, source_file};
use super::types::namespace;
use crate::package::about;
use crate::package::context::{Context, page_of};
use crate::package::facts;
use crate::package::items::Spelled;
use crate::package::joined::Joined;
use crate::package::language::Case;
use crate::package::source::Source;
use crate::package::wire::{FrameFacts, WireFacts};
use fc_spec::model::{
    AcceptedIn, Cadence, DigestAlgorithm, Direction, Effect, EnvelopeField, Exchange, HeaderField,
    HeaderRole, Operation, Type,
};

/// Generates `protocol.hpp`.
pub fn header(context: &Context<'_>) -> String {
    let includes = Includes::new(
        context,
        &["cstdint", "string_view"],
        &[],
        &["call", "protocol"],
    );
    header_file(context, &includes, |out| {
        out.docs(&about::protocol(context.model()));
        out.line("[[nodiscard]] const fc_runtime::Protocol& protocol();");
        out.blank();
        results(out, context);
        streams(out, context);
    })
}

fn results(out: &mut Source, context: &Context<'_>) {
    out.docs(&about::results(context));
    out.enclose("enum class ResultCode : std::int64_t {", "};", |out| {
        for result in &context.package.results {
            out.docs(&about::result(result.of));
            let code = integer(result.code.into());
            out.line(format!("{} = {code},", result.name));
        }
    });
    out.blank();
    out.template("result_functions", &[]);
}

/// Writes the codes of the streams, if there are any. A stream of bytes has no type that could hold its code.
fn streams(out: &mut Source, context: &Context<'_>) {
    if context.package.streams.is_empty() {
        return;
    }
    out.template("stream_codes", &[]);
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

/// Generates `protocol.cpp`.
pub fn source(context: &Context<'_>, groups: &[NamedGroup<'_, '_>]) -> String {
    let space = &namespace(context);
    let before = format!(
        "#include <limits>\n\n#include \"{space}/messages.hpp\"\n\n// Tables, a line for each entry.\n"
    );
    source_file(context, "protocol.hpp", &before, |out| {
        out.line("namespace {\n\nusing namespace std::string_view_literals;\n\n");
        out.block("fc_runtime::Protocol make_protocol()", |out| {
            out.line("fc_runtime::Protocol protocol;");
            let wire = &WireFacts::build(context);
            out.line(format!("protocol.name = {};", literal(wire.name)));
            out.line(format!("protocol.host = {};", literal(wire.host)));
            for (name, number) in &wire.ports {
                out.line(format!("protocol.{name} = {number};"));
            }
            header_layout(out, context, &wire.frame);
            frames(out, wire);
            envelope(out, "request", &context.package.request_envelope);
            envelope(out, "response", &context.package.response_envelope);
            defaults(out, wire);
            for group in groups {
                out.line(format!("{}(protocol.operations);", group.function("add")));
            }
            out.line("return protocol;");
        });
        out.template("protocol", &[]);
        out.blank();
        out.block("std::string_view text(ResultCode code) noexcept", |out| {
            out.block("switch (code)", |out| {
                for result in &context.package.results {
                    let text = literal(&result.text.zh);
                    out.line(format!("case ResultCode::{}: return {text};", result.name));
                }
            });
            out.line("return {};");
        });
        out.template("refusal", &[]);
    })
}

fn header_layout(out: &mut Source, context: &Context<'_>, frame: &FrameFacts<'_, '_>) {
    let length = context.model().frame.header_len();
    out.line(format!("protocol.header.length = {length};"));
    let is_big = frame.is_big_endian();
    out.line(format!("protocol.header.big_endian = {is_big};"));
    out.enclose("protocol.header.fields = {", "};", |out| {
        for field in frame.header {
            header_field(out, field);
        }
    });
    let digest = frame.digest.map_or("none", DigestAlgorithm::name);
    let digest = Case::Pascal.apply(digest);
    out.line(format!(
        "protocol.header.digest = fc_runtime::DigestAlgorithm::{digest};"
    ));
}

fn header_field(out: &mut Source, field: &Spelled<'_, HeaderField>) {
    let role = field.role.filter(|role| *role != HeaderRole::Status);
    let role = Case::Pascal.apply(role.map_or("fixed", HeaderRole::name));
    out.line(format!(
        "{{fc_runtime::HeaderRole::{role}, {}, {}, {}}},  // {}",
        field.offset,
        field.of.ty.size(),
        integer(field.value.into()),
        field.wire
    ));
}

/// Returns bytes as a string literal.
fn bytes(bytes: &[u8]) -> String {
    let escaped: Vec<String> = bytes.iter().map(|it| format!("\\x{it:02X}")).collect();
    format!("\"{}\"sv", escaped.concat())
}

fn frames(out: &mut Source, wire: &WireFacts<'_, '_>) {
    let frame = &wire.frame;
    for (name, head) in frame.heads {
        out.line(format!("protocol.{name} = {};", bytes(head)));
    }
    for (name, kind) in frame.kinds {
        out.line(format!("protocol.{name}_kind = {kind};"));
    }
    let reserved = frame.reserved_kinds.iter().map(u8::to_string).joined(", ");
    out.line(format!("protocol.reserved_kinds = {{{reserved}}};"));
    out.line(format!("protocol.plain_encoding = {};", frame.plain));
    if let Some(gzip) = frame.gzip {
        out.line(format!("protocol.gzip_encoding = std::uint8_t{{{gzip}}};"));
    }
    let zero = frame.takes_zero_plain_length;
    out.line(format!("protocol.zero_plain_length = {zero};"));
    for result in wire.results.iter().filter(|it| it.result.is_some()) {
        let (code, text) = result.code_and_text();
        let (role, code) = (result.role, integer(code.into()));
        out.line(format!(
            "protocol.results.{role} = {{{code}, {}}};",
            literal(text)
        ));
    }
}

fn envelope(out: &mut Source, side: &str, keys: &[Spelled<'_, EnvelopeField>]) {
    out.enclose(&format!("protocol.{side}_envelope = {{"), "};", |out| {
        for key in keys {
            let role = Case::Pascal.apply(key.role.name());
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

fn defaults(out: &mut Source, wire: &WireFacts<'_, '_>) {
    let duration = |ms: u32| format!("std::chrono::milliseconds({ms})");
    let max_age = wire.max_age_ms.map(|age| ("max_age", age));
    for (name, ms) in wire.times.iter().copied().chain(max_age) {
        out.line(format!("protocol.defaults.{name} = {};", duration(ms)));
    }
    let (timeout, retries) = (duration(wire.ack.timeout_ms), wire.ack.retries);
    out.line(format!("protocol.defaults.ack = {{{timeout}, {retries}}};"));
    for (name, value) in wire.limits {
        out.line(format!("protocol.defaults.limits.{name} = {value};"));
    }
}

/// Declares the function that adds a group's operations to the protocol.
pub fn declare_operations(out: &mut Source, group: &NamedGroup<'_, '_>) {
    out.template("declare_operations", &[]);
    let open = format!("void add_{}(", group.id);
    let parameters = ["std::vector<fc_runtime::OperationInfo>& operations".to_owned()];
    out.parameters(&open, &parameters, ");");
}

/// Defines the function that adds a group's operations to the protocol.
pub fn operations(out: &mut Source, context: &Context<'_>, group: &NamedGroup<'_, '_>) {
    let head = format!(
        "void add_{}(std::vector<fc_runtime::OperationInfo>& operations)",
        group.id
    );
    out.block(head, |out| {
        for operation in &group.operations {
            operation_info(out, context, operation);
        }
    });
}

fn operation_info(out: &mut Source, context: &Context<'_>, operation: &Operation) {
    let kind = Case::Pascal.apply(operation.kind().name());
    let code = match operation.code.value {
        Some(_) => format!("std::uint16_t{{{}}}", operation.code.spelling),
        None => "std::nullopt".to_owned(),
    };
    let effect = operation.effect().unwrap_or(Effect::Unknown);
    let effect = Case::Pascal.apply(effect.name());
    let ack = match &operation.exchange {
        Exchange::Report { ack, .. } => {
            format!(
                "fc_runtime::AckPolicy{{std::chrono::milliseconds({}), {}}}",
                ack.timeout_ms, ack.retries
            )
        }
        _ => "std::nullopt".to_owned(),
    };
    let or_none = |it: Option<String>| it.unwrap_or_else(|| "std::nullopt".to_owned());
    let preconditions = or_none(preconditions(context, operation));
    let cadence = or_none(operation.cadence().map(cadence));
    let body = |direction| match operation.body(direction) {
        Some(body) => format!("fc_runtime::type_info<{}>()", context.name_of(&body.ty)),
        None => "std::nullopt".to_owned(),
    };
    out.line(format!(
        "operations.push_back({{{}, {code}, fc_runtime::OperationKind::{kind}, fc_runtime::Effect::{effect}, {}, {}, {ack}, {preconditions}, {cadence}, {}, {}}});",
        literal(&operation.name),
        literal(&operation.title.zh),
        literal(&operation.title.en),
        body(Direction::Request),
        body(Direction::Response)
    ));
}

/// Returns the conditions under which a command is accepted.
fn preconditions(context: &Context<'_>, command: &Operation) -> Option<String> {
    let accepted = command.accepted()?;
    let states = context.accepted_states(command);
    let states = states.iter().map(|states| {
        let values = states.values.iter();
        let values = values.map(|value| literal(&value.name)).joined(", ");
        format!("{{{}, {{{values}}}}}", literal(&states.item.ty.of.name))
    });
    let states = states.joined(", ");
    let is_any = matches!(accepted.states, Some(AcceptedIn::Any));
    let after = accepted.after.iter().map(|name| literal(name)).joined(", ");
    Some(format!(
        "fc_runtime::Preconditions{{{is_any}, {{{states}}}, {{{after}}}}}"
    ))
}

/// Returns the time at which a report is sent.
fn cadence(cadence: &Cadence) -> String {
    let ms = |ms: &u32| format!("{{}}, 0, std::chrono::milliseconds({ms})");
    let (kind, rest) = match cadence {
        Cadence::OnChange(field) => ("OnChange", format!("{}, 0, {{}}", literal(field))),
        Cadence::Step(step) => {
            let by = float(step.by.to_f64());
            ("Step", format!("{}, {by}, {{}}", literal(&step.field)))
        }
        Cadence::EveryMs(every) => ("Every", ms(every)),
        Cadence::WithinMs(within) => ("Within", ms(within)),
    };
    format!("fc_runtime::Cadence{{fc_runtime::CadenceKind::{kind}, {rest}}}")
}
