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
mod edit;
mod frame_faults;
mod frames;
pub(super) mod json_cases;
mod quirks;
mod sites;
mod unknown;

use super::packed;
use crate::emit::json::{hex, int, object, text};
use crate::product::{Artifact, Product};
use crate::sample::{Profile, SAMPLE_ID, STREAM_BYTES, Samples};
use crate::target::Targets;
use fc_reflect::{FrameId, Reflector};
use fc_spec::model::{Direction, EncodingRole, Kind, Model, Operation, StructRef, Value};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

/// Version of the files' format.
const FORMAT: i128 = 1;

/// A file per operation, one for the frames themselves and one for the bodies.
#[must_use]
pub fn emit(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let reflector = Reflector::new(model);
    let operations = model.operations.par_iter();
    let mut artifacts: Vec<Artifact> = operations
        .map(|operation| {
            artifact(
                targets,
                &operation.name,
                &of_operation(&reflector, operation),
            )
        })
        .collect();
    artifacts.push(artifact(targets, "frames", &frames::file(&reflector)));
    artifacts.push(artifact(targets, "bodies", &bodies::file()));
    artifacts
}

fn artifact(targets: &Targets, stem: &str, contents: &Value) -> Artifact {
    let contents = contents.pretty() + "\n";
    targets.artifact(Product::Vectors, &format!("{stem}.json"), contents)
}

fn of_operation(reflector: &Reflector<'_>, operation: &Operation) -> Value {
    let mut accepted = Vec::new();
    let mut rejected = Vec::new();
    for direction in operation.directions().iter().copied() {
        let case = Case {
            reflector,
            samples: reflector.samples(),
            operation,
            direction,
        };
        if operation.kind() == Kind::Stream {
            accepted.extend(accepted::stream(&case));
            rejected.extend(frame_faults::of_operation(&case, STREAM_BYTES));
            continue;
        }
        accepted.extend(accepted::messages(&case));
        let example = case.samples.data(operation, direction);
        rejected.extend(frame_faults::of_operation(&case, &example));
        rejected.extend(body_faults::of_operation(&case));
    }
    file(Some(operation), accepted, rejected)
}

/// A file of what is about one operation, or about none.
fn file(operation: Option<&Operation>, accepted: Vec<Value>, rejected: Vec<Value>) -> Value {
    let name = operation.map(|operation| text(&operation.name));
    let kind = operation.map(|operation| text(operation.kind().name()));
    let code = operation
        .and_then(|operation| operation.code.value)
        .map(int);
    object([
        ("format", int(FORMAT)),
        ("operation", name.unwrap_or(Value::Null)),
        ("kind", kind.unwrap_or(Value::Null)),
        ("code", code.unwrap_or(Value::Null)),
        ("accepted", Value::Array(accepted)),
        ("rejected", Value::Array(rejected)),
    ])
}

/// One side of an operation, and what its entries have in common.
struct Case<'a, 'm> {
    reflector: &'a Reflector<'m>,
    samples: &'a Samples<'m>,
    operation: &'a Operation,
    direction: Direction,
}

impl Case<'_, '_> {
    /// The struct of the body; `None` for raw bytes.
    fn body_type(&self) -> Option<&StructRef> {
        Some(&self.operation.messages()?.body(self.direction).ty)
    }

    /// A whole message.
    fn message(&self, profile: Profile) -> Value {
        self.samples
            .message(self.operation, self.direction, profile)
    }

    /// What frames of this side say; `None` without a code.
    fn id(&self) -> Option<FrameId> {
        self.reflector.id(self.operation, self.direction, SAMPLE_ID)
    }

    /// Whether there are frames of this side that are packed so.
    fn packs(&self, encoding: EncodingRole) -> bool {
        let layout = &self.reflector.model().frame;
        let is_known = encoding == EncodingRole::Plain || layout.encoding(encoding).is_some();
        is_known && self.id().is_some()
    }

    /// `frame` around the data, or `text` while there is no code.
    fn carrier(&self, data: &[u8], encoding: EncodingRole) -> (&'static str, Value) {
        match self.id() {
            Some(id) => {
                let frame = packed::frame(self.reflector, id, encoding, data);
                ("frame", text(&hex(&frame)))
            }
            None => ("text", text(&String::from_utf8_lossy(data))),
        }
    }

    fn accepted(&self, case: &str, encoding: EncodingRole, body: Value) -> Value {
        let text_of_body = body.to_string();
        object([
            ("name", text(&format!("{}_{case}", self.direction.name()))),
            ("direction", text(self.direction.name())),
            ("case", text(case)),
            self.carrier(text_of_body.as_bytes(), encoding),
            ("body", body),
        ])
    }

    fn accepted_as(&self, case: &str, body: Value, canonical: &Value) -> Value {
        let is_canonical = body == *canonical;
        let mut entry = self.accepted(case, EncodingRole::Plain, body);
        if let Value::Object(entries) = &mut entry
            && !is_canonical
        {
            entries.push(("canonical".to_owned(), canonical.clone()));
        }
        entry
    }

    fn accepted_bytes(&self, encoding: EncodingRole, data: &[u8]) -> Option<Value> {
        let case = encoding.name();
        self.packs(encoding).then(|| {
            object([
                ("name", text(&format!("{}_{case}", self.direction.name()))),
                ("direction", text(self.direction.name())),
                ("case", text(case)),
                self.carrier(data, encoding),
                ("data", text(&hex(data))),
            ])
        })
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
