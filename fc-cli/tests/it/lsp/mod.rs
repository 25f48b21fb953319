//! `fcproto lsp`, driven by an editor.

mod answers;
mod completion;
mod editor;
mod faults;
mod lens;
mod rename;
mod session;

use crate::support::Project;

const TYPES: &str = "spec/types.yaml";
const LAMP: &str = "spec/commands/lamp.yaml";
const PROTOCOL: &str = "spec/protocol.yaml";

/// Creates the small project without the lint. A file has no diagnostics until a test adds an error.
fn project() -> Project {
    let project = Project::new();
    let off = r#"{ MINIMAL: "off", DOCS: "off", STANDARD: "off", SUNSET: "off", WIRE: "off" }"#;
    project.write("fc.yaml", &format!("lint: {{ levels: {off} }}\n"));
    project
}
