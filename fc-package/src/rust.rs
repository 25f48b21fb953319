//! The crates, as files and as a directory source.

use crate::error::PackError;
use crate::files;
use crate::job::Job;
use crate::sbom::{Component, Package, Packages};
use crate::sums;
use crate::tool::{Tool, unpack};
use fc_codegen::version::Ecosystem;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const CARGO: Tool = Tool {
    name: "cargo",
    get: "https://rustup.rs",
};

/// Options of each `cargo package`. The crates are built where they are used, and a lock file would need their registry.
const PACKAGE: [&str; 5] = [
    "package",
    "--allow-dirty",
    "--exclude-lockfile",
    "--no-verify",
    "--offline",
];

/// Files that Cargo adds to a crate, and refuses in its sources.
const ADDED: [&str; 2] = ["Cargo.toml.orig", ".cargo_vcs_info.json"];

/// The directory source.
const VENDOR: &str = "vendor";

/// The part of `cargo metadata` about the packages of a workspace.
#[derive(Deserialize)]
struct Workspace {
    packages: Vec<Crate>,
    workspace_root: PathBuf,
}

#[derive(Clone, Deserialize)]
struct Crate {
    name: String,
    version: String,
    license: Option<String>,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
}

#[derive(Clone, Deserialize)]
struct Dependency {
    name: String,
    req: String,
    optional: bool,
    kind: Option<String>,
    path: Option<PathBuf>,
}

impl Dependency {
    /// Returns `true` if users of the crate need it.
    fn is_needed(&self) -> bool {
        self.kind.as_deref() != Some("dev")
    }
}

fn metadata(directory: &Path) -> Result<Workspace, PackError> {
    let arguments = ["metadata", "--format-version=1", "--no-deps", "--offline"];
    let printed = CARGO.run(directory, arguments)?;
    Ok(serde_json::from_str(&printed)?)
}

/// Packs the generated crate and all crates that it depends on by path. The version is set in the packed files.
pub fn pack(job: &Job<'_>) -> Result<Packages, PackError> {
    let package = job.package("Cargo.toml")?;
    let (name, crates) = with_dependencies(&package)?;
    let unpacked = files::directory(&job.work.join("unpacked"))?;
    for (root, names) in &crates {
        for archive in cargo_package(root, names, &job.work.join("first"))? {
            unpack(&archive, &unpacked)?;
        }
    }
    let crates_there = files::entries(&unpacked)?;
    for file in crates_there
        .iter()
        .flat_map(|it| ADDED.map(|name| it.join(name)))
    {
        // `.cargo_vcs_info.json` is there only in a repository.
        let _ = std::fs::remove_file(file);
    }
    let generated = crates_there.iter().find(|path| is_of(path, &name));
    let manifest = generated.unwrap_or(&unpacked).join("Cargo.toml");
    files::set_toml_version(&manifest, "package", |number| {
        job.version(Ecosystem::Cargo, number)
    })?;
    let workspace = "[workspace]\nresolver = \"3\"\nmembers = [\"*\"]\n";
    files::write(&unpacked.join("Cargo.toml"), workspace)?;
    let packages = contents(&unpacked, &name)?;
    let names: Vec<_> = crates.into_values().flatten().collect();
    let vendor = files::directory(&job.out.join(VENDOR))?;
    for archive in cargo_package(&unpacked, &names, &job.work.join("second"))? {
        unpack(&archive, &vendor)?;
        let file = archive.file_name().unwrap_or_default();
        seal(&vendor.join(file).with_extension(""), &archive)?;
        std::fs::rename(&archive, job.out.join(file))?;
    }
    Ok(packages)
}

/// Returns the contents of the packed crates.
fn contents(root: &Path, main: &str) -> Result<Packages, PackError> {
    let packed = metadata(root)?.packages;
    let package = |it: &Crate| Package {
        component: component(it),
        dependencies: it
            .dependencies
            .iter()
            .filter(|it| it.is_needed())
            .map(|it| dependency(it, &packed))
            .collect(),
    };
    let mut packages: Vec<_> = packed.iter().map(package).collect();
    let Some(at) = packed.iter().position(|it| it.name == main) else {
        return Err(PackError::NotACrate(root.to_owned()));
    };
    Ok(Packages {
        main: packages.remove(at),
        others: packages,
    })
}

fn component(packed: &Crate) -> Component {
    Component {
        version: packed.version.clone(),
        licence: packed.license.clone().unwrap_or_default(),
        ..Component::new("cargo", &packed.name)
    }
}

/// Returns a dependency. If it is one of the packed crates, its version is known.
fn dependency(dependency: &Dependency, packed: &[Crate]) -> Component {
    let found = packed.iter().find(|it| it.name == dependency.name);
    found.map_or_else(
        || Component {
            requirement: dependency.req.clone(),
            is_optional: dependency.optional,
            ..Component::new("cargo", &dependency.name)
        },
        component,
    )
}

/// Returns `true` if the directory `name-version` is that of a crate.
fn is_of(path: &Path, name: &str) -> bool {
    let directory = path.file_name().unwrap_or_default().to_string_lossy();
    let version = directory.strip_prefix(name);
    let version = version.and_then(|rest| rest.strip_prefix('-'));
    version.is_some_and(|it| it.starts_with(|first: char| first.is_ascii_digit()))
}

/// Returns the name of a crate, and the names of all crates that its users need, by the root of their workspace.
fn with_dependencies(
    package: &Path,
) -> Result<(String, BTreeMap<PathBuf, Vec<String>>), PackError> {
    let mut name = None;
    let mut crates: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    let mut left = vec![package.to_owned()];
    while let Some(directory) = left.pop() {
        let directory = directory.canonicalize()?;
        let workspace = metadata(&directory)?;
        let is_here = |it: &&Crate| it.manifest_path.parent() == Some(&directory);
        let Some(found) = workspace.packages.iter().find(is_here) else {
            return Err(PackError::NotACrate(directory));
        };
        name.get_or_insert_with(|| found.name.clone());
        let names = crates.entry(workspace.workspace_root).or_default();
        if names.contains(&found.name) {
            continue;
        }
        names.push(found.name.clone());
        let dependencies = found.dependencies.iter();
        let needed = dependencies.filter(|it| it.is_needed());
        left.extend(needed.filter_map(|it| it.path.clone()));
    }
    Ok((name.unwrap_or_default(), crates))
}

/// Packs crates of a workspace and returns the files.
fn cargo_package(root: &Path, names: &[String], target: &Path) -> Result<Vec<PathBuf>, PackError> {
    let target_option = format!("--target-dir={}", target.display());
    let names = names.iter().flat_map(|name| ["--package", name]);
    let arguments = PACKAGE.into_iter().chain([target_option.as_str()]);
    CARGO.run(root, arguments.chain(names))?;
    let made = files::entries(&target.join("package"))?.into_iter();
    let is_crate = |path: &PathBuf| path.extension().is_some_and(|it| it == "crate");
    Ok(made.filter(is_crate).collect())
}

/// Writes the checksums that Cargo wants in each crate of a directory source.
fn seal(directory: &Path, archive: &Path) -> Result<(), PackError> {
    let mut sums = BTreeMap::new();
    for file in files::below(directory)? {
        sums.insert(file.clone(), sums::of_file(&directory.join(file))?);
    }
    let checksum = serde_json::json!({ "files": sums, "package": sums::of_file(archive)? });
    files::write(
        &directory.join(".cargo-checksum.json"),
        checksum.to_string(),
    )
}
