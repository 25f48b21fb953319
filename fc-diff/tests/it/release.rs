//! Tests which release numbers the changes since the last release allow.

use crate::support::{base, edits, model};
use fc_diff::release::{Number, Objection, goes_back, objections};
use fc_diff::{About, Against, Finding, diff, waive};
use fc_spec::model::{Location, Text, Waiver};

/// Returns the findings of the first change of `edits.txt` that satisfies `is`.
fn found(is: impl Fn(&[Finding]) -> bool) -> Vec<Finding> {
    let base = base();
    let old = model(&base).expect("the spec");
    let mut all = edits().1.into_iter().map(|edit| {
        let mut found = diff(&old, &model(&edit.apply(&base)).expect("a spec"));
        // The changes of `edits.txt` keep the version of the spec, which this rule would report for each break.
        found.retain(|it| it.rule.name != "change-not-announced");
        found
    });
    all.find(|found| is(found)).expect("such a change")
}

fn number(text: &str) -> Number {
    text.parse().expect("a number")
}

fn breaks(found: &[Finding]) -> bool {
    found.iter().any(Finding::is_break) && !found.iter().any(|it| it.rule.is_error)
}

/// Returns the kinds of the objections.
fn names(objections: &[Objection]) -> Vec<&'static str> {
    let name = |it: &Objection| match it {
        Objection::NotLater { .. } => "not later",
        Objection::GoesBack { .. } => "goes back",
        Objection::Unchanged => "unchanged",
        Objection::TooSmall { part: 0, .. } => "first",
        Objection::TooSmall { .. } => "second",
        Objection::NotWaived { .. } => "not waived",
        Objection::Fault { .. } => "fault",
    };
    objections.iter().map(name).collect()
}

#[test]
fn release_number_moves_by_the_changes() {
    let nothing = Vec::new();
    let text =
        found(|found| !found.is_empty() && found.iter().all(|it| it.rule.about == About::Text));
    let change = found(|found| {
        found.iter().all(|it| it.wire.is_empty()) && found.iter().any(|it| !it.source.is_empty())
    });
    let break_ = found(breaks);
    let command = found(|found| found.iter().any(|it| it.rule.name == "command-added"));
    let cases: [(&str, &str, &[Finding], &[&str]); 18] = [
        ("1.2.3", "1.3", &command, &[]),
        ("2026.09", "2026.12", &command, &[]),
        ("1.2.3", "1.2.4", &nothing, &["unchanged"]),
        ("1.2.3", "1.2.3", &text, &["not later"]),
        ("1.2.3", "1.2", &text, &["not later"]),
        ("1.2.3", "1.2.4", &text, &[]),
        ("1.2.3", "1.2.4", &change, &["second"]),
        ("1.2.3", "1.3", &change, &[]),
        ("1.9", "1.10", &change, &[]),
        ("1.2.3", "2.0", &change, &[]),
        ("1.2.3", "1.3.0", &break_, &["first"]),
        ("1.2.3", "2.0.0", &break_, &[]),
        ("0.2.3", "0.2.4", &break_, &["second"]),
        ("0.2.3", "0.3.0", &break_, &[]),
        ("7", "8", &break_, &[]),
        ("2026.09", "2026.12", &change, &[]),
        ("2026.09", "2026.12", &break_, &["not waived"]),
        ("2026.09", "2026.08", &break_, &["not later", "not waived"]),
    ];
    for (last, next, found, expected) in cases {
        let objections = objections(&number(last), &number(next), found);
        assert_eq!(names(&objections), expected, "{last} to {next}");
    }
}

#[test]
fn waived_change_needs_the_step_of_an_addition() {
    let mut found = found(breaks);
    let text = Text {
        zh: "已商定".to_owned(),
        en: "Agreed".to_owned(),
    };
    let waiver = |id: String| Waiver {
        id,
        reason: text.clone(),
        by: "Zhang Wei".to_owned(),
        until: "2027-03".to_owned(),
        location: Location {
            file: String::new(),
            name: String::new(),
            line: 1,
        },
    };
    let broken = found.iter().filter(|it| !it.wire.is_empty());
    let waivers: Vec<_> = broken.map(|it| waiver(it.waiver_id())).collect();
    let (last, next) = (number("2026.09"), number("2026.12"));
    waive(&mut found, &waivers, "2027-03-31", Against::Release);
    assert_eq!(objections(&last, &next, &found), []);

    // A month later the waivers have expired.
    for finding in &mut found {
        finding.waived = None;
    }
    waive(&mut found, &waivers, "2027-04-01", Against::Release);
    let late = objections(&last, &next, &found);
    assert!(names(&late).contains(&"fault"), "{late:?}");
    assert!(names(&late).contains(&"not waived"), "{late:?}");
}

#[test]
fn a_code_that_is_used_again_is_never_released() {
    let found = found(|found| found.iter().any(|it| it.rule.name == "retired-code-reused"));
    for next in ["8", "2026.12"] {
        let objections = objections(&number("7"), &number(next), &found);
        assert!(names(&objections).contains(&"fault"), "{next}");
    }
}

#[test]
fn release_number_is_at_least_the_spec_version() {
    for (next, version, goes) in [
        ("2026.08", "2026.09", true),
        ("2026.09", "2026.09", false),
        ("2026.9", "2026.09", false),
        ("2026.12", "2026.09", false),
        ("1.0", "1", false),
        ("0.9", "1", true),
        // A version that is not a number sets no lower limit.
        ("0.9", "draft", false),
    ] {
        let objection = goes_back(&number(next), version);
        assert_eq!(objection.is_some(), goes, "{next} after {version}");
    }
}

#[test]
fn unused_waiver_is_found_when_decidable() {
    let waiver = |id: &str| Waiver {
        id: id.to_owned(),
        reason: Text {
            zh: "已商定".to_owned(),
            en: "Agreed".to_owned(),
        },
        by: "Zhang Wei".to_owned(),
        until: "2027-03".to_owned(),
        location: Location {
            file: String::new(),
            name: String::new(),
            line: 1,
        },
    };
    // The second waiver belongs to another check.
    let waivers = ["FC0717-000000000000", "FC0801-000000000000"].map(waiver);
    for (against, expected) in [
        (Against::Release, vec!["waiver-unused"]),
        (Against::Other, vec![]),
    ] {
        let mut found = Vec::new();
        waive(&mut found, &waivers, "2027-03-31", against);
        let names: Vec<_> = found.iter().map(|it| it.rule.name).collect();
        assert_eq!(names, expected);
    }

    let is_reused = |it: &Finding| it.rule.name == "retired-code-reused";
    let mut found = found(|found| found.iter().any(is_reused));
    let ids: Vec<_> = found.iter().filter(|it| is_reused(it)).collect();
    let waivers: Vec<_> = ids.iter().map(|it| waiver(&it.waiver_id())).collect();
    waive(&mut found, &waivers, "2027-03-31", Against::Release);
    assert!(
        found
            .iter()
            .filter(|it| is_reused(it))
            .all(|it| it.waived.is_none())
    );
    assert!(found.iter().any(|it| it.rule.name == "waiver-refused"));
}

#[test]
fn invalid_release_number_is_refused() {
    for text in [
        "",
        ".",
        "1.",
        "v1",
        "1.2.3.4.5",
        "1.-2",
        "+1",
        "99999999999999999999",
    ] {
        assert!(text.parse::<Number>().is_err(), "{text}");
    }
}
