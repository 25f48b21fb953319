//! All integration tests in one program. One program per file would link the crate each time.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

mod agreement;
mod bodies;
mod boundary;
mod faults;
mod frames;
mod judges;
mod mutate;
mod names;
mod samples;
mod support;
#[path = "../../../fc-test/tally.rs"]
mod tally;
mod vectors;
