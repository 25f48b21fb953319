//! Source text: files in memory, positions in them, and edits of them. This module does not depend on YAML.

mod edit;
mod files;
mod span;

pub(crate) use edit::{Edits, changed_lines};
pub use files::{SourceFile, Sources};
pub use span::{FileId, LineCol, Span};
