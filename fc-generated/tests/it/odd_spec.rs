//! Tests the generator with a protocol that differs from the real one as much as the language allows (`odd/spec`).
//! Where names are free, it uses names with a meaning in Rust or in the generated code. The generated crate and its
//! documentation compile without a warning, and its stubs and samples work.

use crate::support;
use crate::support::nested;
use std::path::Path;

#[test]
#[ignore = "compiles a crate of its own"]
fn an_odd_protocol_compiles_and_works() {
    let odd = support::root().join("fc-generated/tests/odd");
    let model = support::model(&odd);
    let project = Path::new(env!("CARGO_TARGET_TMPDIR")).join("odd");
    nested::write_crate(&project, &model, &[&odd.join("stubs.rs")]);
    nested::cargo(&project, &["test", "--test", "stubs", "--test", "samples"]);
    nested::cargo(&project, &["check", "--no-default-features"]);
    nested::cargo(&project, &["doc", "--no-deps"]);
}
