//! Sentences and paragraphs that comments on fields, operations and types add to the spec's prose.

use super::context::{Context, page_of};
use super::docs::Docs;
use super::process;
use super::style::Style;
use crate::package::items::Item;
use crate::package::joined::Joined;
use fc_spec::model::{
    Accepted, AcceptedIn, Argument, Available, Body, BodyState, Cadence, Constraint, DeclaredError,
    Deprecation, Direction, Effect, EnumValue, Example, Field, Kind, Number, Operation, Quirk,
    Scalar, TypeShape, Value, Variant, WireForm,
};

/// Returns the comment on a struct's field. `condition` is the sentence about its presence.
pub fn field_docs<'m>(style: &Style, field: &'m Field, condition: Option<String>) -> Docs<'m> {
    let details = field.details();
    let mut docs = Docs::titled(&field.text);
    docs.texts(details.note.as_ref());
    withdrawn(&mut docs, details.deprecated.as_ref());
    let facts = condition.into_iter().chain(field_facts(style, field));
    docs.paragraph(facts.joined(" "));
    docs
}

/// Returns the comment on a value of an enum.
pub fn value_docs(value: &EnumValue) -> Docs<'_> {
    let mut docs = Docs::titled(&value.text);
    docs.paragraph(since(value.since.as_ref()).unwrap_or_default());
    docs.paragraph(value.available.as_ref().map_or_else(String::new, limits));
    docs
}

/// Adds the deprecation and the limits of a variant to its comment.
pub fn variant_end(docs: &mut Docs<'_>, variant: &Variant) {
    withdrawn(docs, variant.deprecated.as_ref());
    docs.paragraph(variant.available.as_ref().map_or_else(String::new, limits));
}

/// Returns the comment on an operation's method. `more` adds text before the links at the end.
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

/// Returns the comment on a command's method. `declared` writes the sentence about its error type.
pub fn command_docs<'m>(
    context: &Context<'_>,
    command: &'m Operation,
    declared: impl FnOnce(&str) -> String,
) -> Docs<'m> {
    let error = context.package.error_type(command).map(declared);
    method_docs(context, command, |docs| docs.raw(error.unwrap_or_default()))
}

/// Returns the comment on a command's method whose call can be followed.
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

/// Returns the sentence about the coordinate system.
pub fn coordinates(system: &str) -> String {
    format!("In the coordinate system `{system}`.")
}

/// Returns the sentence about the store that keeps a thing.
pub fn kept(store: &str) -> String {
    format!("Kept in `{store}`.")
}

/// Returns one sentence for each fact of a field: entity, place, constraints, unit, example and wire form.
fn field_facts(style: &Style, field: &Field) -> Vec<String> {
    let details = field.details();
    let mut facts = Vec::new();
    let refers = details.refers.as_ref();
    facts.extend(refers.map(|entity| format!("Refers to the entity `{entity}`.")));
    facts.extend(details.coordinates.as_deref().map(coordinates));
    facts.extend(details.kept.as_deref().map(kept));
    facts.extend(details.unit.as_ref().map(|unit| format!("Unit: {unit}.")));
    let constraints = &details.constraints;
    let range = range(style, constraints.min.as_ref(), constraints.max.as_ref());
    facts.extend(range.map(|range| format!("Range: `{range}`.")));
    facts.extend(constraints.iter().filter_map(|it| constraint(style, it)));
    let default = details.default.as_ref().map(|it| code(&scalar(style, it)));
    facts.extend(default.map(|default| format!("Absent means {default}.")));
    if let Example::Given(value) = &field.example {
        let value = value.to_string();
        // The documentation's page shows long examples.
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
        facts.push(format!("Also read from the key {}.", codes(&details.also)));
    }
    if field.sensitive {
        facts.push(style.redacted.to_owned());
    }
    facts.extend(since(details.since.as_ref()));
    facts.extend(details.available.as_ref().map(limits));
    facts
}

/// Returns the sentences about audiences, hardware and releases, with the names of the spec.
pub fn limits(available: &Available) -> String {
    let mut limits = Vec::new();
    if !available.audiences.is_empty() {
        limits.push(format!("Only for {}.", codes(&available.audiences)));
    }
    if !available.hardware.is_empty() {
        limits.push(format!("Only on {}.", codes(&available.hardware)));
    }
    for (series, first, last) in available.releases() {
        let first = first.map(|first| format!(" from {first}"));
        let last = last.map(|last| format!(" until {last}"));
        let (first, last) = (first.unwrap_or_default(), last.unwrap_or_default());
        limits.push(format!("Only in {}{first}{last}.", code(series)));
    }
    limits.join(" ")
}

/// Returns the start of every comment on an operation: title, description and deprecation.
pub fn operation_docs(operation: &Operation) -> Docs<'_> {
    let mut docs = Docs::titled(&operation.title);
    docs.texts(operation.about.as_ref());
    withdrawn(&mut docs, operation.deprecated.as_ref());
    docs
}

/// Adds the facts of an operation as one paragraph, then the causes of its errors.
pub fn operation_end<'m>(style: &Style, docs: &mut Docs<'m>, operation: &'m Operation) {
    docs.paragraph(operation_facts(style, operation));
    docs.texts(
        operation
            .accepted()
            .and_then(|accepted| accepted.note.as_ref()),
    );
    for DeclaredError { code, cause } in &operation.errors {
        if let Some(cause) = cause {
            let zh = format!("`{code}`：{}", cause.zh);
            docs.both([zh, format!("`{code}`: {}", cause.en)]);
        }
    }
}

/// Returns the facts of an operation: code, effect, store, conditions, stream content, errors and releases.
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
        let errors = operation.errors.iter();
        let errors = errors.map(|error| format!("`{}`", error.code));
        facts.push(format!("May be refused with {}.", errors.joined(", ")));
    }
    facts.extend(since(operation.since.as_ref()));
    facts.extend(operation.available.as_ref().map(limits));
    facts.join(" ")
}

/// Returns one sentence for each condition under which a command is accepted.
fn accepted_facts(accepted: &Accepted) -> Vec<String> {
    let mut facts = Vec::new();
    match &accepted.states {
        None => {}
        Some(AcceptedIn::Any) => facts.push("Accepted in any state.".to_owned()),
        Some(AcceptedIn::States(sets)) => {
            let sets = sets.iter().map(|set| {
                let values = set.values.iter();
                let values = values.map(|value| format!("`{}`", Value::from(value)));
                format!("`{}` is {}", set.ty, values.joined(" or "))
            });
            facts.push(format!("Accepted only when {}.", sets.joined(", and ")));
        }
    }
    if !accepted.after.is_empty() {
        facts.push(format!("Send first: {}.", codes(&accepted.after)));
    }
    facts
}

/// Returns the sentence about the occasions on which a report is sent.
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

/// Adds a note on how certain a body is, unless the source states it.
pub fn body_state(docs: &mut Docs<'_>, body: &Body) {
    let (zh, en) = match body.state {
        BodyState::Free | BodyState::Stated | BodyState::Confirmed => ("", ""),
        BodyState::Inferred => ("推断：", "Inferred: "),
        BodyState::Open => ("待定：", "Open: "),
    };
    match (&body.note, body.state) {
        (Some(note), _) => {
            docs.both([format!("{zh}{}", note.zh), format!("{en}{}", note.en)]);
        }
        (None, BodyState::Stated | BodyState::Confirmed) => {}
        (None, BodyState::Free) => docs.both([
            "有意不限定键，所有键原样保留。",
            "Any keys, by design; every key is kept unchanged.",
        ]),
        (None, BodyState::Inferred) => docs.both([
            "推断：依据源文档的其他部分。",
            "Inferred: from other parts of the source document.",
        ]),
        (None, BodyState::Open) => docs.both([
            "待定：源文档缺失，所有键原样保留。",
            "Open: missing from the source document; every key is kept unchanged.",
        ]),
    }
}

/// Returns the title of an operation, with the side of the body.
pub fn side_docs(operation: &Operation, direction: Direction) -> Docs<'static> {
    let (zh, en) = match (operation.kind(), direction) {
        (Kind::Command, Direction::Request) => ("：请求", ": request"),
        (Kind::Command, Direction::Response) => ("：响应", ": response"),
        (_, Direction::Request) => ("", ""),
        (_, Direction::Response) => ("：应答", ": acknowledgement"),
    };
    let title = &operation.title;
    Docs::said([format!("{}{zh}", title.zh), format!("{}{en}", title.en)])
}

/// Adds the reason for a deprecation, and the replacement.
fn withdrawn(docs: &mut Docs<'_>, deprecation: Option<&Deprecation>) {
    if let Some(deprecation) = deprecation {
        let zh = format!("已弃用：{}", deprecation.note.zh);
        docs.both([zh, format!("Deprecated: {}", withdrawn_note(deprecation))]);
    }
}

/// Returns the sentence about the release that added a part of the spec.
pub fn since(release: Option<&String>) -> Option<String> {
    release.map(|release| format!("Since {release}."))
}

/// Returns the deprecation as one English line, for an attribute.
pub fn withdrawn_note(deprecation: &Deprecation) -> String {
    let note = deprecation.note.en.trim();
    let since = deprecation.since.as_ref();
    let since = since.map(|since| format!("since {since}: "));
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

/// Returns the sentence about a constraint. `None` for `min` and `max`, which share a sentence.
fn constraint(style: &Style, constraint: Constraint<'_>) -> Option<String> {
    if matches!(constraint, Constraint::Min(_) | Constraint::Max(_)) {
        return None;
    }
    let name = titled(constraint.name());
    Some(match constraint.argument() {
        Argument::Number(value) => format!("{name}: {}.", code(&number(style, value))),
        Argument::Range(least, most) if least == most => format!("{name}: {least}."),
        Argument::Range(least, most) => format!("{name}: {least} to {most}."),
        Argument::Pattern(pattern) => format!("{name}: {}.", code(pattern.source())),
        Argument::Values(taken) => {
            let taken = taken.iter().map(|it| code(&scalar(style, it)));
            format!("{name} {}.", taken.joined(", "))
        }
    })
}

/// Returns a key as the start of a sentence: `length` as `Length`.
fn titled(key: &str) -> String {
    let mut letters = key.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    let name: String = first.into_iter().chain(letters).collect();
    name.replace('_', " ")
}

fn range(style: &Style, min: Option<&Number>, max: Option<&Number>) -> Option<String> {
    match (min, max) {
        (None, None) => None,
        (Some(min), None) => Some(format!("{}..", number(style, min))),
        (None, Some(max)) => Some(format!("..={}", number(style, max))),
        (Some(min), Some(max)) => Some(format!("{}..={}", number(style, min), number(style, max))),
    }
}

/// Returns a number as source text.
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

/// Returns names as code spans with commas between them.
fn codes(names: &[String]) -> String {
    names.iter().map(|name| code(name)).joined(", ")
}

/// Returns a code span with as many backticks as the text needs.
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

/// Returns the short comment on a constant of an operation. The methods have the long one.
pub fn constant_docs<'m>(context: &Context<'_>, operation: &'m Operation) -> Docs<'m> {
    let mut docs = Docs::titled(&operation.title);
    docs.paragraph(operation_facts(context.style, operation));
    docs
}

/// Returns the comment on a message that is a whole body. The methods of a command describe it, so its request only has
/// its title and its links.
pub fn body_docs<'m>(
    context: &Context<'_>,
    operation: &'m Operation,
    direction: Direction,
) -> Docs<'m> {
    let mut docs = side_docs(operation, direction);
    let has_methods = operation.kind() == Kind::Command && operation.code.value.is_some();
    let is_described = direction == Direction::Request && !has_methods;
    if is_described {
        docs.texts(operation.about.as_ref());
    }
    if direction == Direction::Request {
        withdrawn(&mut docs, operation.deprecated.as_ref());
    }
    if let Some(body) = operation.body(direction) {
        body_state(&mut docs, body);
    }
    if is_described {
        operation_end(context.style, &mut docs, operation);
    }
    docs.paragraph(context.links(&operation.location, &page_of(operation)));
    docs
}

/// Returns the comment on a message type. The comment on a whole body describes the operation and the side.
pub fn item_docs<'m>(context: &Context<'_>, item: &Item<'m>) -> Docs<'m> {
    match item.body_of() {
        Some((operation, direction)) => body_docs(context, operation, direction),
        None => type_docs(context, item),
    }
}

/// Returns the comment on a type that is not a whole body.
pub fn type_docs<'m>(context: &Context<'_>, item: &Item<'m>) -> Docs<'m> {
    let ty = item.ty.of;
    let mut docs = Docs::titled(&ty.title);
    docs.texts(ty.about.as_ref());
    if let TypeShape::Struct(shape) = &ty.shape
        && let Some(system) = &shape.coordinates
    {
        docs.paragraph(coordinates(system));
    }
    docs.paragraph(since(ty.since.as_ref()).unwrap_or_default());
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
