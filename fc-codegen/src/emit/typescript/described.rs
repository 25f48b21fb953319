//! `protocol.ts`: the protocol with its texts and the examples of its messages, for tools that show any frame.
//!
//! The handwritten file `stubs/typescript/src/protocol.ts` declares its shape. Apps load none of it.

use super::context::Context;
use super::layout::Layout;
use super::operations::{code, languages};
use super::source::{head, named};
use super::wire::header;
use crate::sample::{Profile, Samples};
use fc_spec::model::{Direction, Operation, ResultRole, Text};

pub fn file(context: &Context<'_>, samples: &Samples<'_>) -> String {
    let mut out = head(
        context,
        [
            "协议及其文字和示例，供显示任意帧的工具使用。",
            "The protocol with its texts and examples, for tools that show any frame.",
        ],
    );
    named(&mut out, "import type", ["Protocol"], "../src/protocol.ts");
    let operations = &context.model().operations;
    if operations
        .iter()
        .any(|it| it.body(Direction::Request).is_some())
    {
        out.line("import * as schemas from './schemas.ts'");
    }
    out.line("import { wire } from './wire.ts'");
    out.template("described", &[]);
    protocol(context, samples).write(&mut out, "export const protocol: Protocol = ", "");
    out.finish()
}

fn protocol(context: &Context<'_>, samples: &Samples<'_>) -> Layout {
    let model = context.model();
    let frame = &model.frame;
    let of_wire = |path: &str| Layout::word(format!("wire.{path}"));
    let kinds = frame.kinds.each().into_iter().map(|kind| {
        let port = model.transport.ports.get(kind.port).number;
        described(
            &kind.text,
            [
                ("value", Layout::number(kind.value)),
                ("name", Layout::text(&kind.name)),
                ("role", Layout::text(kind.role.name())),
                ("port", Layout::number(port)),
            ],
        )
    });
    let encodings = frame.encodings.iter().map(|encoding| {
        described(
            &encoding.text,
            [
                ("value", Layout::number(encoding.value)),
                ("name", Layout::text(&encoding.name)),
                ("role", Layout::text(encoding.role.name())),
            ],
        )
    });
    let headers = frame.header.iter().map(|field| {
        let names = [
            ("wire", Layout::text(&field.wire)),
            ("name", Layout::text(&field.name)),
        ];
        described(&field.text, names.into_iter().chain(header(field)))
    });
    let results = model.results.iter().map(|result| {
        described(
            &result.text,
            [
                ("code", Layout::number(result.code)),
                ("name", Layout::text(&result.name)),
                (
                    "role",
                    Layout::text_or_null(result.role.map(ResultRole::name)),
                ),
            ],
        )
    });
    let ranges = model.ranges.iter().map(|range| {
        described(
            &range.text,
            [
                ("first", Layout::Number(range.first_spelling.to_lowercase())),
                ("last", Layout::Number(range.last_spelling.to_lowercase())),
                ("use", Layout::text(range.usage.name())),
            ],
        )
    });
    let operations = model.operations.iter();
    let operations = operations.map(|it| operation(context, samples, it));
    Layout::lines([
        ("title", described(&model.protocol.title, [])),
        ("byteOrder", of_wire("frame.byteOrder")),
        ("headerLength", of_wire("frame.headerLength")),
        ("header", Layout::list(headers)),
        ("requestHead", of_wire("frame.requestHead")),
        ("responseHead", of_wire("frame.responseHead")),
        ("kinds", Layout::list(kinds)),
        ("encodings", Layout::list(encodings)),
        ("envelope", of_wire("envelope")),
        ("limits", of_wire("defaults.limits")),
        ("results", Layout::list(results)),
        ("ranges", Layout::list(ranges)),
        ("operations", Layout::list(operations)),
    ])
}

/// Returns an object that ends with its text in both languages.
fn described(text: &Text, members: impl IntoIterator<Item = (&'static str, Layout)>) -> Layout {
    Layout::object(members.into_iter().chain(languages(text)))
}

fn operation(context: &Context<'_>, samples: &Samples<'_>, operation: &Operation) -> Layout {
    let schema = |direction| {
        let body = operation.body(direction);
        let schema = body.map(|it| format!("schemas.{}", context.name_of(&it.ty)));
        Layout::word(schema.unwrap_or_else(|| "null".to_owned()))
    };
    let example = |direction| {
        let body = operation.body(direction);
        let json = body.map(|_| samples.message(operation, direction, Profile::Example));
        Layout::text(&json.map_or_else(String::new, |it| it.to_string()))
    };
    described(
        &operation.title,
        [
            ("name", Layout::text(&operation.name)),
            ("kind", Layout::text(operation.kind().name())),
            ("code", code(operation)),
            ("request", schema(Direction::Request)),
            ("response", schema(Direction::Response)),
            ("requestExample", example(Direction::Request)),
            ("responseExample", example(Direction::Response)),
        ],
    )
}
