//! All integration tests in one program. One program per file would link the crate each time.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::string_slice,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

mod churn;
mod comments;
mod conditions;
mod constructions;
mod docs_support;
mod emit_kotlin;
mod emit_markdown;
mod emit_python;
mod emit_rust;
mod emit_typescript;
mod emit_vectors;
mod emitters;
mod error_names;
mod features;
#[allow(dead_code, reason = "a part of it is used here")]
#[path = "../../../fc-spec/tests/it/good_spec.rs"]
mod good_spec;
mod hostile_dump;
mod inspect;
#[allow(dead_code, reason = "a part of it is used here")]
#[path = "../../../fc-spec/tests/it/json_schema.rs"]
mod json_schema;
mod load_property;
mod names;
mod output;
mod project;
mod rooms;
mod target;
mod touch;
mod vector_words;
mod version;
mod vocabulary;
mod wire_facts;
mod words;
