//! All integration tests are one program, because a program per file would link the crate each time. Only
//! `syntax_memory` needs a separate process.

#![allow(
    clippy::cast_precision_loss,
    clippy::expect_used,
    clippy::format_collect,
    clippy::format_push_string,
    clippy::indexing_slicing,
    clippy::missing_panics_doc,
    clippy::panic,
    clippy::print_stdout,
    clippy::string_slice,
    clippy::unwrap_used,
    reason = "tests"
)]

mod audience;
mod both_languages;
mod comments;
mod declared_faults;
mod explain_examples;
mod faults;
mod fix;
mod format_layout;
mod format_property;
mod format_support;
mod good_spec;
mod grammar;
mod json_schema;
mod lint;
mod load;
mod merge;
mod partial;
mod patterns;
mod schema;
mod schema_misfits;
mod settle;
mod slips;
mod slips_made;
mod spec;
mod syntax_adversarial;
mod syntax_explain;
mod syntax_limits;
mod syntax_oracle;
mod syntax_property;
mod syntax_render;
mod syntax_support;
mod uses;
mod yaml_as_json;
