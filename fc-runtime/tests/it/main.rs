//! The integration tests, as one program: a program per file would link the crate each time. `memory`, `network` and `restarts`
//! need a process each.

#![allow(
    clippy::cast_possible_truncation,
    clippy::expect_used,
    clippy::float_cmp,
    clippy::indexing_slicing,
    clippy::items_after_statements,
    clippy::large_stack_arrays,
    clippy::missing_panics_doc,
    clippy::must_use_candidate,
    clippy::panic,
    clippy::string_slice,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

mod abandoned;
mod allow;
mod answers;
mod blocking;
mod budget;
mod calls;
mod chaos;
mod common;
mod conformance;
mod crowds;
mod data;
mod encoding;
mod fairness;
mod following;
mod frames;
mod guides;
mod handshakes;
mod hostile;
mod ids;
mod json_errors;
mod json_grammar;
#[allow(dead_code, reason = "a part of it is used here")]
#[path = "../../../fc-spec/tests/it/json_schema.rs"]
mod json_schema;
mod json_values;
mod keepalive;
mod limits;
mod lines;
mod logs;
mod lone;
mod long_frames;
mod losses;
mod meanwhile;
mod metrics;
mod observing;
mod owners;
mod pace;
mod panics;
mod prepared;
mod reports;
mod sessions;
mod shutdown;
mod stalls;
mod states;
mod streams;
mod subscriptions;
#[path = "../../../fc-test/tally.rs"]
mod tally;
mod tree;
