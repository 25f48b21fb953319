//! What is no error and better otherwise: rules over a model, with levels, waivers and rules of the project's own.
//!
//! A rule says what it is in a table ([`Rule`]) and looks for it with a function over the model. Those of one category are in one file.
//! STANDARD contains MINIMAL, as in buf: who sets the level of STANDARD sets that of both, unless MINIMAL has one of its own.
//! DOCS, WIRE and SUNSET stand beside them, since a project wants each of them or not.
//!
//! [`settings`] are the key `lint` of `fc.yaml`; [`lint`] finds, [`waive`] applies waivers, [`faults`] gives each finding its level and its
//! place.

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

/// What the rules find in a model on a day, `YYYY-MM-DD`, those of the project included: of any level, since a waiver is not unused
/// because a level is off.
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
