//! All integration tests in one program. One program per file would link the crate each time.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::string_slice,
    reason = "tests"
)]

mod declared;
mod edits;
mod execution;
mod file_diff;
mod history;
mod moves;
mod next_release;
mod packages;
mod release;
mod sunset;
mod support;
