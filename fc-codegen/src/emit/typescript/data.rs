//! What the TypeScript package knows of the protocol as data, for tools that know no type: the frame layout in one
//! module, types and operations in one for each group. Their shape is declared, by hand, in
//! `stubs/typescript/src/protocol.ts`. Apps load none of it, so it stands apart from schemas, which have no texts.

use super::context::Context;
use super::group::Group;
use crate::emit::json::{described, int, object, text};
use crate::sample::{Profile, Samples};
use fc_spec::model::{
    DigestAlgorithm, Direction, EnumValue, EnvelopeField, Field, FieldDetails, HeaderField,
    HeaderQuirk, HeaderRole, HeaderType, Model, Number, Operation, Quirk, ResultRole, Scalar, Text,
    Type, TypeDef, TypeShape, Value, Variant, WireForm,
};

/// `protocol.ts`: what no group has, and the types and operations of all groups.
pub fn file(context: &Context<'_>, groups: &[Group<'_, '_>]) -> String {
    let mut out = "import type { Protocol } from '../src/protocol.ts'\n".to_owned();
    let variables: Vec<String> = groups.iter().map(|it| it.variable("protocol")).collect();
    for (group, variable) in groups.iter().zip(&variables) {
        let (name, path) = (group.name, "/protocol.ts'\n");
        out.extend(["import * as ", variable, " from './groups/", name, path]);
    }
    out.push_str("\n/** The protocol of the spec. */\nexport const protocol: Protocol = ");
    let head = head(context.model()).pretty();
    out.push_str(head.strip_suffix("\n}").unwrap_or(&head));
    for (key, [open, close]) in [("types", ["{", "}"]), ("operations", ["[", "]"])] {
        out.extend([",\n  \"", key, "\": ", open]);
        for variable in &variables {
            out.extend(["\n    ...", variable, ".", key, ","]);
        }
        out.extend(["\n  ", close]);
    }
    out.push_str("\n}\n");
    out
}

/// `protocol.ts` of a group. Types and operations, of which there may be many, are made one by one.
pub fn group(samples: &Samples<'_>, group: &Group<'_, '_>) -> String {
    let mut out = "import type { Operation, TypeDef } from '../../../src/protocol.ts'\n\n\
         /** The types of the group. */\n\
         export const types: Record<string, TypeDef> = "
        .to_owned();
    let types = group.items().iter().map(|item| {
        let key = text(&item.ty.of.name);
        (format!("{key}: "), type_def(item.ty.of))
    });
    spread(&mut out, ['{', '}'], types);
    out.push_str(
        "\n\n/** The operations of the group. */\nexport const operations: Operation[] = ",
    );
    let operations = group.operations.iter();
    let operations = operations.map(|one| (String::new(), operation(samples, one)));
    spread(&mut out, ['[', ']'], operations);
    out.push('\n');
    out
}

/// What no group has.
fn head(model: &Model) -> Value {
    let frame = &model.frame;
    let bytes = |head: &[u8]| Value::Array(head.iter().copied().map(int).collect());
    let byte_order = frame.byte_order.name();
    let result_code = model.envelope.result_code();
    object([
        ("title", described(&model.protocol.title, [])),
        ("byteOrder", text(byte_order)),
        ("headerLength", int(frame.header_len() as u64)),
        ("header", frame.header.iter().map(header_field).collect()),
        ("requestHead", bytes(&frame.request_head)),
        ("responseHead", bytes(&frame.response_head)),
        ("kinds", kinds(model)),
        ("encodings", encodings(model)),
        ("envelope", envelope(model)),
        (
            "resultCodeKey",
            result_code.map_or(Value::Null, |field| text(&field.wire)),
        ),
        ("limits", limits(model)),
        ("results", results(model)),
        ("ranges", ranges(model)),
    ])
}

/// Values in brackets on lines of their own, each behind its key and dropped once it is written.
fn spread(
    out: &mut String,
    [open, close]: [char; 2],
    items: impl Iterator<Item = (String, Value)>,
) {
    out.push(open);
    let mut items = items.peekable();
    let is_empty = items.peek().is_none();
    while let Some((key, value)) = items.next() {
        out.push_str("\n  ");
        out.push_str(&key);
        value.write_pretty(out, 1);
        if items.peek().is_some() {
            out.push(',');
        }
    }
    if !is_empty {
        out.push('\n');
    }
    out.push(close);
}

fn kinds(model: &Model) -> Value {
    let kinds = model.frame.kinds.each().into_iter().map(|kind| {
        let role = kind.role.name();
        let port = model.transport.ports.get(kind.port).number;
        described(
            &kind.text,
            [
                ("value", int(kind.value)),
                ("name", text(&kind.name)),
                ("role", text(role)),
                ("port", int(port)),
            ],
        )
    });
    kinds.collect()
}

fn encodings(model: &Model) -> Value {
    let encodings = model.frame.encodings.iter().map(|encoding| {
        let role = encoding.role.name();
        described(
            &encoding.text,
            [
                ("value", int(encoding.value)),
                ("name", text(&encoding.name)),
                ("role", text(role)),
            ],
        )
    });
    encodings.collect()
}

fn envelope(model: &Model) -> Value {
    let side = |fields: &[EnvelopeField]| fields.iter().map(envelope_field).collect();
    object([
        ("request", side(&model.envelope.request)),
        ("response", side(&model.envelope.response)),
    ])
}

fn limits(model: &Model) -> Value {
    object([
        ("frameBytes", int(model.limits.frame_bytes)),
        ("inflatedBytes", int(model.limits.inflated_bytes)),
        ("jsonDepth", int(model.limits.json_depth)),
    ])
}

fn results(model: &Model) -> Value {
    let results = model.results.iter().map(|result| {
        let role = result.role.map(ResultRole::name);
        described(
            &result.text,
            [
                ("code", int(result.code)),
                ("name", text(&result.name)),
                ("role", role.map_or(Value::Null, text)),
            ],
        )
    });
    results.collect()
}

fn ranges(model: &Model) -> Value {
    let ranges = model.ranges.iter().map(|range| {
        let usage = range.usage.name();
        described(
            &range.text,
            [
                ("first", int(range.first)),
                ("last", int(range.last)),
                ("use", text(usage)),
            ],
        )
    });
    ranges.collect()
}

fn header_field(field: &HeaderField) -> Value {
    let role = field.role.map(HeaderRole::name);
    let algorithm = field.digest().map(DigestAlgorithm::name);
    described(
        &field.text,
        [
            ("wire", text(&field.wire)),
            ("name", text(&field.name)),
            ("offset", int(field.offset as u64)),
            ("size", int(field.ty.size() as u64)),
            (
                "type",
                text(if matches!(field.ty, HeaderType::Bytes(_)) {
                    "bytes"
                } else {
                    "uint"
                }),
            ),
            ("role", role.map_or(Value::Null, text)),
            ("algorithm", algorithm.map_or(Value::Null, text)),
            ("value", int(field.value)),
            (
                "zeroWhenPlain",
                Value::Bool(field.has_quirk(HeaderQuirk::ZeroWhenPlain)),
            ),
        ],
    )
}

/// An envelope key in the form of a field: it has no constraint but its type.
fn envelope_field(field: &EnvelopeField) -> Value {
    member(
        (&field.wire, &field.ty, field.optional),
        WireForm::Plain,
        FieldDetails::none(),
        &field.text,
    )
}

fn field(field: &Field) -> Value {
    member(
        (&field.wire, &field.ty, field.optional),
        field.wire_form,
        field.details(),
        &field.text,
    )
}

fn member(
    (key, ty, optional): (&str, &Type, bool),
    form: WireForm,
    details: &FieldDetails,
    about: &Text,
) -> Value {
    let or_null = |value: Option<Value>| value.unwrap_or(Value::Null);
    let word = |word: &Option<String>| or_null(word.as_deref().map(text));
    // As text: JavaScript rounds integers past 2^53.
    let spelled = |number: &Number| text(&Value::Number(number.clone()).to_string());
    let number = |number: &Option<Number>| or_null(number.as_ref().map(spelled));
    let length = details.length.map(|(low, high)| [low, high].map(int));
    let is = |quirk| Value::Bool(details.quirks.contains(&quirk));
    // Few fields travel so; the others say nothing of it.
    let as_number = (form == WireForm::Number).then_some(("wireNumber", Value::Bool(true)));
    let only = details.only.iter().map(enum_wire);
    let only = (!details.only.is_empty()).then(|| ("only", only.collect()));
    described(
        about,
        [
            ("key", text(key)),
            ("also", details.also.iter().map(|key| text(key)).collect()),
            ("type", type_value(ty)),
            ("optional", Value::Bool(optional)),
            ("unit", word(&details.unit)),
            ("min", number(&details.min)),
            ("max", number(&details.max)),
            ("length", or_null(length.map(Value::from_iter))),
            (
                "pattern",
                or_null(details.pattern.as_ref().map(|it| text(it.portable()))),
            ),
            ("wireString", Value::Bool(form == WireForm::String)),
            ("emptyIsAbsent", is(Quirk::EmptyIsAbsent)),
            ("lenientNumber", is(Quirk::LenientNumber)),
            ("lenientBool", is(Quirk::LenientBool)),
        ]
        .into_iter()
        .chain(as_number)
        .chain(only),
    )
}

fn type_value(ty: &Type) -> Value {
    let is = match ty {
        Type::Bool => "bool",
        Type::Int(kind) => kind.name(),
        Type::Float(kind) => kind.name(),
        Type::String => "string",
        // Signed 64-bit numbers on the wire; their meaning is in the description.
        Type::TimestampMs | Type::TimestampS => "i64",
        Type::Base64 => "base64",
        Type::Json => "json",
        Type::Array(item) => return object([("is", text("array")), ("of", type_value(item))]),
        Type::Named(named) => {
            return object([("is", text("named")), ("name", text(named.name()))]);
        }
    };
    object([("is", text(is))])
}

/// A value of an enum, as text.
fn enum_wire(wire: &Scalar) -> Value {
    match wire {
        Scalar::String(wire) => text(wire),
        other => text(&Value::from(other).to_string()),
    }
}

fn type_def(ty: &TypeDef) -> Value {
    let title = &ty.title;
    match &ty.shape {
        TypeShape::Struct(shape) => {
            let fields = shape.fields.iter().map(field).collect();
            described(title, [("is", text("struct")), ("fields", fields)])
        }
        TypeShape::Enum(shape) => {
            let value = |value: &EnumValue| {
                let entries = [
                    ("wire", enum_wire(&value.wire)),
                    ("name", text(&value.name)),
                ];
                described(&value.text, entries)
            };
            described(
                title,
                [
                    ("is", text("enum")),
                    ("repr", text(shape.repr.name())),
                    ("closed", Value::Bool(shape.closed)),
                    ("values", shape.values.iter().map(value).collect()),
                ],
            )
        }
        TypeShape::OneOf(shape) => {
            let variant = |variant: &Variant| {
                let entries = [
                    ("name", text(&variant.name)),
                    ("type", text(variant.ty.name())),
                ];
                described(&variant.text, entries)
            };
            let variants = shape.variants.iter().map(variant).collect();
            described(title, [("is", text("one_of")), ("variants", variants)])
        }
    }
}

fn operation(samples: &Samples<'_>, operation: &Operation) -> Value {
    let kind = operation.kind().name();
    let body = |direction| {
        let body = operation.body(direction);
        body.map_or(Value::Null, |body| text(body.ty.name()))
    };
    let example = |direction| match operation.body(direction) {
        None => text(""),
        Some(_) => text(
            &samples
                .message(operation, direction, Profile::Example)
                .pretty(),
        ),
    };
    described(
        &operation.title,
        [
            ("name", text(&operation.name)),
            ("kind", text(kind)),
            ("code", operation.code.value.map_or(Value::Null, int)),
            ("request", body(Direction::Request)),
            ("response", body(Direction::Response)),
            ("requestExample", example(Direction::Request)),
            ("responseExample", example(Direction::Response)),
            (
                "stream",
                operation.stream().map_or(Value::Null, |stream| {
                    let name = |name: Option<&str>| name.map_or(Value::Null, text);
                    object([
                        ("from", text(operation.sender.name())),
                        ("content", name(stream.content.media_type())),
                        ("startedBy", name(stream.started_by.as_deref())),
                        ("stoppedBy", name(stream.stopped_by.as_deref())),
                    ])
                }),
            ),
        ],
    )
}
