//! The integration tests, as one program: a program per file would link the crate each time.

#![allow(clippy::expect_used, clippy::panic, reason = "tests")]

mod edits;
mod execution;
mod moves;
mod release;
mod sunset;
mod support;
