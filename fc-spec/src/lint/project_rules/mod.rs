//! HOUSE: the rules of a project, and the rules about its use of the lint.

mod parse;

use crate::diagnostic::LintCode;
use crate::index::DefId;
use crate::language::grammar as language;
use crate::lint::finding::Finding;
use crate::lint::predicate::Test;
use crate::lint::rule::{Category, Level, Rule};
use crate::lint::search::{of_field, of_group, of_operation, of_type, of_value, of_variant};
use crate::model::{Model, Text, TypeShape};
use serde_json::Value;

/// The rule for all findings of rules of the project.
pub(super) const HOUSE_RULE: &Rule = &Rule {
    code: LintCode {
        number: "FC0890",
        title: ["violation of a rule of this project", "违反本项目的规则"],
        text: [
            "A rule under `lint` in `fc.yaml` is violated. The message is the text of the rule, followed by its `id`. Use the `id` in `levels` to \
         set its level.",
            "违反了 `fc.yaml` 的 `lint` 中的规则。提示内容是规则的文字，后面是它的 `id`；在 `levels` 中用 `id` 设置级别。",
        ],
    },
    category: Category::House,
    name: "house-rule",
    level: Level::Warning,
    find: None,
};

/// An expired waiver.
pub(super) const WAIVER_OVER: &Rule = &Rule {
    code: LintCode {
        number: "FC0891",
        title: [
            "the waiver of this finding has expired",
            "该提示的豁免已过期",
        ],
        text: [
            "The waiver of a finding has expired. Fix the finding, or agree on another date.",
            "提示的豁免已过期。改正提示的问题，或商定新的期限。",
        ],
    },
    category: Category::House,
    name: "waiver-over",
    level: Level::Error,
    find: None,
};

/// A waiver without a finding.
pub(super) const WAIVER_UNUSED: &Rule = &Rule {
    code: LintCode {
        number: "FC0892",
        title: ["waiver without a finding", "豁免没有对应的提示"],
        text: [
            "The lint has no finding for this waiver: the problem was fixed, or the thing was renamed. Remove the waiver. Levels make no difference: \
         a rule that is off still has findings for its waivers.",
            "这条豁免没有对应的提示：问题已经改正，或者对象改了名。删除这条豁免。与级别无关：关闭的规则仍会查找，供豁免对应。",
        ],
    },
    category: Category::House,
    name: "unused-waiver",
    level: Level::Error,
    find: None,
};

/// An invalid key or value under `lint`.
pub(super) const SETTINGS: &Rule = &Rule {
    code: LintCode {
        number: "FC0893",
        title: ["invalid setting of the lint", "无效的检查设置"],
        text: [
            "`lint` in `fc.yaml` has an unknown rule, category, path or test. Paths are those of `fcproto inspect`. The lint does not run until \
         you correct it, because a rule with a typo would silently find nothing.",
            "`fc.yaml` 的 `lint` 中有未知的规则、类别、路径或判断方式。路径与 `fcproto inspect` 的输出一致。改正之前不作检查：写错的规则永远不会有提示。",
        ],
    },
    category: Category::House,
    name: "lint-settings",
    level: Level::Error,
    find: None,
};

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
    let mut look = |item: DefId, value: &dyn Fn() -> serde_json::Result<Value>| {
        let mut rules = rules.iter().filter(|rule| rule.on.contains(&item.kind));
        let Some(first) = rules.next() else { return };
        // A part of a model always serializes.
        let Ok(value) = value() else { return };
        for rule in std::iter::once(first).chain(rules) {
            if rule.only.holds(&value) && !rule.require.holds(&value) {
                let mut finding = Finding::new(HOUSE_RULE, item.clone(), rule.text.clone());
                finding.house = Some(rule.id.clone());
                findings.push(finding);
            }
        }
    };
    for group in &model.groups {
        look(of_group(group), &|| serde_json::to_value(group));
    }
    for operation in &model.operations {
        look(of_operation(operation), &|| serde_json::to_value(operation));
    }
    for ty in &model.types {
        look(of_type(ty), &|| serde_json::to_value(ty));
        match &ty.shape {
            TypeShape::Struct(shape) => {
                for field in &shape.fields {
                    look(of_field(ty, field), &|| serde_json::to_value(field));
                }
            }
            TypeShape::Enum(shape) => {
                for value in &shape.values {
                    look(of_value(ty, value), &|| serde_json::to_value(value));
                }
            }
            TypeShape::OneOf(choice) => {
                for variant in &choice.variants {
                    look(of_variant(ty, variant), &|| serde_json::to_value(variant));
                }
            }
        }
    }
    findings
}
