//! A finding of a rule.

use super::rule::Rule;
use crate::index::DefId;
use crate::model::{Text, Waiver, fingerprint};

/// A violation of a rule.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule that found it.
    pub rule: &'static Rule,
    /// The id of the rule of the project, if [`rule`](Self::rule) is the shared [`Rule`] for all of them.
    pub house: Option<String>,
    /// The thing that violates the rule.
    pub item: DefId,
    /// The message, in one sentence.
    pub message: Text,
    /// Other things that show the violation, each with a message.
    pub also: Vec<(DefId, Text)>,
    /// The advice.
    pub note: Option<Text>,
    /// A key that distinguishes two findings about one thing. It must not depend on other parts of the spec.
    pub(super) about: String,
    /// The waiver that accepts this finding.
    pub waived: Option<Waiver>,
}

impl Finding {
    /// Returns a finding about a thing.
    pub(super) fn new(rule: &'static Rule, item: impl Into<DefId>, message: Text) -> Self {
        Self {
            rule,
            house: None,
            item: item.into(),
            message,
            also: Vec::new(),
            note: None,
            about: String::new(),
            waived: None,
        }
    }

    /// Adds another thing that shows the violation.
    pub(super) fn with(mut self, item: impl Into<DefId>, text: Text) -> Self {
        self.also.push((item.into(), text));
        self
    }

    /// The advice.
    pub(super) fn note(mut self, note: Text) -> Self {
        self.note = Some(note);
        self
    }

    /// Sets the key that distinguishes two findings about one thing.
    pub(super) fn about(mut self, about: impl Into<String>) -> Self {
        self.about = about.into();
        self
    }

    /// Returns the id for a waiver: `FC0802-1a2b3c4d5e6f`.
    ///
    /// The id depends on the rule and the thing, not on a line or a wording.
    #[must_use]
    pub fn waiver_id(&self) -> String {
        let item = self.item.to_string();
        let house = self.house.as_deref().unwrap_or_default();
        let fingerprint = fingerprint([self.rule.code.number, house, &item, &self.about]);
        format!("{}-{fingerprint}", self.rule.code.number)
    }
}
