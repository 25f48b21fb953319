//! A language server for protocol specs: what an editor asks while one types, answered by what `fcproto` knows anyway.
//!
//! ```text
//! editor ──messages──► serve ──► Workspace: the project's files, those that are open as the editor has them
//!                        │            └──► Snapshot: one state of them, and what has been found out about it
//!                        ├──► one file per request: pure functions from a snapshot to an answer
//!                        └──► Worker: a thread that checks the newest snapshot, and answers what waits for that
//! ```
//!
//! **Architecture invariant.** Nothing here reads YAML or judges a spec: texts are read, checked, laid out and renamed in by
//! `fc-spec`, compared by `fc-diff`, spelled in Rust by `fc-codegen`, and shown as JSON by `fc-reflect`. A file that is
//! open is never read from the disk.

mod actions;
mod completion;
mod definition;
mod diagnostics;
mod dispatch;
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
pub use project::{Host, Project};
pub use references::references;
pub use rename::{prepare_rename, rename};
pub use serve::{ServeError, serve};
pub use settings::Settings;
pub use snapshot::Snapshot;
pub use symbols::{document_symbols, workspace_symbols};
pub use workspace::Workspace;
