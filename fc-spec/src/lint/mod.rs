//! The lint: style rules over a model, with levels, waivers and the rules of a project.
//!
//! A [`Rule`] holds the data of a rule and a function that searches the model. Each category has one file. STANDARD contains MINIMAL, as in
//! buf: the level of STANDARD also applies to MINIMAL, unless MINIMAL has a level. DOCS, WIRE and SUNSET are separate, so that a project
//! can enable each of them independently.
//!
//! [`settings`] reads the key `lint` of `fc.yaml`. [`lint`] searches, [`waive`] applies waivers, and [`faults`] gives each finding its
//! level and its place.

mod docs;
mod finding;
mod minimal;
mod path;
mod place;
mod predicate;
mod project_rules;
mod rule;
mod search;
mod settings;
mod standard;
mod sunset;
mod waive;
mod wire;

pub use finding::Finding;
pub use place::faults;
pub use rule::{Category, Level, Rule};
pub use settings::{Settings, settings};
pub use waive::waive;

use crate::model::Model;
use search::Search;

/// All rules, by category, in the order of their codes.
const RULES: &[&[Rule]] = &[
    minimal::RULES,
    standard::RULES,
    docs::RULES,
    wire::RULES,
    sunset::RULES,
    project_rules::RULES,
];

/// Returns the findings of all rules in a model on a day, `YYYY-MM-DD`, including the rules of the project.
///
/// The result includes rules with the level off: a waiver is not unused because a level is off.
#[must_use]
pub fn lint(model: &Model, settings: &Settings, today: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for rule in Rule::all() {
        let Some(find) = rule.find else { continue };
        let mut search = Search {
            model,
            today,
            rule,
            found: Vec::new(),
        };
        find(&mut search);
        findings.append(&mut search.found);
    }
    findings.append(&mut project_rules::find(model, settings.house()));
    findings
}
