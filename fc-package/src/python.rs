//! The wheel and the source distribution.

use crate::error::PackError;
use crate::files;
use crate::job::Job;
use crate::sbom::{Component, Package, Packages};
use crate::tool::{Tool, unpack};
use fc_codegen::version::Ecosystem;
use std::path::Path;
use toml_edit::DocumentMut;

const PYTHON: Tool = Tool {
    name: "python3",
    get: "apt install python3",
};

/// Packs the sources. The version is set in the packed files, and the wheel is made of them.
pub fn pack(job: &Job<'_>) -> Result<Packages, PackError> {
    let package = job.package("pyproject.toml")?;
    PYTHON
        .run(&job.work, ["-c", "import build"])
        .map_err(|error| PackError::NoBuild(Box::new(error)))?;
    build(&package, &job.work, &["--sdist"])?;
    unpack(&files::with_ending(&job.work, ".tar.gz")?, &job.work)?;
    let mut packed = files::entries(&job.work)?.into_iter();
    let packed = packed.find(|it| it.is_dir()).unwrap_or_default();
    let manifest = packed.join("pyproject.toml");
    files::set_toml_version(&manifest, "project", |number| {
        job.version(Ecosystem::Python, number)
    })?;
    build(&packed, &job.out, &[])?;
    contents(&manifest)
}

/// Returns the contents of a package by its `pyproject.toml`.
fn contents(manifest: &Path) -> Result<Packages, PackError> {
    let document: DocumentMut = files::read(manifest)?.parse()?;
    let get = |key| document.get("project").and_then(|it| it.get(key));
    let text = |key| get(key).and_then(|it| it.as_str()).unwrap_or_default();
    let needed = get("dependencies").and_then(|it| it.as_array());
    let needed = needed.into_iter().flatten().filter_map(|it| it.as_str());
    Ok(Packages {
        main: Package {
            component: Component {
                version: text("version").to_owned(),
                licence: text("license").to_owned(),
                ..component(text("name"))
            },
            dependencies: needed.map(dependency).collect(),
        },
        others: Vec::new(),
    })
}

/// Returns a dependency as PEP 508 writes it, such as `idna >= 3`.
fn dependency(text: &str) -> Component {
    let is_of_name = |it: char| it.is_ascii_alphanumeric() || "-_.".contains(it);
    let (name, requirement) = text.split_at(text.find(|it| !is_of_name(it)).unwrap_or(text.len()));
    Component {
        requirement: requirement.trim().to_owned(),
        ..component(name)
    }
}

/// Returns a component by the name of its package, which a package URL writes in lower case with `-`.
fn component(name: &str) -> Component {
    Component::new("pypi", name.to_lowercase().replace('_', "-"))
}

/// Builds without isolation: an isolated environment would need an index of packages.
fn build(package: &Path, out: &Path, options: &[&str]) -> Result<(), PackError> {
    let out = out.display().to_string();
    let fixed = ["-m", "build", "--no-isolation", "--outdir", &out];
    PYTHON.run(package, fixed.into_iter().chain(options.iter().copied()))?;
    Ok(())
}
