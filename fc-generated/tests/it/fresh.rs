//! The committed output matches the committed spec.

use crate::support;
use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::target::Targets;

#[test]
fn committed_files_match_the_spec() {
    let root = support::root();
    let plan = plan(
        generate(&support::model(&root), &Targets::default()).unwrap(),
        &root,
        &[],
    )
    .unwrap();
    // Five diffs are enough here. The command shows all of them.
    let diffs: String = plan
        .diffs()
        .into_iter()
        .take(5)
        .map(|diff| diff.text)
        .collect();
    assert!(
        plan.is_fresh(),
        "{diffs}\nin the way: {:?}\nrun `cargo run -p fc-cli -- generate`",
        plan.foreign
    );
}
