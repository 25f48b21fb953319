//! Parses YAML into a syntax tree with spans.
//!
//! **Architecture invariant.** Only this module uses the YAML parser, and it contains no rule of the spec language. The
//! loader defines the meaning of keys. Anchors, aliases, tags, merge keys, directives and several documents are errors
//! here, so that the rest of the crate never sees them.
//!
//! Line ends are LF or CRLF. A byte order mark at the start of a file is dropped, and spans do not count it.

mod builder;
mod comment;
mod conflict;
mod control;
mod find;
mod key;
pub mod limits;
mod node;
mod parse;
mod parser;
mod quote;
mod read;
mod recover;
mod scan_error;
mod scan_words;
mod slip;
mod tab;
mod tree;
pub(crate) mod width;

pub(crate) use control::visible;
pub use find::is_spec_file;
pub use node::{Entries, Entry, Items, Node, NodeKind, Scalar, Style};
pub use parse::parse;
pub(crate) use parse::{parse_faultless, parse_parts};
pub(crate) use quote::quoted;
pub use read::{read_bytes, read_dir, read_files};
pub use tree::Tree;
