//! All integration tests are one program, because a program per file would link the crate each time. Only `samples`,
//! which is generated, is separate.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    missing_docs,
    reason = "tests"
)]

mod adding_a_command;
mod assigning_codes;
#[cfg(all(feature = "blocking", feature = "server"))]
mod blocking;
#[cfg(all(feature = "client", feature = "server"))]
mod examples;
mod following;
mod fresh;
mod growing;
#[cfg(feature = "client")]
mod lossless;
mod odd_spec;
#[cfg(all(feature = "client", feature = "server"))]
mod operations;
mod other_protocols;
#[cfg(all(feature = "client", feature = "server"))]
mod partial;
mod projects;
mod readme;
#[cfg(all(feature = "client", feature = "server"))]
mod round_trip;
#[cfg(all(feature = "client", feature = "server"))]
mod stopping;
mod support;
#[path = "../../../fc-test/tally.rs"]
mod tally;
#[cfg(all(feature = "client", feature = "server"))]
mod tls;
mod vectors;
