//! The npm tarball.

use std::path::Path;

use fc_codegen::version::Ecosystem;

use super::tool::{Tool, unpack};
use super::{Job, files};
use crate::outcome::Failure;

const NPM: Tool = Tool {
    name: "npm",
    get: "apt install npm",
};

/// Packs the package, which runs its script `prepare`. The version is set in the packed files.
pub fn pack(job: &Job<'_>) -> Result<String, Failure> {
    let package = job.package("package.json")?;
    let into = |directory: &Path| format!("--pack-destination={}", directory.display());
    NPM.run(&package, ["pack", &into(&job.work)])?;
    unpack(&files::with_ending(&job.work, ".tgz")?, &job.work)?;
    let packed = job.work.join("package");
    let number = NPM.run(&packed, ["pkg", "get", "version"])?;
    let version = job.version(Ecosystem::Npm, number.trim().trim_matches('"'))?;
    NPM.run(&packed, ["pkg", "set", &format!("version={version}")])?;
    NPM.run(&packed, ["pack", "--ignore-scripts", &into(&job.out)])?;
    Ok(version)
}
