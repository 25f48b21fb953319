//! The npm tarball.

use crate::error::PackError;
use crate::files;
use crate::job::Job;
use crate::sbom::{Component, Package, Packages};
use crate::tool::{Tool, unpack};
use fc_codegen::version::Ecosystem;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

const NPM: Tool = Tool {
    name: "npm",
    get: "apt install npm",
};

/// The part of `package.json` that matters here.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Manifest {
    name: String,
    version: String,
    #[serde(default)]
    license: String,
    #[serde(default)]
    dependencies: BTreeMap<String, String>,
    #[serde(default)]
    peer_dependencies: BTreeMap<String, String>,
}

/// Packs the package, which runs its script `prepare`. The version is set in the packed files.
pub fn pack(job: &Job<'_>) -> Result<Packages, PackError> {
    let package = job.package("package.json")?;
    let into = |directory: &Path| format!("--pack-destination={}", directory.display());
    NPM.run(&package, ["pack", &into(&job.work)])?;
    unpack(&files::with_ending(&job.work, ".tgz")?, &job.work)?;
    let packed = job.work.join("package");
    let manifest: Manifest = serde_json::from_str(&files::read(&packed.join("package.json"))?)?;
    let version = job.version(Ecosystem::Npm, &manifest.version)?;
    NPM.run(&packed, ["pkg", "set", &format!("version={version}")])?;
    NPM.run(&packed, ["pack", "--ignore-scripts", &into(&job.out)])?;
    let needed = manifest
        .dependencies
        .iter()
        .chain(&manifest.peer_dependencies);
    Ok(Packages {
        main: Package {
            component: Component {
                version,
                licence: manifest.license,
                ..component(&manifest.name)
            },
            dependencies: needed
                .map(|(name, requirement)| Component {
                    requirement: requirement.clone(),
                    ..component(name)
                })
                .collect(),
        },
        others: Vec::new(),
    })
}

/// Returns a component by the name of its package, such as `@scope/name`.
fn component(name: &str) -> Component {
    let (scope, name) = name.rsplit_once('/').unwrap_or(("", name));
    Component {
        namespace: scope.to_owned(),
        ..Component::new("npm", name)
    }
}
