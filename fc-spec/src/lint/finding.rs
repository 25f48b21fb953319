//! What a rule has found.

use super::rule::Rule;
use crate::index::DefId;
use crate::model::{Text, Waiver, fingerprint};

/// Something that a rule objects to.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule.
    pub rule: &'static Rule,
    /// Id of the house rule, where [`rule`](Self::rule) is the one that stands for all of them.
    pub house: Option<String>,
    /// What it is about.
    pub item: DefId,
    /// What is wrong, in one sentence.
    pub message: Text,
    /// What else there is to see, and why.
    pub also: Vec<(DefId, Text)>,
    /// What to do.
    pub note: Option<Text>,
    /// What tells two findings about one thing apart, whatever is written of it elsewhere.
    pub(super) about: String,
    /// The waiver that accepts it.
    pub waived: Option<Waiver>,
}

impl Finding {
    /// About a thing.
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

    /// Another thing that shows it.
    pub(super) fn with(mut self, item: DefId, text: Text) -> Self {
        self.also.push((item, text));
        self
    }

    /// What to do.
    pub(super) fn note(mut self, note: Text) -> Self {
        self.note = Some(note);
        self
    }

    /// What tells it apart from others about the same thing.
    pub(super) fn about(mut self, about: impl Into<String>) -> Self {
        self.about = about.into();
        self
    }

    /// What a waiver calls it: `FC0802-1a2b3c4d5e6f`. It depends on the rule and on what it is about, on no line and no wording.
    #[must_use]
    pub fn waiver_id(&self) -> String {
        let item = self.item.to_string();
        let house = self.house.as_deref().unwrap_or_default();
        let fingerprint = fingerprint([self.rule.code.number, house, &item, &self.about]);
        format!("{}-{fingerprint}", self.rule.code.number)
    }
}
