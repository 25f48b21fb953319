//! A dump of the resolved model, for other programs: `fcproto inspect --format json` or `yaml`. It is all that
//! `fcproto generate --from` needs, whatever the product; `fcproto schema dump` is its JSON Schema.
//!
//! # Format 3
//!
//! `format` counts up when a key changes its meaning or goes. New keys do not change it: one that came after the
//! first dump of a format has a default where it is read, so that dumps that were kept stay readable. All keys named
//! here are there in what is written; what does not apply is `null` or `[]`. A *text* is `{ "zh", "en" }`. Dates
//! are `YYYY-MM` or `YYYY-MM-DD`. A *place* is `{ "file", "name", "line" }`, the file from the
//! project's root, the name being the keys that lead to the entry. Words such as `command` or `stated` are those
//! of the spec; the JSON Schema of the spec language says what each means.
//!
//! What is worked out from the rest, for those who have no generator of their own, is passed over when a dump is
//! read: `header_bytes`, `size`, `port`, `fields` of a body, `wire` and `variants` of a type's field, `next`,
//! `open_questions`.
//!
//! Top:
//!
//! - `format`: 3
//! - `protocol`: see below
//! - `groups`: `{ id, zh, en, about, place }`, in the order of their files' names
//! - `operations`: commands, reports and streams, by group, in the order of the files
//! - `types`: declared types and those made for bodies, as they stand in the spec
//! - `result_codes`: `{ code, name, role, zh, en, about }`, by number; `role` says when the engine itself
//!   answers with it
//! - `ranges`: `{ from, to, from_spelling, to_spelling, use, next, zh, en }`, by number, both ends included; `use` is
//!   `pass_through`, `commands`, `reports`, `reserved` or `historic`, `next` the code that `fcproto new` gives next
//!   from `commands` and `reports`, `null` elsewhere and where none is left
//! - `retired_codes`: `{ code, spelling, zh, en }`
//! - `tables`: `{ id, row, rows, kept, zh, en, about, place }`, the rows in wire form
//! - `entities`: `{ name, zh, en, place }`, what the ids in bodies stand for
//! - `coordinates`: `{ name, zh, en, about, place }`, the coordinate systems in which positions are given
//! - `stores`: `{ name, zh, en, about, survives_restart, place }`, where things are kept; `survives_restart` is `null`
//!   where nothing is known
//! - `availability`: `{ audiences, hardware, releases }`, lists of `{ name, zh, en, place }`: the words of `available`
//! - `glossary`: `{ id, zh, en, means, also, place }`, the terms of the protocol; `means` is a text, `also` `{ zh, en }`,
//!   lists of other forms
//! - `waivers`: `{ id, zh, en, by, until, place }`, findings of `fcproto diff` that are accepted for a time; `zh` and `en` say why
//! - `conflicts`: `{ id, category, severity, zh, en }`, what the source lacks or contradicts
//! - `answers`: `{ ids, kind, subject, zh, en, about, runtime, confirmed, place }`, what the spec answers to them;
//!   `about` are the facts that it governs, `{ path, meanwhile }`, `runtime` says that no value of the spec changes it, and
//!   `confirmed` the owner's word, `{ by, date, reference, reply }`
//! - `open_questions`: one entry per gap of the source document, see below
//! - `questions`: what only the owner can say, the most pressing first: `{ id, ids, kind, impact, severity, group,
//!   subject, zh, en, about, confirmed, edit, place }`; `edit` is a diff of the lines that an answer changes
//! - `lost_sections`: `{ section, zh, en }`, the sections of the source of which nothing is left
//! - `changes`: `{ date, zh, en }`, of the protocol as a whole
//!
//! `protocol`: `id`, `version`, `zh`, `en`, `about` (text), `robot` and `app` (`{ zh, en, about }`), `host`,
//! `ports` (`{ role, number, zh, en }`), `frame`, `json` (a text for each rule), `envelope`, `calls`
//! (`{ timeout_ms, handler_timeout_ms, max_age_ms, ack }`), `limits` (as in the spec).
//! `frame`: `byte_order` (`big`, `little`), `zh` and `en` (of its data area), `header_bytes`, `header`
//! (`{ wire, name, type, offset, size, role, value, quirks, zh, en, aliases }`), `request_head` and `response_head` (lists of bytes),
//! `kinds` (`{ value, name, role, port, zh, en }`), `encodings` (`{ value, name, role, zh, en }`).
//! `envelope`: `request` and `response`, lists of `{ wire, name, type, optional, role, example, zh, en, aliases }`.
//!
//! An operation:
//!
//! - `name`, `kind` (`command`, `report`, `stream`), `kind_state` and `title_state` (`stated`, `confirmed`,
//!   `inferred`), `group`, `zh`, `en`, `about` (text or `null`)
//! - `aliases`: `{ zh, en }`, lists of other words for it
//! - `code` (number or `null`), `code_spelling` (`0x0A01`, `unassigned`), `code_state` (`stated`, `confirmed`, `inferred`,
//!   `open`)
//! - `sender` (`app`, `robot`), `port_role` (`command`, `data`), `port` (its number)
//! - `effect`: `read`, `config`, `motion` or `unknown` for commands; `effect_state` (as `code_state`); both
//!   `null` elsewhere
//! - `sets_off`: what a command sets off, each with `report`, its name, and `tied`: the keys by which it belongs to a
//!   call, each with `side` (`request`, `response`), `command` and `report`, which are lists of keys; `[]` where nothing
//!   ties them. `[]` where nothing is said, and elsewhere
//! - `state`: the key of a report that says how far a process has come, as a list of keys; `null` where there is none, and
//!   elsewhere; `failures`: other keys of a report that may say that something failed
//! - `kept`: name of the store in which what it reads and sets is kept, or `null`
//! - `accepted`: what has to hold before a command is accepted, `{ in, after, note }`: `in` is `"any"`, `{ states }` with a list of
//!   `{ type, values }`, enums and the values of which each must have one, or `null`; `after` are the names of the commands
//!   that come first; `note` (text or `null`). `null` where nothing is said, and elsewhere
//! - `cadence`: when a report is sent, one of `{ on_change }` (the path of a field), `{ step }` (`{ field, by }`), `{ every_ms }` and
//!   `{ within_ms }` (after a command that sets it off);
//!   `null` where nothing is said, and elsewhere. A path is that of a field of the request, without the `[]`
//! - `sections`: numbers in the source; `lost`: what of them is lost (`title`, `type`, `code`, `request`, `response`)
//! - `request` and `response`: bodies. The request of a report is what the robot sends, its response what the app
//!   answers. The request of a stream is its frame, which has no envelope, and no fields where it is not JSON
//! - `ack`: `{ timeout_ms, retries }` for reports
//! - `content`: media type of the bytes in a stream's frames; `null` where none is stated, where they are JSON, and
//!   elsewhere. `started_by` and `stopped_by`: names of the commands that start and stop a stream, or `null`; a stream
//!   may have the code of the command that starts it
//! - `result_text`: the result text in examples of its response; `null` where the envelope's stands
//! - `errors`: `{ code, cause }`, the results it may answer besides success, by their codes; `cause` (text or `null`) is
//!   what one means for this operation
//! - `available`: for whom it is, `{ for, hardware, from, until }`; `null` for everyone. `for` and `hardware` are lists of
//!   names, `from` and `until` the first and the last release by series: `{ "adp": "3.8" }`
//! - `since`, `deprecated` (`{ since, replaced_by, zh, en }`), `changes` (`{ date, zh, en }`), `place`
//!
//! A body:
//!
//! - `state` (`stated`, `inferred`, `open`), `note` (text or `null`): why it is inferred or open
//! - `type`: name of its struct; `null` for raw bytes and where nothing is sent
//! - `fields`: everything that may stand in it, in order, without the envelope. See below
//!
//! A field of a body:
//!
//! - `path`: wire keys joined by `.`; `[]` stands for each item of a list: `data`,
//!   `data.cellDoorList`, `data.cellDoorList[]`, `data.cellDoorList[].cellId`. Objects and lists have an entry
//!   of their own before those of what is in them
//! - `type`: as the spec writes it, without `?`; an object in place has a made name
//! - `optional`: whether it may be absent where what holds it is there. The keys of the variants of a choice
//!   are all optional
//! - `wire`: how it travels: `bool`, `number`, `string`, `object`, `array`, or `any`
//! - `example`: its value in the composed example; `null` where that leaves it out
//! - `variants`: where it is a key of variants of a choice, their names; `[]` otherwise
//! - `condition`: under which values of the fields beside it an optional field is there, and a required one is valid:
//!   `{ when: [{ path, values }] }`, all of which hold, or `{ unless: […] }`, not all of which do; `path` is a wire key,
//!   `values` any of which it has; `null` for under all
//! - `name` (in code), `refers` (name of the entity of which it holds an id), `coordinates` (name of the coordinate system in
//!   which its object is given, unless its struct says so), `kept` (name of the store in which it is kept), `unit`, `min`, `max`, `length`
//!   (`[fewest, most]`), `pattern`, `only` (values of its enum; `[]` for all), `default`, `quirks`, `also`,
//!   `sensitive`, `since`, `available`, `deprecated`, `note` (text or `null`); of a list's item these are empty
//! - `zh`, `en`
//!
//! A type: `name`, `kind` (`struct`, `enum`, `one_of`), `group` (`null` where groups share it), `body_of`
//! (`{ operation, side, path }` for made types, `side` being `request` or `response`), `zh`, `en`, `about`,
//! `since`, `changes`, `place`, and
//!
//! - for a struct `state`, `coordinates` (name of its coordinate system, or `null`) and `fields`, its own ones only, `path` being their wire key; beside the keys above they
//!   have `wire_form` (`plain`, `string`, `number`) and `example_is`: whether the `example` is `given`, `derived` from
//!   the type or `absent`
//! - for an enum `repr`, `closed`, `order`, `values` (`{ value, name, start, then, final, error, zh, en, since, available }`).
//!   `then` are the names of the values that follow; `order` says in what sense: `normal`, other changes occur as well, or
//!   `complete`, none does; `null` where nothing is said. `final`: nothing follows; `error`: it says that something
//!   failed
//! - for a choice `variants` (`{ name, type, zh, en, available, deprecated }`)
//!
//! An open question: `id`, `severity` (`high`, `medium`, `low`), `category`, `kind` (`decision`, `quirk`, `note`,
//! `question`), `subject`, `zh` and `en` (the answer), `gap` (text: what the source lacks), `place`, and
//! `answers`, a list of all answers with these keys where there is more than one. A subject is
//! `protocol`, `transport`, `frame`, `frame.<field>`, `envelope`, `envelope.<key>`, `results`,
//! `results.<code>`, `codes`, `operation.<name>`, `type.<name>`, `field.<type>.<key>`, `table.<id>` or
//! `section.<number>`.

mod fields;
mod release_dump;

pub use release_dump::release_dump;

use crate::sample::Samples;
use fc_spec::model::{
    Answer, AnswerKind, Conflict, Direction, Dump, Location, Model, Severity, Subject, Text,
    TypeShape, Value,
};
use serde::Serialize;

/// The dump as JSON, indented, with a newline at its end.
#[must_use]
pub fn json(model: &Model) -> String {
    let mut out = value(model).pretty();
    out.push('\n');
    out
}

/// The same with `options` as one more key, for a plugin.
#[must_use]
pub fn json_with(model: &Model, options: &impl Serialize) -> String {
    let mut dump = value(model);
    dump.set("options", tree(options));
    dump.to_string()
}

/// The dump as YAML.
#[must_use]
pub fn yaml(model: &Model) -> String {
    serde_yaml::to_string(&value(model)).unwrap_or_default()
}

/// The dump as a value: the model as it is serialized, and what is worked out from it for those who have no
/// generator of their own.
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

/// What is serialized, as a value.
fn tree(part: &impl Serialize) -> Value {
    // Nothing of a model has keys that are no texts, which is all that can fail.
    let text = serde_json::to_string(part).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or(Value::Null)
}

/// The items of the list under a key.
fn items<'v>(value: &'v mut Value, key: &str) -> impl Iterator<Item = &'v mut Value> {
    value.get_mut(key).into_iter().flat_map(Value::items_mut)
}

/// A gap of the source and what the spec answers to it.
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
    /// All of them, where there is more than one.
    answers: Vec<&'m Answer>,
}

/// A checked model has an answer to every conflict.
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
