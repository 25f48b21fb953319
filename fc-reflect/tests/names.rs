//! The names of errors are those of the list that all implementations share.

#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "tests")]

use fc_reflect::{BodyFault, FrameFault};
use serde_json::Value;
use std::collections::BTreeSet;

/// What only typed lists can exceed.
const TYPED: &str = "lists_too_large";

#[test]
fn names_are_those_of_the_shared_list() {
    let list: Value =
        serde_json::from_str(include_str!("../../conformance/errors.json")).expect("JSON");
    let shared = |place: &str| -> BTreeSet<String> {
        let errors = list["errors"].as_array().into_iter().flatten();
        let here = errors.filter(|error| error["where"] == place);
        let names = here.filter_map(|error| error["name"].as_str());
        names
            .filter(|name| *name != TYPED)
            .map(str::to_owned)
            .collect()
    };
    let frame: BTreeSet<_> = FrameFault::ALL
        .iter()
        .map(|fault| fault.name().to_owned())
        .collect();
    let body: BTreeSet<_> = BodyFault::ALL
        .iter()
        .map(|fault| fault.name().to_owned())
        .collect();
    assert_eq!(frame, shared("frame"));
    assert_eq!(body, shared("body"));
}
