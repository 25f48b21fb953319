//! The committed output is what the committed spec gives.

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
    // A few tell enough; the command shows them all.
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
