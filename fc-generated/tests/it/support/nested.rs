//! A crate of its own around generated sources, built and tested by a cargo within the test.

use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::model::Model;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Makes the crate in `project` from a model; `tests` become its tests.
pub fn write_crate(project: &Path, model: &Model, tests: &[&Path]) {
    write_crate_for(project, model, &Targets::of([Product::Rust]), tests);
}

/// The same for other targets, the Rust package among them.
pub fn write_crate_for(project: &Path, model: &Model, targets: &Targets, tests: &[&Path]) {
    plan(generate(model, targets).unwrap(), project, &[])
        .unwrap()
        .write()
        .unwrap();

    let root = super::root();
    // Cargo tells crates in one target directory apart by name and version, not by where they are: one
    // would be taken for the other, if it was built later.
    let apart = project.file_name().unwrap().to_string_lossy();
    let apart = apart.replace('_', "-");
    // Quoted and escaped as TOML and Rust both do.
    let at = |name: &str| format!("{:?}", root.join(name).to_string_lossy());
    let manifest = format!(
        "\
[workspace]

[package]
name = \"fc-generated\"
version = \"0.1.0-{apart}\"
edition = \"2024\"
rust-version = \"1.88\"
publish = false

[features]
default = [\"client\", \"server\"]
client = [\"fc-derive/client\", \"fc-runtime/client\", \"dep:futures-core\"]
blocking = [\"client\", \"fc-runtime/blocking\"]
server = [\"fc-derive/server\", \"fc-runtime/server\"]

[dependencies]
fc-derive = {{ path = {}, default-features = false }}
fc-runtime = {{ path = {}, default-features = false }}
futures-core = {{ version = \"0.3\", default-features = false, optional = true }}

[dev-dependencies]
futures-util = {{ version = \"0.3\", default-features = false }}
fc-runtime = {{ path = {}, default-features = false, features = [\"serde\"] }}
serde_json = \"1\"
tokio = {{ version = \"1\", features = [\"rt\", \"net\", \"macros\"] }}

[lints.rust]
warnings = \"deny\"
missing_docs = \"deny\"
rust_2018_idioms = {{ level = \"deny\", priority = -1 }}
",
        at("fc-derive"),
        at("fc-runtime"),
        at("fc-runtime"),
    );
    let folder = project.join("fc-generated");
    fs::create_dir_all(folder.join("tests")).unwrap();
    fs::write(folder.join("Cargo.toml"), manifest).unwrap();
    // The versions that are there, so that nothing has to be fetched.
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    for test in tests {
        fs::copy(test, folder.join("tests").join(test.file_name().unwrap())).unwrap();
    }
}

/// Where all crates that tests make are built, those of fc-cli among them: dependencies are compiled once.
pub fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested")
}

/// Runs cargo in the crate and answers what it printed; it has to succeed.
pub fn cargo(project: &Path, arguments: &[&str]) -> String {
    let output = run(project, arguments);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{text}\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
    text
}

/// Runs cargo in the crate and answers what it complained of; it has to fail.
pub fn refused(project: &Path, arguments: &[&str]) -> String {
    let output = run(project, arguments);
    assert!(!output.status.success(), "cargo {arguments:?} succeeded");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Cargo, without the variables that describe this package. Build scripts that read them would run again.
pub fn command() -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    for (name, _) in std::env::vars_os() {
        let of_package = ["CARGO_PKG_", "CARGO_MANIFEST_"];
        if of_package
            .iter()
            .any(|it| name.to_string_lossy().starts_with(it))
        {
            cargo.env_remove(name);
        }
    }
    cargo
}

fn run(project: &Path, arguments: &[&str]) -> Output {
    command()
        .args(arguments)
        .arg("--offline")
        .current_dir(project.join("fc-generated"))
        .env("CARGO_TARGET_DIR", target())
        .env("RUSTDOCFLAGS", "-D warnings")
        .output()
        .unwrap()
}
