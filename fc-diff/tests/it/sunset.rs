//! Removes operations before and after their announced sunset.

use crate::support::{base, model};
use fc_diff::gone_early;

#[test]
fn removal_before_its_sunset_is_unannounced() {
    let old = model(&base()).expect("the spec");
    let withdrawn = old.operations.iter().find_map(|it| {
        let sunset = it.deprecated.as_ref()?.sunset.clone()?;
        Some((it.name.clone(), sunset))
    });
    let (name, sunset) = withdrawn.expect("an operation with a sunset");
    assert_eq!(sunset, "2027-06");
    let mut new = old.clone();
    new.operations.retain(|it| it.name != name);

    let early = gone_early(&old, &new, "2027-06-30");
    let early: Vec<_> = early
        .iter()
        .map(|it| (it.rule.number, it.subject.as_str()))
        .collect();
    assert_eq!(early, [(63, name.as_str())]);
    assert!(gone_early(&old, &new, "2027-07-01").is_empty());
    assert!(gone_early(&old, &old, "2027-06-30").is_empty());
}
