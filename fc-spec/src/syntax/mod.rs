//! From YAML text to a spanned syntax tree.
//!
//! **Architecture invariant.** This module alone knows the YAML parser, and it knows nothing of the
//! spec language: what keys mean is the loader's business. Everything YAML offers beyond plain
//! mappings, lists and scalars (anchors, aliases, tags, merge keys, directives, several documents) is a
//! fault here, so that the rest of the crate never meets it.
//!
//! Line ends may be LF or CRLF. A byte order mark at the start of a file is dropped; spans count from
//! behind it.

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
pub use node::{Entries, Entry, Items, Node, NodeKind, Scalar, Style, Tree};
pub use parse::parse;
pub(crate) use parse::parse_parts;
pub(crate) use quote::quoted;
pub use read::{read_bytes, read_dir, read_files};
