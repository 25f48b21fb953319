//! What a comment says of a field, an operation or a type beside its prose.

use super::context::{Context, page_of};
use super::docs::Docs;
use super::process;
use super::style::Style;
use crate::package::items::Item;
use fc_spec::model::{
    Accepted, AcceptedIn, Available, Body, BodyState, Cadence, DeclaredError, Deprecation,
    Direction, Effect, EnumValue, Example, Field, Kind, Number, Operation, Quirk, Scalar,
    TypeShape, Value, Variant, WireForm,
};

/// The comment on a struct's field; `condition` says when it is there.
pub fn field_docs<'m>(style: &Style, field: &'m Field, condition: Option<String>) -> Docs<'m> {
    let details = field.details();
    let mut docs = Docs::titled(&field.text);
    docs.texts(details.note.as_ref());
    if let Some(deprecation) = &details.deprecated {
        withdrawn(&mut docs, deprecation);
    }
    let facts: Vec<String> = condition
        .into_iter()
        .chain(field_facts(style, field))
        .collect();
    docs.paragraph(facts.join(" "));
    docs
}

/// The comment on a value of an enum.
pub fn value_docs(value: &EnumValue) -> Docs<'_> {
    let mut docs = Docs::titled(&value.text);
    if let Some(since) = &value.since {
        docs.paragraph(format!("Since {since}."));
    }
    docs.paragraph(value.available.as_ref().map_or_else(String::new, limits));
    docs
}

/// What the comment on a variant of a choice says beside its text.
pub fn variant_end(docs: &mut Docs<'_>, variant: &Variant) {
    if let Some(deprecation) = &variant.deprecated {
        withdrawn(docs, deprecation);
    }
    docs.paragraph(variant.available.as_ref().map_or_else(String::new, limits));
}

/// The comment on a method of an operation, with `more` before the links at its end.
pub fn method_docs<'m>(
    context: &Context<'_>,
    operation: &'m Operation,
    more: impl FnOnce(&mut Docs<'m>),
) -> Docs<'m> {
    let mut docs = operation_docs(operation);
    operation_end(context.style, &mut docs, operation);
    more(&mut docs);
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    docs
}

/// The comment on a method of a command; `declared` is the sentence about the type of its errors.
pub fn command_docs<'m>(
    context: &Context<'_>,
    command: &'m Operation,
    declared: impl FnOnce(&str) -> String,
) -> Docs<'m> {
    let error = context.package.error_type(command).map(declared);
    method_docs(context, command, |docs| docs.raw(error.unwrap_or_default()))
}

/// The same for a method whose call can be followed.
pub fn call_docs<'m>(
    context: &Context<'_>,
    command: &'m Operation,
    declared: impl FnOnce(&str) -> String,
) -> Docs<'m> {
    let error = context.package.error_type(command).map(declared);
    method_docs(context, command, |docs| {
        docs.raw(error.unwrap_or_default());
        process::docs(docs, context, command);
    })
}

/// In which coordinate system something is given.
pub fn coordinates(system: &str) -> String {
    format!("In the coordinate system `{system}`.")
}

/// Where something is kept.
pub fn kept(store: &str) -> String {
    format!("Kept in `{store}`.")
}

/// Entity, place, constraints, unit, example and wire form of a field, a sentence each.
fn field_facts(style: &Style, field: &Field) -> Vec<String> {
    let details = field.details();
    let mut facts = Vec::new();
    if let Some(entity) = &details.refers {
        facts.push(format!("Refers to the entity `{entity}`."));
    }
    if let Some(system) = &details.coordinates {
        facts.push(coordinates(system));
    }
    if let Some(store) = &details.kept {
        facts.push(kept(store));
    }
    if let Some(unit) = &details.unit {
        facts.push(format!("Unit: {unit}."));
    }
    if let Some(range) = range(style, details.min.as_ref(), details.max.as_ref()) {
        facts.push(format!("Range: `{range}`."));
    }
    if let Some((least, most)) = details.length {
        facts.push(if least == most {
            format!("Length: {least}.")
        } else {
            format!("Length: {least} to {most}.")
        });
    }
    if let Some(pattern) = &details.pattern {
        facts.push(format!("Pattern: {}.", code(pattern.source())));
    }
    if !details.only.is_empty() {
        let taken: Vec<String> = details
            .only
            .iter()
            .map(|it| code(&scalar(style, it)))
            .collect();
        facts.push(format!("Only {}.", taken.join(", ")));
    }
    if let Some(default) = &details.default {
        facts.push(format!("Absent means {}.", code(&scalar(style, default))));
    }
    if let Example::Given(value) = &field.example {
        let value = value.to_string();
        // A long one is on the documentation's page.
        if value.chars().count() <= 60 {
            facts.push(format!("Example: {}.", code(&value)));
        }
    }
    match field.wire_form {
        WireForm::Plain => {}
        WireForm::String => facts.push("Sent as a JSON string.".to_owned()),
        WireForm::Number => facts.push("Sent as `1` for true and `0` for false.".to_owned()),
    }
    for quirk in &details.quirks {
        facts.push(
            match (quirk, field.wire_form) {
                (Quirk::EmptyIsAbsent, _) => "`null`, `{}`, `[]` and `\"\"` are read as absent.",
                (Quirk::LenientNumber, _) => "Also read from a string of digits.",
                (Quirk::LenientBool, WireForm::Number) => {
                    "Also read from `true`, `false`, `\"true\"` and `\"false\"`."
                }
                (Quirk::LenientBool, WireForm::Plain | WireForm::String) => {
                    "Also read from `\"true\"`, `\"false\"`, `0` and `1`."
                }
            }
            .to_owned(),
        );
    }
    if !details.also.is_empty() {
        let keys: Vec<String> = details.also.iter().map(|key| code(key)).collect();
        facts.push(format!("Also read from the key {}.", keys.join(", ")));
    }
    if field.sensitive {
        facts.push(style.redacted.to_owned());
    }
    if let Some(since) = &details.since {
        facts.push(format!("Since {since}."));
    }
    facts.extend(details.available.as_ref().map(limits));
    facts
}

/// For whom a thing is, on which machines and in which releases, by the names of the spec.
pub fn limits(available: &Available) -> String {
    let spans = |names: &[String]| {
        let names: Vec<String> = names.iter().map(|name| code(name)).collect();
        names.join(", ")
    };
    let mut limits = Vec::new();
    if !available.audiences.is_empty() {
        limits.push(format!("Only for {}.", spans(&available.audiences)));
    }
    if !available.hardware.is_empty() {
        limits.push(format!("Only on {}.", spans(&available.hardware)));
    }
    for (series, first, last) in available.releases() {
        let first = first.map(|first| format!(" from {first}"));
        let last = last.map(|last| format!(" until {last}"));
        let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
        limits.push(format!("Only in {}{first}{last}.", code(series)));
    }
    limits.join(" ")
}

/// What every comment on an operation starts with: title, description, what is withdrawn.
pub fn operation_docs(operation: &Operation) -> Docs<'_> {
    let mut docs = Docs::titled(&operation.title);
    docs.texts(operation.about.as_ref());
    if let Some(deprecation) = &operation.deprecated {
        withdrawn(&mut docs, deprecation);
    }
    docs
}

/// The end of what a comment says of an operation: its facts in one paragraph, then what its errors mean.
pub fn operation_end<'m>(style: &Style, docs: &mut Docs<'m>, operation: &'m Operation) {
    docs.paragraph(operation_facts(style, operation));
    docs.texts(
        operation
            .accepted()
            .and_then(|accepted| accepted.note.as_ref()),
    );
    for DeclaredError { code, cause } in &operation.errors {
        if let Some(cause) = cause {
            docs.paragraph(format!("`{code}`：{}", cause.zh));
            docs.paragraph(format!("`{code}`: {}", cause.en));
        }
    }
}

/// Code, effect, store and age of an operation, and how the results besides success are numbered.
pub fn operation_facts(style: &Style, operation: &Operation) -> String {
    let mut facts = Vec::new();
    facts.push(match (operation.code.value, operation.code.state) {
        (None, _) => "No code yet: types only.".to_owned(),
        (Some(_), BodyState::Inferred) => format!("Code {}, inferred.", operation.code.spelling),
        (Some(_), _) => format!("Code {}.", operation.code.spelling),
    });
    if let Some(effect) = operation.effect() {
        let effect = match effect {
            Effect::Read => "Only reads",
            Effect::Config => "Changes the configuration",
            Effect::Motion => "Moves the robot",
            Effect::Unknown => "Unknown effect: treat it as a command that moves the robot",
        };
        facts.push(match operation.effect_state() {
            Some(BodyState::Inferred) => format!("{effect}, inferred."),
            _ => format!("{effect}."),
        });
    }
    facts.extend(operation.kept.as_deref().map(kept));
    facts.extend(operation.accepted().into_iter().flat_map(accepted_facts));
    facts.extend(operation.cadence().map(|it| cadence_fact(style, it)));
    if let Some(stream) = operation.stream() {
        let content = stream.content.media_type();
        facts.extend(content.map(|content| format!("Carries `{content}`.")));
        let by = |what, by: Option<&String>| by.map(|by| format!("{what} by `{by}`."));
        facts.extend(by("Started", stream.started_by.as_ref()));
        facts.extend(by("Stopped", stream.stopped_by.as_ref()));
    }
    if !operation.errors.is_empty() {
        let codes: Vec<String> = operation
            .errors
            .iter()
            .map(|error| format!("`{}`", error.code))
            .collect();
        facts.push(format!("May be refused with {}.", codes.join(", ")));
    }
    if let Some(since) = &operation.since {
        facts.push(format!("Since {since}."));
    }
    facts.extend(operation.available.as_ref().map(limits));
    facts.join(" ")
}

/// What has to hold before a command is accepted, a sentence each.
fn accepted_facts(accepted: &Accepted) -> Vec<String> {
    let mut facts = Vec::new();
    match &accepted.states {
        None => {}
        Some(AcceptedIn::Any) => facts.push("Accepted in any state.".to_owned()),
        Some(AcceptedIn::States(sets)) => {
            let sets: Vec<String> = sets
                .iter()
                .map(|set| {
                    let values = set.values.iter();
                    let values: Vec<String> = values
                        .map(|value| format!("`{}`", Value::from(value)))
                        .collect();
                    format!("`{}` is {}", set.ty, values.join(" or "))
                })
                .collect();
            facts.push(format!("Accepted only when {}.", sets.join(", and ")));
        }
    }
    if !accepted.after.is_empty() {
        let names: Vec<String> = accepted
            .after
            .iter()
            .map(|name| format!("`{name}`"))
            .collect();
        facts.push(format!("Send first: {}.", names.join(", ")));
    }
    facts
}

/// When a report is sent.
fn cadence_fact(style: &Style, cadence: &Cadence) -> String {
    match cadence {
        Cadence::OnChange(field) => format!("Sent at each change of `{field}`."),
        Cadence::Step(step) => format!(
            "Sent at each step of {} of `{}`.",
            number(style, &step.by),
            step.field
        ),
        Cadence::EveryMs(ms) => format!("Sent every {ms} ms."),
        Cadence::WithinMs(ms) => format!("Sent within {ms} ms of a command that sets it off."),
    }
}

/// Says how sure a body is, where the source does not state it.
pub fn body_state(docs: &mut Docs<'_>, body: &Body) {
    let (zh, en) = match body.state {
        BodyState::Free | BodyState::Stated | BodyState::Confirmed => ("", ""),
        BodyState::Inferred => ("推断：", "Inferred: "),
        BodyState::Open => ("待定：", "Open: "),
    };
    match (&body.note, body.state) {
        (Some(note), _) => {
            docs.paragraph(format!("{zh}{}", note.zh));
            docs.paragraph(format!("{en}{}", note.en));
        }
        (None, BodyState::Stated | BodyState::Confirmed) => {}
        (None, BodyState::Free) => {
            docs.paragraph("有意不限定键，所有键原样保留。");
            docs.paragraph("Any keys, by design; every key is kept unchanged.");
        }
        (None, BodyState::Inferred) => {
            docs.paragraph("推断：依据源文档的其他部分。");
            docs.paragraph("Inferred: from other parts of the source document.");
        }
        (None, BodyState::Open) => {
            docs.paragraph("待定：源文档缺失，所有键原样保留。");
            docs.paragraph("Open: missing from the source document; every key is kept unchanged.");
        }
    }
}

/// The title of an operation with the side that a body is.
pub fn side_docs(operation: &Operation, direction: Direction) -> Docs<'static> {
    let (zh, en) = match (operation.kind(), direction) {
        (Kind::Command, Direction::Request) => ("：请求", ": request"),
        (Kind::Command, Direction::Response) => ("：响应", ": response"),
        (_, Direction::Request) => ("", ""),
        (_, Direction::Response) => ("：应答", ": acknowledgement"),
    };
    let title = &operation.title;
    let (zh, en) = (format!("{}{zh}", title.zh), format!("{}{en}", title.en));
    let is_same = zh == en;
    let mut docs = Docs::default();
    docs.paragraph(zh);
    if !is_same {
        docs.paragraph(en);
    }
    docs
}

/// Why something is withdrawn and what to use instead, for a comment.
pub fn withdrawn(docs: &mut Docs<'_>, deprecation: &Deprecation) {
    docs.paragraph(format!("已弃用：{}", deprecation.note.zh));
    docs.paragraph(format!("Deprecated: {}", withdrawn_note(deprecation)));
}

/// The same as one English line, for an attribute.
pub fn withdrawn_note(deprecation: &Deprecation) -> String {
    let note = deprecation.note.en.trim();
    let since = deprecation
        .since
        .as_ref()
        .map(|since| format!("since {since}: "));
    let since = since.unwrap_or_default();
    match &deprecation.replaced_by {
        Some(other) => {
            let stop = if note.ends_with(['.', '!', '?']) {
                ""
            } else {
                "."
            };
            format!("{since}{note}{stop} Use `{other}` instead.")
        }
        None => format!("{since}{note}"),
    }
}

fn range(style: &Style, min: Option<&Number>, max: Option<&Number>) -> Option<String> {
    match (min, max) {
        (None, None) => None,
        (Some(min), None) => Some(format!("{}..", number(style, min))),
        (None, Some(max)) => Some(format!("..={}", number(style, max))),
        (Some(min), Some(max)) => Some(format!("{}..={}", number(style, min), number(style, max))),
    }
}

/// A number as it stands in source text.
fn number(style: &Style, number: &Number) -> String {
    match number {
        Number::Int(value) => (style.integer)(*value),
        Number::Float(value) => format!("{value:?}"),
    }
}

fn scalar(style: &Style, scalar: &Scalar) -> String {
    match scalar {
        Scalar::Bool(value) => value.to_string(),
        Scalar::Number(value) => number(style, value),
        Scalar::String(text) => format!("{text:?}"),
    }
}

/// A code span, with as many backticks as its text calls for.
pub fn code(text: &str) -> String {
    if !text.contains('`') {
        return ["`", text, "`"].concat();
    }
    let mut mark = "``".to_owned();
    while text.contains(&mark) {
        mark.push('`');
    }
    let pad = if text.starts_with('`') || text.ends_with('`') {
        " "
    } else {
        ""
    };
    format!("{mark}{pad}{text}{pad}{mark}")
}

/// The comment on a message that is a whole body.
pub fn body_docs<'m>(
    context: &Context<'_>,
    operation: &'m Operation,
    direction: Direction,
) -> Docs<'m> {
    let mut docs = side_docs(operation, direction);
    if direction == Direction::Request {
        docs.texts(operation.about.as_ref());
        if let Some(deprecation) = &operation.deprecated {
            withdrawn(&mut docs, deprecation);
        }
    }
    if let Some(body) = operation.body(direction) {
        body_state(&mut docs, body);
    }
    if direction == Direction::Request {
        operation_end(context.style, &mut docs, operation);
    }
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    docs
}

/// What is said of a type that may be the body of an operation: then of the operation, and which side it is.
pub fn item_docs<'m>(context: &Context<'_>, item: &Item<'m>) -> Docs<'m> {
    match item.body_of() {
        Some((operation, direction)) => body_docs(context, operation, direction),
        None => type_docs(context, item),
    }
}

/// The comment on a type that is not a whole body.
pub fn type_docs<'m>(context: &Context<'_>, item: &Item<'m>) -> Docs<'m> {
    let ty = item.ty.of;
    let mut docs = Docs::titled(&ty.title);
    docs.texts(ty.about.as_ref());
    if let TypeShape::Struct(shape) = &ty.shape
        && let Some(system) = &shape.coordinates
    {
        docs.paragraph(coordinates(system));
    }
    if let Some(since) = &ty.since {
        docs.paragraph(format!("Since {since}."));
    }
    if let Some(place) = &ty.body_of
        && let Some(body) = item.operation.and_then(|it| it.body(place.side))
    {
        let body = context.name_of(&body.ty);
        let body = (context.style.link)(body);
        docs.raw(format!("`{}` of {body}.", place.path.join(".")));
    }
    let page = item.operation.map(page_of);
    let page = page.unwrap_or_else(|| "reference/types.md".to_owned());
    docs.paragraph(context.links(&ty.location, &page));
    docs
}
