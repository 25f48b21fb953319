//! Keys, values and codes that return with another meaning after several releases.

use crate::support::{base, model, with};
use fc_diff::{Deployment, Finding, Packages, diff, diff_since};
use fc_spec::model::Model;

/// Additions that the first and the last version have after a line of a file.
struct Case {
    file: &'static str,
    behind: &'static str,
    first: &'static str,
    last: &'static str,
}

/// Returns the first version, a version without the additions, and the last version.
fn versions(case: &Case) -> [Model; 3] {
    let base = base();
    let of = |more: &str| {
        let text = format!("{}{more}", case.behind);
        let sources = with(&base, case.file, case.behind, &text);
        model(&sources).unwrap_or_else(|faults| panic!("{faults}"))
    };
    [of(case.first), of(""), of(case.last)]
}

const GROUP: &str = "commands/lamp.yaml";
const BEHIND_REQUEST: &str = "        anything: { type: \"json?\", zh: 任意, en: Anything }\n";
const BEHIND_REPORT: &str = "en: Afterglow }\n";
const BEHIND_VALUES: &str = "zh: 损坏, en: Broken }\n";
const BEHIND_RESULTS: &str = "results:\n";

/// Returns the findings that a comparison without earlier releases lacks.
fn reused(earlier: &[(&str, &Model)], old: &Model, new: &Model) -> Vec<Finding> {
    let known: Vec<_> = diff(old, new)
        .into_iter()
        .map(|it| it.fingerprint)
        .collect();
    let found = diff_since(earlier.iter().copied(), old, new, Packages::default());
    let found = found
        .into_iter()
        .filter(|it| !known.contains(&it.fingerprint));
    // Rule 63 reports that the version did not change.
    found.filter(|it| it.rule.number != 63).collect()
}

/// Returns rule, subject, deployments and silence of each finding.
fn found(case: &Case) -> Vec<(u8, String, Vec<Deployment>, bool)> {
    let [first, without, last] = versions(case);
    let found = reused(&[("7", &first)], &without, &last);
    for finding in &found {
        assert!(finding.is_break(), "{finding:?}");
        assert!(
            finding.message.en.contains("(7)") || finding.rule.number == 18,
            "{finding:?}"
        );
        assert!(!finding.new.is_empty());
    }
    let found = found.into_iter();
    found
        .map(|it| (it.rule.number, it.subject, it.wire, it.silent))
        .collect()
}

#[test]
fn key_back_with_another_type_is_a_break() {
    use Deployment::{NewAppOldRobot, OldAppNewRobot};
    let case = Case {
        file: GROUP,
        behind: BEHIND_REQUEST,
        first: "        heat: { type: \"u8?\", example: 3, zh: 热度, en: Heat }\n",
        last: "        heat: { type: \"string?\", example: a, zh: 热度, en: Heat }\n",
    };
    let subject = "set_level.request.data.heat".to_owned();
    let wire = vec![OldAppNewRobot, NewAppOldRobot];
    assert_eq!(found(&case), [(76, subject, wire, false)]);
    // The comparison with the last release finds no break.
    let [_, without, last] = versions(&case);
    assert!(diff(&without, &last).iter().all(|it| it.wire.is_empty()));
}

#[test]
fn key_back_in_another_unit_is_a_silent_break() {
    let case = Case {
        file: GROUP,
        behind: BEHIND_REPORT,
        first: "      heat: { type: \"u16?\", unit: m, example: 3, zh: 热度, en: Heat }\n",
        last: "      heat: { type: \"u16?\", unit: mm, example: 3, zh: 热度, en: Heat }\n",
    };
    let found = found(&case);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, found[0].2.len(), found[0].3), (76, 2, true));
}

#[test]
fn key_back_as_it_was_is_none() {
    let heat = "        heat: { type: \"u8?\", example: 3, zh: 热度, en: Heat }\n";
    let case = Case {
        file: GROUP,
        behind: BEHIND_REQUEST,
        first: heat,
        last: heat,
    };
    assert_eq!(found(&case), []);
}

#[test]
fn value_back_under_another_name_is_a_silent_break() {
    let case = Case {
        file: "types.yaml",
        behind: BEHIND_VALUES,
        first: "      6: { name: lost, error: true, zh: 丢失, en: Lost }\n",
        last: "      6: { name: stolen, error: true, zh: 被偷, en: Stolen }\n",
    };
    let found = found(&case);
    assert_eq!(found.len(), 1, "{found:?}");
    let (number, subject, wire, silent) = &found[0];
    assert_eq!(
        (*number, subject.as_str(), wire.len(), *silent),
        (76, "Phase.stolen", 2, true)
    );
}

#[test]
fn result_back_under_another_name_is_a_silent_break() {
    let case = Case {
        file: "protocol.yaml",
        behind: BEHIND_RESULTS,
        first: "  6: { name: no_power, zh: 没电, en: No power, about: { zh: 停电, en: None } }\n",
        last: "  6: { name: no_mains, zh: 没接, en: No mains, about: { zh: 没插, en: None } }\n",
    };
    let found = found(&case);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].0, found[0].1.as_str(), found[0].3),
        (76, "results.no_mains", true)
    );
}

#[test]
fn code_back_for_another_command_is_never_released() {
    let case = Case {
        file: GROUP,
        behind: "commands:\n",
        first: "  blink: { code: 0x0105, zh: 闪烁, en: Blink, effect: config, source: { sections: [] } }\n",
        last: "  sing: { code: 0x0105, zh: 唱歌, en: Sing, effect: config, source: { sections: [] } }\n",
    };
    let found = found(&case);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, found[0].1.as_str()), (18, "0x0105"));
}

#[test]
fn last_of_several_meanings_counts() {
    let case = |last: &'static str| Case {
        file: GROUP,
        behind: BEHIND_REQUEST,
        first: "        heat: { type: \"u8?\", example: 3, zh: 热度, en: Heat }\n",
        last,
    };
    let [first, without, second] = versions(&case(
        "        heat: { type: \"string?\", example: a, zh: 热度, en: Heat }\n",
    ));
    let [_, _, last] = versions(&case(
        "        heat: { type: \"bool?\", example: true, zh: 热度, en: Heat }\n",
    ));
    let found = reused(&[("9", &second), ("7", &first)], &without, &last);
    assert_eq!(found.len(), 1);
    assert!(
        found[0].message.en.contains("string (9) → bool"),
        "{}",
        found[0].message.en
    );
}
