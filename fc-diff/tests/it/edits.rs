//! Applies every change of `edits.txt` in both directions and compares the findings with those that the file lists. It
//! also checks that each rule has a mirror.

use crate::support::{base, edits, edits_path, model};
use fc_diff::{Deployment, Finding, Rule, diff};
use std::collections::BTreeSet;
use std::fmt::Write as _;

fn line(finding: &Finding) -> String {
    let mut line = format!("{} {}", finding.rule.name, finding.subject);
    let mut word = |word: &str| {
        // Writing to a String cannot fail.
        let _ = write!(line, " | {word}");
    };
    for deployment in &finding.wire {
        word(match deployment {
            Deployment::OldAppNewRobot => "old app",
            Deployment::NewAppOldRobot => "new app",
        });
    }
    if !finding.source.is_empty() {
        let names: Vec<_> = finding.source.iter().map(|it| it.name()).collect();
        word(&names.join(" "));
    }
    for (is, name) in [(finding.behaviour, "behaviour"), (finding.silent, "silent")] {
        if is {
            word(name);
        }
    }
    line
}

#[test]
fn every_change_is_judged_as_it_should_be() {
    let base = base();
    let old = model(&base).expect("the spec");
    let (head, edits) = edits();
    let bless = std::env::var_os("FC_BLESS").is_some();
    let (mut blessed, mut wrong) = (head, String::new());
    for edit in &edits {
        let new = model(&edit.apply(&base));
        let new = new.unwrap_or_else(|faults| panic!("{}: {faults}", edit.name));
        let found = [diff(&old, &new), diff(&new, &old)];
        let lines = found
            .each_ref()
            .map(|found| found.iter().map(line).collect::<Vec<_>>());
        if lines != edit.found {
            let _ = writeln!(wrong, "{}: {lines:#?}", edit.name);
        }
        let _ = writeln!(blessed, "== {}\n@ {}", edit.name, edit.file);
        let signed = [
            ("-", edit.texts[0].split('\n').map(str::to_owned).collect()),
            ("+", edit.texts[1].split('\n').map(str::to_owned).collect()),
            ("> ", lines[0].clone()),
            ("< ", lines[1].clone()),
        ];
        for (sign, lines) in signed {
            for line in lines {
                let _ = writeln!(blessed, "{sign}{line}");
            }
        }
        blessed.push('\n');
    }
    if bless {
        std::fs::write(edits_path(), blessed.trim_end().to_owned() + "\n").expect("written");
    } else {
        assert_eq!(wrong, "");
    }
    println!("{} changes, {} pairs", edits.len(), edits.len() * 2);
}

#[test]
fn each_finding_has_a_mirror() {
    let base = base();
    let old = model(&base).expect("the spec");
    let mut seen = BTreeSet::new();
    for edit in edits().1 {
        let new = model(&edit.apply(&base)).expect("a spec");
        for found in [
            [diff(&old, &new), diff(&new, &old)],
            [diff(&new, &old), diff(&old, &new)],
        ] {
            for finding in &found[0] {
                seen.insert(finding.rule.number);
                let is_mirrored = finding.rule.mirror.is_empty()
                    || (found[1].iter()).any(|it| finding.rule.mirror.contains(&it.rule.number));
                assert!(is_mirrored, "{}: {}", edit.name, line(finding));
            }
        }
    }
    let unseen: Vec<_> = Rule::all()
        .filter(|rule| !seen.contains(&rule.number))
        .collect();
    let names: Vec<_> = unseen.iter().map(|rule| rule.name).collect();
    assert_eq!(names, UNSHOWN.map(|(name, _)| name), "rules without a pair");
}

/// Rules that no change of `edits.txt` shows, each with the reason.
const UNSHOWN: [(&str, &str); 5] = [
    (
        "operation-port-changed",
        "FC0510: the port follows from the kind",
    ),
    ("waiver-expired", "no change: tests/it/release.rs"),
    ("waiver-unused", "no change: tests/it/release.rs"),
    ("waiver-refused", "no change: tests/it/release.rs"),
    (
        "retired-key-reused",
        "it takes three versions: tests/it/history.rs",
    ),
];

#[test]
fn each_rule_has_texts_and_a_mirror_or_a_reason() {
    let numbers: Vec<_> = Rule::all().map(|rule| rule.number).collect();
    assert_eq!(numbers, (0..=82).collect::<Vec<_>>());
    for rule in Rule::all() {
        let has_reason = rule.no_mirror.iter().all(|text| !text.is_empty());
        assert_ne!(rule.mirror.is_empty(), !has_reason, "{}", rule.name);
        for text in [rule.title, rule.text].concat() {
            assert!(!text.is_empty(), "{}", rule.name);
        }
        for number in rule.mirror {
            let mirror = Rule::all().find(|it| it.number == *number);
            assert!(mirror.is_some(), "{}: {number}", rule.name);
        }
        assert_eq!(
            Rule::parse(&rule.code()).map(|it| it.number),
            Some(rule.number)
        );
    }
}

#[test]
fn equal_specs_have_no_findings() {
    let model = model(&base()).expect("the spec");
    assert_eq!(
        diff(&model, &model).iter().map(line).collect::<Vec<_>>(),
        [""; 0]
    );
}
