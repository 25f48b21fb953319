//! A language server for protocol specs.
//!
//! ```text
//! editor ──messages──► serve ──► Workspace: the project's files; open files have the editor's text
//!            │      └──► Snapshot: one state of the files, and the results computed for it
//!            ├──► one file per request: pure functions from a snapshot to an answer
//!            └──► Worker: a thread that checks the newest snapshot, and answers the requests that need it
//! ```
//!
//! **Architecture invariant.** This crate neither reads YAML nor checks a spec. `fc-spec` parses, checks, formats and
//! renames, and `fc-diff` compares. `fc-codegen` generates Rust, and `fc-reflect` generates JSON. The server never
//! reads an open file from the disk.

mod actions;
mod completion;
mod definition;
mod diagnostics;
mod dispatch;
mod event;
mod formatting;
mod hover;
mod item;
mod language;
mod lens;
mod position;
mod project;
mod queue;
mod references;
mod rename;
mod serve;
mod settings;
mod snapshot;
mod symbols;
mod uri;
mod worker;
mod workspace;

pub use actions::{actions, fix_all};
pub use completion::completion;
pub use definition::definition;
pub use diagnostics::{diagnostics, text};
pub use formatting::formatting;
pub use hover::hover;
pub use lens::lenses;
pub use position::Encoding;
pub use project::Project;
pub use references::references;
pub use rename::{prepare_rename, rename};
pub use serve::{ServeError, serve};
pub use settings::Settings;
pub use snapshot::Snapshot;
pub use symbols::{document_symbols, workspace_symbols};
pub use workspace::Workspace;
