//! `protocol.py`: result codes, envelopes, and the protocol with its numbers.

use super::literal::{bytes, literal};
use super::messages::annotation;
use super::modules::{GroupPart, ModulePlan};
use super::operations::{ack, seconds};
use super::source::{Code, PYTHON, Python, tuple};
use crate::package::about::{self, Envelope};
use crate::package::context::Context;
use crate::package::digits::grouped;
use crate::package::docs::Docs;
use crate::package::items::Spelled;
use crate::package::language::Case;
use crate::package::name::free;
use crate::package::ranges::pass_through;
use crate::package::source::Source;
use crate::package::style::Comment;
use crate::package::wire::WireFacts;
use fc_spec::model::{
    EnvelopeField, HeaderField, HeaderQuirk, HeaderRole, HeaderType, Kind, RangeUse,
};

/// A comment that no tool reads.
const COMMENT: Comment = Comment {
    open: "",
    mark: "#",
    close: "",
    begins_at_once: false,
    ..PYTHON.comment
};

/// The kinds of operations, with the names of their parameters.
const KINDS: [(&str, Kind); 3] = [
    ("commands", Kind::Command),
    ("reports", Kind::Report),
    ("streams", Kind::Stream),
];

/// Returns the name of the protocol's value.
pub fn name(context: &Context<'_>) -> String {
    let wish = Case::Screaming.apply(&context.model().protocol.id);
    free(&[&wish, "PROTOCOL"], |name| context.package.has_type(name))
}

/// Generates `protocol.py`.
pub fn protocol_file(context: &Context<'_>, plan: &ModulePlan<'_, '_>) -> String {
    let package = &context.package;
    let mut out = context.source();
    out.docstring(&Docs::said(about::WIRE));
    out.blank();
    out.line("from __future__ import annotations");
    out.blank();
    out.line("from dataclasses import dataclass, field");
    out.line(
        if package.request_envelope.is_empty() && package.response_envelope.is_empty() {
            "from typing import Final"
        } else {
            "from typing import Annotated, Final"
        },
    );
    out.blank();
    out.line("import fc_runtime as rt");
    out.blank();
    plan.import(&mut out, &KINDS.map(|(_, kind)| GroupPart::All(kind)));
    out.gap();
    results(&mut out, context);
    for envelope in about::envelopes(context) {
        out.gap();
        self::envelope(&mut out, context, &envelope);
    }
    out.gap();
    protocol(&mut out, context, plan);
    out.finish()
}

fn results(out: &mut Source, context: &Context<'_>) {
    out.suite("class ResultCode(rt.Result)", |out| {
        let docs = about::results(context);
        out.docstring(&docs);
        for result in &context.package.results {
            out.blank();
            out.line(format!(
                "{} = {}, {}",
                result.name,
                result.code,
                literal(&result.text.zh)
            ));
            out.docstring(&about::result(result.of));
        }
    });
}

fn envelope(out: &mut Source, context: &Context<'_>, envelope: &Envelope<'_, '_>) {
    out.line("@dataclass(slots=True, kw_only=True)");
    out.suite(&format!("class {}(rt.Message)", envelope.name), |out| {
        out.docstring(&Docs::said(envelope.about));
        for field in envelope.fields {
            let ty = annotation(context, &field.ty, field.optional);
            let absent = if field.optional { " = None" } else { "" };
            out.blank();
            out.line(format!(
                "{}: Annotated[{ty}, rt.Key({})]{absent}",
                field.name,
                literal(&field.wire)
            ));
            out.docstring(&Docs::titled(&field.text));
        }
        out.blank();
        super::messages::extra(out);
    });
}

fn roles(fields: &[Spelled<'_, EnvelopeField>]) -> Code {
    let roles = fields.iter().map(|field| {
        let role = literal(field.role.name());
        Code::Text(format!("{role}: {}", literal(&field.name)))
    });
    Code::List("{", roles.collect(), "}")
}

fn protocol(out: &mut Source, context: &Context<'_>, plan: &ModulePlan<'_, '_>) {
    let wire = &WireFacts::build(context);
    let frame = &wire.frame;
    let reserved = frame.reserved_kinds.iter();
    let reserved: Vec<Code> = reserved.map(|kind| Code::Text(kind.to_string())).collect();
    let reserved = match reserved.as_slice() {
        [] => Vec::new(),
        _ => vec![Code::List("{", reserved, "}")],
    };
    let package = &context.package;
    let text = |text: &str| Code::Text(literal(text));
    let open = format!("{}: Final = rt.Protocol(", name(context));
    out.enclose(&open, ")", |out| {
        let set = |out: &mut Source, name: &str, value: Code| {
            Code::named(name, value).write(out, "", ",");
        };
        set(out, "name", text(wire.name));
        set(out, "host", text(wire.host));
        for (name, number) in &wire.ports {
            set(out, name, number.to_string().into());
        }
        set(out, "byte_order", text(frame.byte_order.name()));
        out.enclose("header=(", "),", |out| {
            for field in frame.header {
                out.comment(&COMMENT, &Docs::titled(&field.text));
                header_field(field).write(out, "", ",");
            }
        });
        for (name, head) in frame.heads {
            set(out, name, bytes(head).into());
        }
        for (name, kind) in frame.kinds {
            set(out, name, kind.to_string().into());
        }
        set(out, "reserved_kinds", Code::call("frozenset", reserved));
        set(out, "plain", frame.plain.to_string().into());
        if let Some(gzip) = frame.gzip {
            set(out, "gzip", gzip.to_string().into());
        }
        set(out, "request_envelope", "RequestEnvelope".into());
        set(out, "response_envelope", "ResponseEnvelope".into());
        set(out, "request_roles", roles(&package.request_envelope));
        set(out, "response_roles", roles(&package.response_envelope));
        let results = wire.results.iter().map(|result| {
            let (code, said) = result.code_and_text();
            let value = vec![grouped(code.into()).into(), text(said)];
            Code::named(result.role, Code::call("rt.ResultText", value))
        });
        set(out, "results", Code::call("rt.Results", results));
        set(out, "defaults", defaults(wire));
        for (name, kind) in KINDS {
            let groups = plan.parts(GroupPart::All(kind)).into_iter();
            let groups: Vec<String> = groups.map(|it| format!("*{it}")).collect();
            tuple(out, &format!("{name}="), &groups, ",");
        }
        set(out, RangeUse::PassThrough.name(), ranges(context));
    });
    let mut docs = about::protocol(context.model());
    if let Some(page) = context.page("reference/wire.md") {
        docs.paragraph(page);
    }
    out.docstring(&docs);
}

/// Returns the pass-through ranges.
fn ranges(context: &Context<'_>) -> Code {
    let ranges = pass_through(context).into_iter().map(|(name, range)| {
        let items = vec![
            Code::named("first", range.first_spelling.as_str()),
            Code::named("last", range.last_spelling.as_str()),
            Code::named("method", format!("\"{name}\"")),
        ];
        Code::call("rt.PassThrough", items)
    });
    Code::tuple(ranges.collect())
}

fn header_field(field: &Spelled<'_, HeaderField>) -> Code {
    let mut items = vec![
        literal(&field.name).into(),
        field.ty.size().to_string().into(),
    ];
    if let Some(role) = field.role {
        let role = Case::Screaming.apply(role.name());
        items.push(format!("rt.HeaderRole.{role}").into());
    }
    let mut set = |name: &str, value: &str| items.push(Code::named(name, value));
    if matches!(field.ty, HeaderType::Bytes(_)) {
        set("is_bytes", "True");
    }
    if field.is_sent_as_value() && field.value > 0 {
        set("value", &field.value.to_string());
    }
    if let Some(algorithm) = field.digest() {
        let algorithm = Case::Screaming.apply(algorithm.name());
        set(HeaderRole::Digest.name(), &format!("rt.Digest.{algorithm}"));
    }
    if field.has_quirk(HeaderQuirk::ZeroWhenPlain) {
        set("zero_when_plain", "True");
    }
    Code::call("rt.HeaderField", items)
}

fn defaults(wire: &WireFacts<'_, '_>) -> Code {
    let max_age = wire.max_age_ms.map_or_else(|| "None".to_owned(), seconds);
    let limits = wire.limits;
    let limits = limits.map(|(name, value)| Code::named(name, grouped(value.into())));
    let times = wire.times.iter();
    let mut items: Vec<Code> = times
        .map(|(name, ms)| Code::named(name, seconds(*ms)))
        .collect();
    items.extend([
        Code::named("max_age", max_age),
        Code::named("ack", ack(wire.ack)),
        Code::named("limits", Code::call("rt.Limits", limits)),
    ]);
    Code::call("rt.Defaults", items)
}
