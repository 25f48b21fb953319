//! Tests the edits of a release.

use crate::support::{base, model};
use fc_diff::NextRelease;
use fc_diff::release::{Number, Objection, Releases};
use fc_spec::model::Model;
use fc_spec::source::Sources;

/// A waiver of a change, and one of a lint finding.
const WAIVERS: &str = "waivers:
  FC0725-1a2b3c4d5e6f: { by: A, until: 2999-01-01, zh: 原因, en: Reason }
  FC0801-1a2b3c4d5e6f: { by: A, until: 2999-01-01, zh: 原因, en: Reason }
";

fn number(text: &str) -> Number {
    text.parse().expect("a number")
}

/// Returns the base spec with waivers.
fn waived() -> Sources {
    let base = base();
    let files = base.iter();
    let files = files.map(|(_, file)| (file.path.as_str(), file.text.as_str()));
    Sources::from_texts(files.chain([("spec/waivers.yaml", WAIVERS)]))
}

fn prepared(sources: &Sources) -> Option<NextRelease> {
    let check = |sources: Sources| model(&sources);
    NextRelease::prepare(&number("2999.01"), sources, check).expect("a valid spec")
}

fn waivers(model: &Model) -> Vec<&str> {
    model.waivers.iter().map(|it| it.id.as_str()).collect()
}

#[test]
fn release_has_its_number_and_no_used_waiver() {
    let next = prepared(&waived()).expect("a version");
    assert_eq!(next.agreed.protocol.version, "2999.01");
    assert_eq!(next.released.protocol.version, "2999.01");
    let lint = "FC0801-1a2b3c4d5e6f";
    assert_eq!(waivers(&next.agreed), ["FC0725-1a2b3c4d5e6f", lint]);
    assert_eq!(waivers(&next.released), [lint]);
    assert_eq!(next.diffs.len(), 2);
    assert!(next.left.is_empty());
}

#[test]
fn waiver_in_flow_style_is_left() {
    let flow = WAIVERS
        .replace("\n  ", " ")
        .replace("waivers:", "waivers: {");
    let flow = flow.replace("} FC", "}, FC").trim_end().to_owned() + " }\n";
    let waived = waived();
    let files = waived.iter().map(|(_, file)| {
        let is_ours = file.path == "spec/waivers.yaml";
        let text = if is_ours { &flow } else { &file.text };
        (file.path.as_str(), text.as_str())
    });
    let next = prepared(&Sources::from_texts(files)).expect("a version");
    assert_eq!(next.left, ["FC0725-1a2b3c4d5e6f"]);
    assert_eq!(next.diffs.len(), 1);
}

#[test]
fn spec_without_a_version_has_no_release() {
    assert!(prepared(&Sources::from_texts([("spec/types.yaml", "types: {}\n")])).is_none());
}

#[test]
fn release_before_the_version_goes_back() {
    let next = prepared(&base()).expect("a version");
    let objections = next.objections("3000.01", &Releases::default(), None);
    assert!(matches!(
        objections.as_slice(),
        [Objection::GoesBack { .. }]
    ));
    assert!(
        next.objections("2024.01", &Releases::default(), None)
            .is_empty()
    );
}
