//! A body with several errors is refused with the error that `conformance/faults.json` specifies.

use crate::support;
use crate::support::typed::{Typed, Verdict};
use crate::tally::Tally;
use fc_generated::Fc;
use fc_reflect::{Direction, Packing, Reflector};
use fc_runtime::Protocol as _;
use serde_json::Value;

#[test]
fn the_first_fault_is_named() {
    let model = support::specs::model();
    let reflector = Reflector::new(&model);
    let typed = Typed::new(&model);
    let file: Value =
        serde_json::from_str(include_str!("../../../conformance/faults.json")).expect("JSON");
    let faults = file["faults"].as_array().expect("a list");
    assert!(faults.len() > 10);
    let mut wrong = Vec::new();
    let mut tally = Tally::of("faults");
    for fault in faults {
        let word = |key: &str| fault[key].as_str().expect(key);
        let direction = match word("message") {
            "request" => Direction::Request,
            _ => Direction::Response,
        };
        let operation = model.operation(word("operation")).expect("an operation");
        let id = reflector.id(operation, direction, 1).expect("a code");
        let frame = reflector.seal(id, word("text").as_bytes(), Packing::Plain);
        let found = match typed.verdict(&frame.expect("a frame"), Fc::DEFAULTS.limits.json()) {
            Verdict::Refused(name, path, _) => (name, path),
            Verdict::Taken { .. } => ("taken", String::new()),
        };
        let path = fault["path"].as_str().unwrap_or(&found.1);
        if found.0 != word("error") || found.1 != path {
            wrong.push(format!("{found:?} in {fault}"));
        } else {
            tally.held(1);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
