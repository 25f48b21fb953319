//! HOUSE: the rules of a project, and the rules about its use of the lint.

mod parse;

use crate::index::DefId;
use crate::language::grammar as language;
use crate::lint::finding::Finding;
use crate::lint::predicate::Test;
use crate::lint::rule::{Level, Rule, rule};
use crate::lint::search::subjects;
use crate::model::{Model, Text};

/// The rule for all findings of rules of the project.
pub(super) const HOUSE_RULE: &Rule = &rule!(FC0890 "house-rule" House Warning None, "违反本项目的规则" "violation of a rule of this project");

/// An expired waiver.
pub(super) const WAIVER_OVER: &Rule = &rule!(FC0891 "waiver-over" House Error None, "该提示的豁免已过期" "the waiver of this finding has expired");

/// A waiver without a finding.
pub(super) const WAIVER_UNUSED: &Rule = &rule!(FC0892 "unused-waiver" House Error None, "豁免没有对应的提示" "waiver without a finding");

/// An invalid key or value under `lint`.
pub(super) const SETTINGS: &Rule =
    &rule!(FC0893 "lint-settings" House Error None, "无效的检查设置" "invalid setting of the lint");

pub(super) const RULES: &[Rule] = &[*HOUSE_RULE, *WAIVER_OVER, *WAIVER_UNUSED, *SETTINGS];

/// A rule of the project.
#[derive(Debug)]
pub(super) struct HouseRule {
    /// The id.
    pub id: String,
    /// The message of a finding.
    pub text: Text,
    /// The level, unless `levels` sets another.
    pub level: Level,
    /// The kinds of things that the rule tests.
    pub on: Vec<&'static str>,
    /// The condition: the rule applies only to things that pass this test.
    pub only: Test,
    /// The requirement: the other things are findings.
    pub require: Test,
}

/// Words for several kinds of things.
pub(super) const GROUPS: [(&str, &[&str]); 2] = [
    (
        "operation",
        &[
            language::Command::TABLE.name,
            language::Report::TABLE.name,
            language::Stream::TABLE.name,
        ],
    ),
    (
        "type",
        &[
            language::Struct::TABLE.name,
            language::Enum::TABLE.name,
            language::OneOf::TABLE.name,
        ],
    ),
];

/// Returns the findings of the rules of the project.
pub(super) fn find(model: &Model, rules: &[HouseRule]) -> Vec<Finding> {
    let mut findings = Vec::new();
    if rules.is_empty() {
        return findings;
    }
    for subject in subjects(model) {
        let item = DefId::from(subject);
        let mut rules = rules
            .iter()
            .filter(|rule| rule.on.contains(&item.kind))
            .peekable();
        if rules.peek().is_none() {
            continue;
        }
        // A part of a model always serializes.
        let Ok(value) = subject.dump() else { continue };
        for rule in rules {
            if rule.only.holds(&value) && !rule.require.holds(&value) {
                let mut finding = Finding::new(HOUSE_RULE, item.clone(), rule.text.clone());
                finding.house = Some(rule.id.clone());
                findings.push(finding);
            }
        }
    }
    findings
}
