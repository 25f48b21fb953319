//! The integration tests of fc-diff, in one program: a program per file would link the crate each time.

#![allow(clippy::expect_used, clippy::panic, dead_code, reason = "tests")]

mod edits;
mod execution;
mod moves;
mod release;
mod sunset;
mod support;
