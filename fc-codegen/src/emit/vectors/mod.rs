//! Golden frames: the inputs that every implementation of the protocol must accept or refuse.
//!
//! Each operation has a file (`fc-generated/vectors/<operation>.json`). `frames.json` and `bodies.json` contain the
//! rules that hold for all operations. Every file has these keys:
//!
//! ```json
//! { "format": 1, "operation": "get_station", "kind": "command", "code": 2563,
//!   "accepted": [ … ], "rejected": [ … ] }
//! ```
//!
//! `frames.json` also has the protocol's `version`, so that a copy of the files shows its release.
//!
//! **Accepted**, in an operation's file: `name`, `direction` (`request`, `response`), `case` (`plain`, `gzip`,
//! `unknown_keys`, `unknown_value`, `minimal`, `maximal`, `integral`, `variant_<name>`, `error_<result>`,
//! `quirk_<field>_…`, `condition_<field>_missing`, `condition_<field>_unasked`), and:
//! - `frame`: the frame in hexadecimal. An operation without a code has `text` instead: its JSON.
//! - `body`: the JSON in the frame, envelope first. A typed reader that writes the message back produces the same JSON
//!   in any order of keys. If the input uses a quirk or an integer with a point, it produces `canonical` instead.
//!   Streams have `data` instead of `body`: the bytes in hexadecimal.
//!
//! **Rejected**: `name`, `direction`, `frame` (or `text`) and `error`, the name of the error. `frame` is the whole
//! input, so an incomplete frame is `truncated`.
//!
//! In `frames.json`, `operation`, `kind` and `code` are null. Accepted entries have `header`, the values of the header
//! fields by role, and `data`, the decompressed data in hexadecimal.
//!
//! `bodies.json` contains the rules of JSON, independent of the spec. The same three keys are null. Each entry is a
//! body to be read as a message with one optional key, `value`, which keeps unknown keys. It has `name`, `type`,
//! `bytes` (the body in hexadecimal) and `text` (the body for people). `type` is that of `value` in the spec language.
//! `object` is a message of the same form, whose `value` is an `i32`. The entry also has:
//! - accepted: `written`, the text of the message after writing it back. Numbers of `f32` and `f64` and escapes in
//!   strings may have another spelling. Integers and values of unknown keys may not.
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

/// Returns a file for each operation, a file for frames and a file for bodies.
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
