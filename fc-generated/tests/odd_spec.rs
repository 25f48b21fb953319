//! The generator against a protocol as unlike the real one as the language allows (`odd/spec`), with
//! names that mean something to Rust or to the generated code wherever names are free: what it makes
//! compiles without a warning, its documentation too, and its stubs and samples work.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::wildcard_imports,
    missing_docs,
    reason = "tests"
)]

#[path = "support/nested.rs"]
mod nested;
mod support;

use std::path::Path;

#[test]
fn an_odd_protocol_compiles_and_works() {
    let odd = support::root().join("fc-generated/tests/odd");
    let model = support::model(&odd);
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join("odd");
    nested::write_crate(&project, &model, &[&odd.join("stubs.rs")]);
    nested::cargo(&project, &["test", "--test", "stubs", "--test", "samples"]);
    nested::cargo(&project, &["check", "--no-default-features"]);
    nested::cargo(&project, &["doc", "--no-deps"]);
}
