//! Targets that other programs generate.

use crate::package::language as languages;
use crate::product::{Artifact, below};
use fc_spec::model::Value;
use serde::Deserialize;
use std::time::Duration;

/// A target that another program generates.
///
/// The program reads the dump of the model from standard input. The dump has the target's `options` as an additional
/// key. The program writes a JSON list of `{ "path", "contents" }` to standard output. The paths are relative to the
/// target's `out`.
#[derive(Clone, Debug)]
pub struct Plugin {
    /// The name of the target.
    pub name: String,
    /// The program. A name with a `/` is a path from the root; any other name is looked up by the system.
    pub program: String,
    /// The directory of the files, relative to the root.
    pub out: String,
    /// The programming language that must be able to use the names of the spec, if the target declares one.
    pub names: Option<&'static languages::Language>,
    /// The audience whose part of the protocol the program gets; `None` for the whole protocol.
    pub audience: Option<String>,
    /// The maximum run time of the program.
    pub timeout: Duration,
    /// The maximum output of the program, in bytes.
    pub output_bytes: u64,
    /// The options that are passed to the program.
    pub options: Value,
}

/// A number in `fc.yaml` with a default.
pub(crate) struct Bound {
    pub(crate) key: &'static str,
    pub(crate) default: u64,
}

/// The maximum run time of a plugin: one minute by default.
pub(crate) const TIMEOUT_MS: Bound = Bound {
    key: "timeout_ms",
    default: 60_000,
};

/// The maximum output of a plugin: 64 MiB by default.
pub(crate) const OUTPUT_BYTES: Bound = Bound {
    key: "output_bytes",
    default: 64 << 20,
};

/// A file in the output of a plugin.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    path: String,
    contents: String,
}

impl Plugin {
    /// Returns the files in the program's output.
    ///
    /// # Errors
    ///
    /// Returns an error if the output is not a list of files.
    pub fn artifacts(&self, answer: &[u8]) -> Result<Vec<Artifact>, serde_json::Error> {
        let files: Vec<Answer> = serde_json::from_slice(answer)?;
        let artifact = |file: Answer| Artifact {
            target: self.name.clone(),
            path: below(&self.out, &file.path),
            contents: file.contents,
        };
        Ok(files.into_iter().map(artifact).collect())
    }
}
