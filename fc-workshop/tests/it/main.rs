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
mod complete;
mod decode;
mod drift;
mod faults;
mod guarantees;
#[allow(dead_code, reason = "a part of it is used here")]
#[path = "../../../fc-spec/tests/it/json_schema.rs"]
mod json_schema;
mod mock;
mod replay;
mod scenarios;
mod sessions;
mod support;
mod table;
mod transcript;
#[cfg(feature = "view")]
mod view;
#[path = "../../../fc-spec/tests/it/yaml_as_json.rs"]
mod yaml_as_json;
