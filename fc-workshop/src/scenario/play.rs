//! The course of a scenario.

use super::{Action, Expected, Scenario, Verdict, fits};
use fc_spec::model::Value;

/// A scenario that is played.
#[derive(Debug)]
pub(crate) struct Play {
    scenario: Scenario,
    /// The number of uses of each rule.
    uses: Vec<u32>,
    /// The number of expected events that the app has caused.
    caused: usize,
    forbidden: Option<String>,
}

impl Play {
    pub(crate) fn new(scenario: Scenario) -> Self {
        Self {
            uses: vec![0; scenario.rules.len()],
            scenario,
            caused: 0,
            forbidden: None,
        }
    }

    /// Notes a request. Returns the action of the first rule that fits.
    pub(crate) fn request(&mut self, name: &str, request: &Value) -> Option<Action> {
        if self.scenario.never.iter().any(|never| never == name) && self.forbidden.is_none() {
            self.forbidden = Some(name.to_owned());
        }
        self.event(|expected| match expected {
            Expected::Request(wanted, with) => wanted == name && fits(with, request),
            Expected::Acknowledgement(_) => false,
        });
        let rules = self.scenario.rules.iter().zip(&mut self.uses);
        for (rule, uses) in rules {
            let is_left = rule.times.is_none_or(|times| *uses < times);
            if is_left && rule.request == name && fits(&rule.with, request) {
                *uses = uses.saturating_add(1);
                return Some(rule.action.clone());
            }
        }
        None
    }

    /// Notes the acknowledgement of a report.
    pub(crate) fn acknowledged(&mut self, name: &str) {
        self.event(|expected| *expected == Expected::Acknowledgement(name.to_owned()));
    }

    fn event(&mut self, is_it: impl Fn(&Expected) -> bool) {
        let next = self.scenario.expect.get(self.caused);
        if next.is_some_and(is_it) {
            self.caused += 1;
        }
    }

    pub(crate) fn verdict(&self) -> Verdict {
        match (&self.forbidden, self.scenario.expect.get(self.caused)) {
            (Some(name), _) => Verdict::Forbidden(name.clone()),
            (None, Some(missing)) => Verdict::Missing(missing.clone()),
            (None, None) => Verdict::Met,
        }
    }
}
