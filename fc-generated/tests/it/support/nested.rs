//! A separate crate around generated sources. The test builds and tests it with a nested cargo.

use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::model::Model;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Generates the crate in `project` from a model. The files in `tests` become its tests.
pub fn write_crate(project: &Path, model: &Model, tests: &[&Path]) {
    write_crate_for(project, model, &Targets::of([Product::Rust]), tests);
}

/// Like `write_crate`, for other targets, which must include the Rust package.
pub fn write_crate_for(project: &Path, model: &Model, targets: &Targets, tests: &[&Path]) {
    plan(generate(model, targets).unwrap(), project, &[])
        .unwrap()
        .write()
        .unwrap();

    let root = super::root();
    // In one target directory, cargo distinguishes crates by name and version, not by path. Each project needs its own
    // version, so that cargo does not use the build of another.
    let apart = project.file_name().unwrap().to_string_lossy();
    let apart = apart.replace('_', "-");
    // TOML and Rust quote and escape strings in the same way.
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
    // The versions of the workspace, so that cargo downloads nothing.
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    for test in tests {
        fs::copy(test, folder.join("tests").join(test.file_name().unwrap())).unwrap();
    }
}

/// Returns the target directory of all crates that tests generate, including those of fc-cli. Dependencies compile
/// once.
pub fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested")
}

/// Runs cargo in the crate and returns its output. It must succeed.
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

/// Runs cargo in the crate and returns its errors. It must fail.
pub fn refused(project: &Path, arguments: &[&str]) -> String {
    let output = run(project, arguments);
    assert!(!output.status.success(), "cargo {arguments:?} succeeded");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns cargo without the variables that describe this package. Build scripts that read them would run again.
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
