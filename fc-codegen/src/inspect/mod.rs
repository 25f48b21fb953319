//! A dump of the resolved model as JSON, for other programs: `fc inspect --format json`.
//!
//! # Format 1
//!
//! `format` counts up when a key changes its meaning or goes; new keys do not change it. All keys named
//! here are always there; what does not apply is `null` or `[]`. A *text* is `{ "zh", "en" }`. Dates
//! are `YYYY-MM` or `YYYY-MM-DD`. A *place* is `{ "file", "line" }`, the file from the
//! project's root.
//!
//! Top:
//!
//! - `format`: 1
//! - `protocol`: see below
//! - `operations`: commands, reports and streams, by group, in the order of the files
//! - `types`: declared types and those made for bodies, as they stand in the spec
//! - `result_codes`: `{ code, name, role, zh, en, about }`, by number; `role` says when the engine itself
//!   answers with it
//! - `ranges`: `{ from, to, use, next, zh, en }`, by number, both ends included; `use` is
//!   `pass_through`, `commands`, `reports`, `reserved` or `historic`, `next` the first code of
//!   `commands` and `reports` that is neither used nor retired, `null` elsewhere and where none is left
//! - `retired_codes`: `{ code, zh, en }`
//! - `tables`: `{ id, row, rows, zh, en, about, place }`, the rows in wire form
//! - `open_questions`: one entry per gap of the source document, see below
//! - `lost_sections`: `{ section, zh, en }`, the sections of the source of which nothing is left
//! - `changes`: `{ date, zh, en }`, of the protocol as a whole
//!
//! `protocol`: `id`, `version`, `zh`, `en`, `about` (text), `robot` and `app` (`{ zh, en, about }`), `host`,
//! `ports` (`{ role, number, zh, en }`), `frame`, `envelope`, `calls`
//! (`{ timeout_ms, handler_timeout_ms, max_age_ms, ack }`), `limits` (as in the spec).
//! `frame`: `byte_order` (`big`, `little`), `header_bytes`, `header`
//! (`{ wire, name, type, offset, size, role, value, zh, en, aliases }`), `request_head` and `response_head` (lists of bytes),
//! `kinds` (`{ value, name, role, port, zh, en }`), `encodings` (`{ value, name, role, zh, en }`).
//! `envelope`: `request` and `response`, lists of `{ wire, name, type, optional, role, example, zh, en, aliases }`.
//!
//! An operation:
//!
//! - `name`, `kind` (`command`, `report`, `stream`), `kind_state` (`stated`, `inferred`), `group`, `zh`, `en`, `about` (text or `null`)
//! - `aliases`: `{ zh, en }`, lists of other words for it
//! - `code` (number or `null`), `code_state` (`stated`, `inferred`, `open`)
//! - `sender` (`app`, `robot`), `port` (its number)
//! - `effect`: `read`, `config`, `motion` or `unknown` for commands; `effect_state` (`stated`, `inferred`, `open`)
//! - `sections`: numbers in the source; `lost`: what of them is lost (`title`, `type`, `code`, `request`, `response`)
//! - `request` and `response`: bodies. The request of a report is what the robot sends, its response what the app
//!   answers; those of a stream have no fields
//! - `ack`: `{ timeout_ms, retries }` for reports
//! - `result_text`: the result text in examples of its response; `null` where the envelope's stands
//! - `errors`: result codes it may answer besides success
//! - `since`, `deprecated` (`{ since, replaced_by, zh, en }`), `changes` (`{ date, zh, en }`), `place`
//!
//! A body:
//!
//! - `state` (`stated`, `inferred`, `open`), `note` (text or `null`): why it is inferred or open
//! - `type`: name of its struct; `null` for a stream
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
//! - `name` (in code), `unit`, `min`, `max`, `length` (`[fewest, most]`), `pattern`, `default`, `quirks`, `also`,
//!   `sensitive`, `since`, `deprecated`, `note` (text or `null`); of a list's item these are empty
//! - `zh`, `en`
//!
//! A type: `name`, `kind` (`struct`, `enum`, `one_of`), `group` (`null` where groups share it), `body_of`
//! (`{ operation, side, path }` for made types, `side` being `request` or `response`), `zh`, `en`, `about`,
//! `since`, `changes`, `place`, and
//!
//! - for a struct `state` and `fields`, its own ones only, `path` being their wire key
//! - for an enum `repr`, `closed`, `values` (`{ value, name, zh, en, since }`)
//! - for a choice `variants` (`{ name, type, zh, en }`)
//!
//! An open question: `id`, `severity` (`high`, `medium`, `low`), `category`, `kind` (`decision`, `quirk`, `note`,
//! `question`), `subject`, `zh` and `en` (the answer), `gap` (text: what the source lacks), `place`, and
//! `answers`, a list of all answers with these keys where there is more than one. A subject is
//! `protocol`, `transport`, `frame`, `frame.<field>`, `envelope`, `envelope.<key>`, `results`,
//! `results.<code>`, `codes`, `operation.<name>`, `type.<name>`, `field.<type>.<key>`, `table.<id>` or
//! `section.<number>`.

mod body;
mod build;
mod protocol;
mod questions;
mod types;

use crate::sample::Samples;
use build::{dated, list, number, object, string, text_entries};
use fc_spec::model::{BodyState, Model, Value};

/// Version of the format.
pub const FORMAT: u32 = 1;

/// The dump, indented, with a newline at its end.
#[must_use]
pub fn json(model: &Model) -> String {
    let mut out = value(model).pretty();
    out.push('\n');
    out
}

/// The dump as a value.
#[must_use]
pub fn value(model: &Model) -> Value {
    let samples = Samples::new(model);
    object([
        ("format", number(FORMAT)),
        ("protocol", protocol::protocol(model)),
        (
            "operations",
            list(&model.operations, |operation| {
                body::operation(&samples, operation)
            }),
        ),
        (
            "types",
            list(&model.types, |ty| types::type_def(&samples, ty)),
        ),
        ("result_codes", list(&model.results, protocol::result_code)),
        ("ranges", protocol::ranges(model)),
        ("retired_codes", list(&model.retired, protocol::retired)),
        ("tables", list(&model.tables, types::table)),
        ("open_questions", questions::open_questions(model)),
        (
            "lost_sections",
            list(&model.retained_sections, |section| {
                let mut entries = vec![("section".to_owned(), number(section.section))];
                entries.extend(text_entries(&section.text));
                Value::Object(entries)
            }),
        ),
        ("changes", list(&model.changes, dated)),
    ])
}

fn state(state: BodyState) -> Value {
    string(match state {
        BodyState::Stated => "stated",
        BodyState::Inferred => "inferred",
        BodyState::Open => "open",
    })
}
