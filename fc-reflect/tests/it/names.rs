//! The names of frame errors match the list that all implementations share. The names of body errors come from the
//! runtime.

use fc_reflect::FrameFault;
use serde_json::Value;
use std::collections::BTreeSet;

#[test]
fn names_are_those_of_the_shared_list() {
    let list: Value =
        serde_json::from_str(include_str!("../../../conformance/errors.json")).expect("JSON");
    let errors = list["errors"].as_array().into_iter().flatten();
    let of_frames = errors.filter(|error| error["where"] == "frame");
    let shared: BTreeSet<_> = of_frames
        .filter_map(|error| error["name"].as_str())
        .collect();
    let ours: BTreeSet<_> = FrameFault::ALL.iter().map(|fault| fault.name()).collect();
    assert_eq!(ours, shared);
}
