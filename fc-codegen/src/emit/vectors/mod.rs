//! Golden frames: what every implementation of the protocol must accept and must refuse.
//!
//! One file per operation (`fc-generated/vectors/<operation>.json`), and `frames.json` and `bodies.json` for
//! what no operation has to do with. Every file is
//!
//! ```json
//! { "format": 1, "operation": "get_station", "kind": "command", "code": 2563,
//!   "accepted": [ … ], "rejected": [ … ] }
//! ```
//!
//! **Accepted**, in an operation's file: `name`, `direction` (`request`, `response`), `case`
//! (`plain`, `gzip`, `unknown_keys`, `unknown_value`, `minimal`, `maximal`, `integral`, `variant_<name>`,
//! `quirk_<field>_…`), then
//! - `frame`: the frame in hexadecimal; or, while the operation has no code, `text`: its JSON;
//! - `body`: the JSON in the frame, envelope first. A typed reader that writes the message again
//!   writes the same JSON (order of keys aside), or `canonical` where that is given: a quirk was
//!   read, or an integer with a point, and is not sent. Streams have `data` instead: the bytes in hexadecimal.
//!
//! **Rejected**: `name`, `direction`, `frame` (or `text`) and `error`, the name of the error.
//! `frame` is all of the input: what ends inside a frame is `truncated`.
//!
//! In `frames.json`, `operation`, `kind` and `code` are null; accepted entries have `header` (what
//! the header's fields hold, by role) and `data` (the data area, decompressed, in hexadecimal).
//!
//! `bodies.json` holds readers to the rules of JSON, whatever the spec; the same three are null. Each entry
//! is a body to be read as a message of one key, `value`, which may be missing, and which keeps unknown
//! keys: `name`, `type` (that of `value`, as the spec language has it; `object` is such a message again,
//! whose `value` is an `i32`), `bytes` (the body in hexadecimal) and `text` (the same for people), then
//! - accepted: `written`, the text of the message written again. Numbers of `f32` and `f64` and escapes of
//!   strings may be spelled otherwise; integers and what stands under unknown keys may not.
//! - rejected: `error`.

mod accepted;
mod bodies;
mod body_faults;
mod frame_faults;
mod frames;
mod quirks;
mod values;

use super::{Artifact, Product};
use crate::sample::frame::hex;
use crate::sample::{FrameInput, Profile, STREAM_BYTES, Samples, frame};
use crate::target::Targets;
use fc_spec::model::{Direction, EncodingRole, Kind, Model, Operation, Value};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use values::{int, object, text};

/// Version of the files' format.
const FORMAT: i128 = 1;

/// A file per operation, one for the frames themselves and one for the bodies.
#[must_use]
pub fn emit(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let samples = Samples::new(model);
    let operations = model.operations.par_iter();
    let mut artifacts: Vec<Artifact> = operations
        .map(|operation| artifact(targets, &operation.name, &file(&samples, operation)))
        .collect();
    artifacts.push(artifact(targets, "frames", &frames::file(&samples)));
    artifacts.push(artifact(targets, "bodies", &bodies::file()));
    artifacts
}

fn artifact(targets: &Targets, stem: &str, contents: &Value) -> Artifact {
    let contents = contents.pretty() + "\n";
    targets.artifact(Product::Vectors, &format!("{stem}.json"), contents)
}

fn file(samples: &Samples<'_>, operation: &Operation) -> Value {
    let mut accepted = Vec::new();
    let mut rejected = Vec::new();
    for direction in Direction::ALL.iter().copied() {
        let case = Case {
            samples,
            operation,
            direction,
        };
        if operation.kind == Kind::Stream {
            if direction == Direction::Request {
                accepted.extend(accepted::stream(&case));
                rejected.extend(frame_faults::of_operation(&case, STREAM_BYTES));
            }
            continue;
        }
        accepted.extend(accepted::messages(&case));
        let example = case.message(Profile::Example).to_string();
        rejected.extend(frame_faults::of_operation(&case, example.as_bytes()));
        rejected.extend(body_faults::of_operation(&case));
    }
    let kind = operation.kind.name();
    object([
        ("format", int(FORMAT)),
        ("operation", text(&operation.name)),
        ("kind", text(kind)),
        (
            "code",
            operation
                .code
                .value
                .map_or(Value::Null, |code| int(code.into())),
        ),
        ("accepted", Value::Array(accepted)),
        ("rejected", Value::Array(rejected)),
    ])
}

/// One side of an operation, and what its entries have in common.
struct Case<'a, 'm> {
    samples: &'a Samples<'m>,
    operation: &'a Operation,
    direction: Direction,
}

impl Case<'_, '_> {
    /// Name of the struct type of the body.
    fn body_type(&self) -> Option<&str> {
        let body = match self.direction {
            Direction::Request => &self.operation.request,
            Direction::Response => &self.operation.response,
        };
        body.ty.as_deref()
    }

    /// A whole message.
    fn message(&self, profile: Profile) -> Value {
        self.samples
            .message(self.operation, self.direction, profile)
    }

    /// What frames of this side say; `None` without a code.
    fn input(&self, encoding: EncodingRole) -> Option<FrameInput> {
        let layout = &self.samples.model().frame;
        FrameInput::of(layout, self.operation, self.direction, encoding)
    }

    /// `frame` around the data, or `text` while there is no code.
    fn carrier(&self, data: &[u8], encoding: EncodingRole) -> (&'static str, Value) {
        let layout = &self.samples.model().frame;
        match self.input(encoding) {
            Some(input) => ("frame", text(&frame::frame(layout, input, data).hex())),
            None => ("text", text(&String::from_utf8_lossy(data))),
        }
    }

    fn accepted(&self, case: &str, encoding: EncodingRole, body: &Value) -> Value {
        let text_of_body = body.to_string();
        object([
            ("name", text(&format!("{}_{case}", self.direction.name()))),
            ("direction", text(self.direction.name())),
            ("case", text(case)),
            self.carrier(text_of_body.as_bytes(), encoding),
            ("body", body.clone()),
        ])
    }

    fn accepted_as(&self, case: &str, body: &Value, canonical: &Value) -> Value {
        let mut entry = self.accepted(case, EncodingRole::Plain, body);
        if let Value::Object(entries) = &mut entry
            && body != canonical
        {
            entries.push(("canonical".to_owned(), canonical.clone()));
        }
        entry
    }

    fn accepted_bytes(&self, encoding: EncodingRole, data: &[u8]) -> Option<Value> {
        self.input(encoding)?;
        let case = encoding.name();
        Some(object([
            ("name", text(&format!("{}_{case}", self.direction.name()))),
            ("direction", text(self.direction.name())),
            ("case", text(case)),
            self.carrier(data, encoding),
            ("data", text(&hex(data))),
        ]))
    }

    fn rejected(&self, name: &str, carrier: (&'static str, Value), error: &str) -> Value {
        object([
            ("name", text(&format!("{}_{name}", self.direction.name()))),
            ("direction", text(self.direction.name())),
            carrier,
            ("error", text(error)),
        ])
    }
}
