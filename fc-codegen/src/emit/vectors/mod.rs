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
//! `frames.json` has the protocol's `version` as well, so that a copy of the files tells which release it holds peers to.
//!
//! **Accepted**, in an operation's file: `name`, `direction` (`request`, `response`), `case`
//! (`plain`, `gzip`, `unknown_keys`, `unknown_value`, `minimal`, `maximal`, `integral`, `variant_<name>`,
//! `error_<result>`, `quirk_<field>_…`, `condition_<field>_missing`, `condition_<field>_unasked`), then
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
mod case;
mod conditions;
mod edit;
mod file;
mod frame_faults;
mod frames;
pub(super) mod json_cases;
mod quirks;
mod sites;
mod unknown;

use crate::product::{Artifact, Product};
use crate::target::Targets;
use case::Case;
use fc_reflect::Reflector;
use fc_spec::model::{Kind, Model, Operation, Value};
use file::contents;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

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
        let example = case.samples.data(operation, direction);
        if operation.kind() == Kind::Stream {
            accepted.extend(accepted::stream(&case, &example));
            rejected.extend(frame_faults::of_operation(&case, &example));
            continue;
        }
        accepted.extend(accepted::messages(&case));
        rejected.extend(frame_faults::of_operation(&case, &example));
        rejected.extend(body_faults::of_operation(&case));
    }
    contents(None, Some(operation), accepted, rejected)
}
