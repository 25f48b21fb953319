//! The integration tests, as one program: a program per file would link the crate each time. `ui` compiles programs.

// Expansions must pass strict lints of users.
#![deny(clippy::pedantic)]
#![allow(
    clippy::indexing_slicing,
    clippy::panic,
    clippy::struct_field_names,
    clippy::too_many_lines,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

mod condition;
mod header;
mod id;
mod message;
mod open_enum;
mod redacted;
mod service;
mod wire_number;
