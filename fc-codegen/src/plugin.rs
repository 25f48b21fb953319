//! Targets that other programs make.

use crate::package::language as languages;
use crate::product::Artifact;
use crate::target::{TargetError, below};
use serde::Deserialize;
use serde_yaml::Value as Options;
use std::time::Duration;

/// A target that another program makes.
///
/// The program gets the dump of the model on standard input, with the target's `options` as one more key, and
/// answers on standard output with a JSON list of `{ "path", "contents" }`, the paths from the target's `out`.
#[derive(Clone, Debug)]
pub struct Plugin {
    /// Name of the target.
    pub name: String,
    /// The program: a path from the root where it has a `/`, or else one that the system finds.
    pub program: String,
    /// Directory of its files, from the root.
    pub out: String,
    /// The programming language in which its names have to be free, if it says one.
    pub names: Option<&'static languages::Language>,
    /// Whose part of the protocol it gets; all of it where nobody is named.
    pub audience: Option<String>,
    /// Longest run of the program.
    pub timeout: Duration,
    /// Largest output of the program, in bytes.
    pub output_bytes: u64,
    /// Whatever it needs to know.
    pub options: Options,
}

/// A number in `fc.yaml` with its default and its largest value; the smallest is 1.
pub(crate) struct Bound {
    pub(crate) key: &'static str,
    default: u64,
    most: u64,
}

/// Longest run of a plugin: a minute, or up to an hour.
pub(crate) const TIMEOUT_MS: Bound = Bound {
    key: "timeout_ms",
    default: 60_000,
    most: 3_600_000,
};

/// Largest output of a plugin: 64 MiB, or up to 1 GiB.
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

/// What a plugin answers with: a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    path: String,
    contents: String,
}

impl Plugin {
    /// The files that the program has answered with.
    ///
    /// # Errors
    ///
    /// If it is no list of files.
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
