//! Targets that other programs generate.

use crate::package::language as languages;
use crate::product::{Artifact, below};
use crate::target_error::TargetError;
use serde::Deserialize;
use serde_yaml::Value as Options;
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
    pub options: Options,
}

/// A number in `fc.yaml`, with its default and its maximum. The minimum is 1.
pub(crate) struct Bound {
    pub(crate) key: &'static str,
    default: u64,
    most: u64,
}

/// The maximum run time of a plugin: one minute by default, at most one hour.
pub(crate) const TIMEOUT_MS: Bound = Bound {
    key: "timeout_ms",
    default: 60_000,
    most: 3_600_000,
};

/// The maximum output of a plugin: 64 MiB by default, at most 1 GiB.
pub(crate) const OUTPUT_BYTES: Bound = Bound {
    key: "output_bytes",
    default: 64 << 20,
    most: 1 << 30,
};

impl Bound {
    pub(crate) fn of(&self, written: Option<u64>, name: &str) -> Result<u64, TargetError> {
        let value = written.unwrap_or(self.default);
        if (1..=self.most).contains(&value) {
            return Ok(value);
        }
        Err(TargetError::OutOfRange {
            name: name.to_owned(),
            key: self.key,
            most: self.most,
        })
    }
}

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
