//! The generator against a protocol as unlike the real one as the language allows (`odd/spec`), with
//! names that mean something to Rust or to the generated code wherever names are free: what it makes
//! compiles without a warning, its documentation too, and its stubs and samples work.

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
