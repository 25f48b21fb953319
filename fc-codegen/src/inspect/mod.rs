//! A dump of the resolved model, for other programs.
//!
//! `fcproto inspect --format json` or `yaml` prints it. The dump is the complete input of `fcproto generate --from`,
//! for every product. `fcproto schema dump` prints its JSON Schema.
//!
//! # Format 3
//!
//! `format` increases when a key changes its meaning or is removed. New keys do not increase it. A key that was added
//! after the first dump of a format has a default when it is read, so that older dumps stay readable.
//!
//! A written dump contains all keys named here. A value that does not apply is `null` or `[]`. A *text* is
//! `{ "zh", "en" }`. Dates are `YYYY-MM` or `YYYY-MM-DD`. A *place* is `{ "file", "name", "line" }`. The file is
//! relative to the project's root, and the name contains the keys that lead to the entry. Words such as `command` or
//! `stated` are those of the spec. The JSON Schema of the spec language explains each of them.
//!
//! Some keys are derived from the rest, for programs without a generator. A reader of a dump ignores them:
//! `header_bytes`, `size`, `port`, `fields` of a body, `wire` and `variants` of a type's field, `next`,
//! `open_questions`.
//!
//! Top:
//!
//! - `format`: 3
//! - `protocol`: see below
//! - `groups`: `{ id, zh, en, about, place }`, in the order of their files' names
//! - `operations`: commands, reports and streams, by group, in the order of the files
//! - `types`: declared types and types made for bodies, in the order of the spec
//! - `result_codes`: `{ code, name, role, zh, en, about }`, by number. `role` is the occasion on which the runtime
//!   responds with the code
//! - `ranges`: `{ from, to, from_spelling, to_spelling, use, next, zh, en }`, by number, both ends included. `use` is
//!   `pass_through`, `commands`, `reports`, `reserved` or `historic`. `next` is the code that `fcproto new` assigns
//!   next from `commands` and `reports`. It is `null` for other uses, and in a full range
//! - `retired_codes`: `{ code, spelling, zh, en }`
//! - `tables`: `{ id, row, rows, kept, zh, en, about, place }`, the rows in wire form
//! - `entities`: `{ name, zh, en, place }`, the things that ids in bodies identify
//! - `coordinates`: `{ name, zh, en, about, place }`, the coordinate systems of positions
//! - `stores`: `{ name, zh, en, about, survives_restart, place }`, the stores of data. `survives_restart` is `null` if
//!   it is unknown
//! - `availability`: `{ audiences, hardware, releases }`, lists of `{ name, zh, en, place }`: the words of `available`
//! - `glossary`: `{ id, zh, en, means, also, place }`, the terms of the protocol. `means` is a text. `also` is
//!   `{ zh, en }`, lists of other forms
//! - `waivers`: `{ id, zh, en, by, until, place }`, findings of `fcproto diff` that are accepted for a time. `zh` and
//!   `en` are the reason
//! - `conflicts`: `{ id, category, severity, zh, en }`, gaps and contradictions of the source
//! - `answers`: `{ ids, kind, subject, zh, en, about, runtime, confirmed, place }`, the spec's answers to the
//!   conflicts. `about` are the facts that an answer governs, `{ path, meanwhile }`. `runtime` is `true` if no value of
//!   the spec changes the answer. `confirmed` is the owner's answer, `{ by, date, reference, reply }`
//! - `open_questions`: one entry per gap of the source document, see below
//! - `questions`: the questions that only the owner can answer, the most pressing first:
//!   `{ id, ids, kind, impact, severity, group, subject, zh, en, about, confirmed, edit, place }`. `edit` is a diff of
//!   the lines that an answer changes
//! - `lost_sections`: `{ section, zh, en }`, the sections of the source that are completely lost
//! - `changes`: `{ date, zh, en }`, of the protocol as a whole
//!
//! `protocol`: `id`, `version`, `zh`, `en`, `about` (text), `robot` and `app` (`{ zh, en, about }`), `host`, `ports`
//! (`{ role, number, zh, en }`), `frame`, `json` (a text for each rule), `envelope`, `calls`
//! (`{ timeout_ms, handler_timeout_ms, max_age_ms, ack }`), `limits` (as in the spec).
//!
//! `frame`: `byte_order` (`big`, `little`), `zh` and `en` (of its data area), `header_bytes`, `header`
//! (`{ wire, name, type, offset, size, role, value, quirks, zh, en, aliases }`), `request_head` and `response_head`
//! (lists of bytes), `kinds` (`{ value, name, role, port, zh, en }`), `encodings` (`{ value, name, role, zh, en }`).
//!
//! `envelope`: `request` and `response`, lists of `{ wire, name, type, optional, role, example, zh, en, aliases }`.
//!
//! An operation:
//!
//! - `name`, `kind` (`command`, `report`, `stream`), `kind_state` and `title_state` (`stated`, `confirmed`,
//!   `inferred`), `group`, `zh`, `en`, `about` (text or `null`)
//! - `aliases`: `{ zh, en }`, lists of other words for it
//! - `code` (number or `null`), `code_spelling` (`0x0A01`, `unassigned`), `code_state` (`stated`, `confirmed`,
//!   `inferred`, `open`)
//! - `sender` (`app`, `robot`), `port_role` (`command`, `data`), `port` (its number)
//! - `effect`: `read`, `config`, `motion` or `unknown` for commands; `effect_state` (as `code_state`). Both are `null`
//!   for other operations
//! - `sets_off`: the reports that a command sets off. Each has `report`, its name, and `tied`, the keys that tie it to
//!   a call. Each tie has `side` (`request`, `response`), `command` and `report`, which are lists of keys. `tied` is
//!   `[]` if no key ties the report. `sets_off` is `[]` if the spec lists no reports, and for other operations
//! - `state`: the key of a report with the progress of a process, as a list of keys. It is `null` without such a key,
//!   and for other operations. `failures`: other keys of a report that may show a failure
//! - `kept`: name of the store of the data that the operation reads and sets, or `null`
//! - `accepted`: the conditions under which a command is accepted, `{ in, after, note }`. `in` is `"any"`, `null`, or
//!   `{ states }` with a list of `{ type, values }`: each enum must have one of the values. `after` are the names of
//!   the commands that come first. `note` is a text or `null`. `accepted` is `null` if the spec has no conditions, and
//!   for other operations
//! - `cadence`: the occasions on which a report is sent, one of `{ on_change }` (the path of a field), `{ step }`
//!   (`{ field, by }`), `{ every_ms }` and `{ within_ms }` (after a command that sets it off). It is `null` if the spec
//!   does not specify it, and for other operations. A path is that of a field of the request, without the `[]`
//! - `sections`: section numbers in the source; `lost`: the lost parts of these sections (`title`, `type`, `code`,
//!   `request`, `response`)
//! - `request` and `response`: bodies. The robot sends the request of a report, and the app sends its response. The
//!   request of a stream is its frame. A frame has no envelope, and no fields unless it is JSON
//! - `ack`: `{ timeout_ms, retries }` for reports
//! - `content`: media type of the bytes in a stream's frames. It is `null` if none is stated, for JSON, and for other
//!   operations. `started_by` and `stopped_by`: names of the commands that start and stop a stream, or `null`. A stream
//!   may have the code of the command that starts it
//! - `result_text`: the result text in examples of the response; `null` for the envelope's text
//! - `errors`: `{ code, cause }`, the results other than success that the response may have, by their codes. `cause` is
//!   a text or `null`: the meaning of the result for this operation
//! - `available`: the audience of the operation, `{ for, hardware, from, until }`; `null` for everyone. `for` and
//!   `hardware` are lists of names. `from` and `until` are the first and the last release by series: `{ "adp": "3.8" }`
//! - `since`, `deprecated` (`{ since, replaced_by, zh, en }`), `changes` (`{ date, zh, en }`), `place`
//!
//! A body:
//!
//! - `state` (`stated`, `inferred`, `open`), `note` (text or `null`): the reason for an inferred or open body
//! - `type`: name of its struct; `null` for raw bytes and for an absent body
//! - `fields`: all fields of the body, in order, without the envelope. See below
//!
//! A field of a body:
//!
//! - `path`: wire keys joined by `.`. `[]` denotes each item of a list: `data`, `data.cellDoorList`,
//!   `data.cellDoorList[]`, `data.cellDoorList[].cellId`. An object or a list has an entry before the entries of its
//!   contents
//! - `type`: as the spec writes it, without `?`. An object in place has a generated name
//! - `optional`: `true` if it may be absent although its container is present. The keys of the variants of a choice are
//!   all optional
//! - `wire`: the JSON type on the wire: `bool`, `number`, `string`, `object`, `array`, or `any`
//! - `example`: its value in the composed example; `null` if the example omits it
//! - `variants`: names of the variants that have the key; `[]` outside a choice
//! - `condition`: the values of neighbouring fields for which an optional field is present, and a required one is
//!   valid. `{ when: [{ path, values }] }` requires all entries to hold, and `{ unless: […] }` requires at least one
//!   not to hold. `path` is a wire key, which must have one of `values`. `null` is no condition
//! - `name` (in code), `refers` (name of the entity whose id it holds), `coordinates` (name of the coordinate system of
//!   its object, unless its struct has one), `kept` (name of its store), `unit`, `min`, `max`, `length`
//!   (`[fewest, most]`), `pattern`, `only` (values of its enum; `[]` for all), `default`, `quirks`, `also`,
//!   `sensitive`, `since`, `available`, `deprecated`, `note` (text or `null`). These are empty for an item of a list
//! - `zh`, `en`
//!
//! A type: `name`, `kind` (`struct`, `enum`, `one_of`), `group` (`null` for a type that groups share), `body_of`
//! (`{ operation, side, path }` for made types; `side` is `request` or `response`), `zh`, `en`, `about`, `since`,
//! `changes`, `place`, and
//!
//! - for a struct `state`, `coordinates` (name of its coordinate system, or `null`) and `fields`. The fields are those
//!   of the struct itself, and their `path` is the wire key. In addition to the keys above, they have `wire_form`
//!   (`plain`, `string`, `number`) and `example_is` (`given`, `derived` from the type, or `absent`)
//! - for an enum `repr`, `closed`, `order`, `values`
//!   (`{ value, name, start, then, final, error, zh, en, since, available }`). `then` are the names of the values that
//!   may follow. `order` is `normal` if other changes also occur, `complete` if no others occur, or `null` if the spec
//!   does not specify it. `final`: no value follows. `error`: the value shows a failure
//! - for a choice `variants` (`{ name, type, zh, en, available, deprecated }`)
//!
//! An open question: `id`, `severity` (`high`, `medium`, `low`), `category`, `kind` (`decision`, `quirk`, `note`,
//! `question`), `subject`, `zh` and `en` (the answer), `gap` (text: the gap in the source), `place`, and `answers`.
//! `answers` is a list of all answers with these keys if there are several.
//!
//! A subject is `protocol`, `transport`, `frame`, `frame.<field>`, `envelope`, `envelope.<key>`, `results`,
//! `results.<code>`, `codes`, `operation.<name>`, `type.<name>`, `field.<type>.<key>`, `table.<id>` or
//! `section.<number>`.

mod fields;
mod fingerprint;
mod release_dump;

pub use fingerprint::fingerprint;
pub use release_dump::release_dump;

use crate::sample::Samples;
use fc_spec::model::{
    Answer, AnswerKind, Conflict, Direction, Dump, Location, Model, Severity, Subject, Text,
    TypeShape, Value,
};
use serde::Serialize;

/// Returns the dump as JSON, indented, with a newline at its end.
#[must_use]
pub fn json(model: &Model) -> String {
    let mut out = value(model).pretty();
    out.push('\n');
    out
}

/// Returns the dump as JSON on one line, with the additional key `options`, for a plugin.
#[must_use]
pub fn json_with(model: &Model, options: &impl Serialize) -> String {
    let mut dump = value(model);
    dump.set("options", tree(options));
    dump.to_string()
}

/// Returns the dump as YAML.
#[must_use]
pub fn yaml(model: &Model) -> String {
    serde_yaml::to_string(&value(model)).unwrap_or_default()
}

/// Returns the dump as a value: the serialized model, and the derived keys for programs without a generator.
#[must_use]
pub fn value(model: &Model) -> Value {
    let mut dump = tree(&Dump::from(model));
    if let Some(frame) = dump
        .get_mut("protocol")
        .and_then(|all| all.get_mut("frame"))
    {
        frame.set("header_bytes", tree(&model.frame.header_len()));
        for (view, field) in items(frame, "header").zip(&model.frame.header) {
            view.set("size", tree(&field.ty.size()));
        }
    }
    let samples = Samples::new(model);
    for (view, operation) in items(&mut dump, "operations").zip(&model.operations) {
        let port = model.transport.ports.get(operation.port);
        view.set("port", tree(&port.number));
        for direction in Direction::ALL {
            let body = operation.body(*direction);
            let fields = body.map(|body| fields::of_body(&samples, body));
            if let Some(view) = view.get_mut(direction.name()) {
                view.set("fields", tree(&fields.unwrap_or_default()));
            }
        }
    }
    for (view, ty) in items(&mut dump, "types").zip(&model.types) {
        if let TypeShape::Struct(shape) = &ty.shape {
            for (view, field) in items(view, "fields").zip(&shape.fields) {
                let wire = fields::wire(&model.types, &field.ty, field.wire_form);
                view.set("wire", tree(&wire));
                view.set("variants", Value::Array(Vec::new()));
                if view.get("example").is_none() {
                    view.set("example", Value::Null);
                }
            }
        }
    }
    let taken = model.taken_codes();
    for (view, range) in items(&mut dump, "ranges").zip(&model.ranges) {
        view.set("next", tree(&range.next(&taken)));
    }
    let conflicts = model.conflicts.iter();
    let questions = conflicts.filter_map(|conflict| question(model, conflict));
    dump.set("open_questions", tree(&questions.collect::<Vec<_>>()));
    dump
}

/// Serializes a part to a value.
fn tree(part: &impl Serialize) -> Value {
    // Serializing fails only for keys that are not strings, and a model has none.
    let text = serde_json::to_string(part).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or(Value::Null)
}

/// Returns the items of the list under a key.
fn items<'v>(value: &'v mut Value, key: &str) -> impl Iterator<Item = &'v mut Value> {
    value.get_mut(key).into_iter().flat_map(Value::items_mut)
}

/// A gap of the source, and the spec's answer to it.
#[derive(Serialize)]
struct OpenQuestion<'m> {
    id: &'m str,
    severity: Severity,
    category: &'m str,
    kind: AnswerKind,
    subject: &'m Subject,
    #[serde(flatten)]
    text: &'m Text,
    gap: &'m Text,
    place: &'m Location,
    /// All answers, if there are several.
    answers: Vec<&'m Answer>,
}

/// Returns the open question of a conflict. A checked model has an answer to every conflict.
fn question<'m>(model: &'m Model, conflict: &'m Conflict) -> Option<OpenQuestion<'m>> {
    let answers: Vec<_> = model.answers_to(conflict).collect();
    let first = *answers.first()?;
    Some(OpenQuestion {
        id: &conflict.id,
        severity: conflict.severity,
        category: &conflict.category,
        kind: first.kind,
        subject: &first.subject,
        text: &first.text,
        gap: &conflict.text,
        place: &first.location,
        answers: if answers.len() > 1 {
            answers
        } else {
            Vec::new()
        },
    })
}
