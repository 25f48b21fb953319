//! `fc lsp`, driven by an editor.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::needless_pass_by_value,
    clippy::panic,
    clippy::single_match_else,
    clippy::too_many_lines,
    reason = "tests"
)]

mod answers;
mod completion;
mod editor;
mod faults;
mod lens;
mod rename;
mod session;
#[path = "../support/mod.rs"]
mod support;

use support::Project;

const TYPES: &str = "spec/types.yaml";
const LAMP: &str = "spec/commands/lamp.yaml";
const PROTOCOL: &str = "spec/protocol.yaml";

/// The small project, without the lint, so that nothing is told of a file in which a test has done no wrong.
fn project() -> Project {
    let project = Project::new();
    let off = r#"{ MINIMAL: "off", DOCS: "off", STANDARD: "off", SUNSET: "off", WIRE: "off" }"#;
    project.write("fc.yaml", &format!("lint: {{ levels: {off} }}\n"));
    project
}
