//! The integration tests, as one program: a program per file would link the crate each time.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

mod arguments;
mod certify;
mod decode;
mod drift;
mod faults;
mod guarantees;
mod mock;
mod scenarios;
mod sessions;
mod support;
