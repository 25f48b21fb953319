//! Findings: a change, the rule that judges it, and the deployments that it breaks.

use crate::rule::{About, Language, Rule, Wire};
use crate::rules::operations::{CODE_ASSIGNED, COMMAND_ADDED, REPORT_ADDED};
use fc_spec::index::{DefSite, Definitions};
use fc_spec::model::{Lang, Operation, Side, Text, Waiver, fingerprint};
use serde::Serialize;

/// A combination of versions in the field: one end has the old version, the other the new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Deployment {
    /// Old apps with new robots.
    OldAppNewRobot,
    /// New apps with old robots.
    NewAppOldRobot,
}

impl Deployment {
    /// Returns the apps and the robots in words.
    pub(crate) fn words(self, lang: Lang) -> &'static str {
        match self {
            Self::OldAppNewRobot => lang.pick("旧 app 配新机器人", "old apps with new robots"),
            Self::NewAppOldRobot => lang.pick("新 app 配旧机器人", "new apps with old robots"),
        }
    }
}

/// The senders of the messages that contain a part of a spec.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Senders {
    /// `true` if apps send it.
    pub app: bool,
    /// `true` if robots send it.
    pub robot: bool,
}

impl Senders {
    /// Apps and robots.
    pub const BOTH: Self = Self {
        app: true,
        robot: true,
    };

    /// Returns one end as the sender.
    #[must_use]
    pub fn of(side: Side) -> Self {
        Self {
            app: side == Side::App,
            robot: side == Side::Robot,
        }
    }

    /// Adds other senders. Returns `true` if the value changed.
    pub(crate) fn add(&mut self, other: Self) -> bool {
        let before = *self;
        self.app |= other.app;
        self.robot |= other.robot;
        before != *self
    }

    /// Returns the deployments that a change breaks for messages of these senders.
    pub(crate) fn broken(self, wire: Wire) -> Vec<Deployment> {
        let (old, new) = (wire.breaks_old_sender(), wire.breaks_new_sender());
        let old_app = (self.app && old) || (self.robot && new);
        let new_app = (self.app && new) || (self.robot && old);
        let old_app = old_app.then_some(Deployment::OldAppNewRobot);
        let new_app = new_app.then_some(Deployment::NewAppOldRobot);
        old_app.into_iter().chain(new_app).collect()
    }
}

/// The name of a place in a spec.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spot {
    /// The kind, such as `field`; empty for any kind.
    pub kind: &'static str,
    /// The name with its owner, such as `Station.name`.
    pub name: String,
}

impl Spot {
    /// Returns the place in the files of a version.
    #[must_use]
    pub fn place<'d>(&self, places: &'d Definitions) -> Option<&'d DefSite> {
        let mut named = places.named(&self.name);
        let found = named.find(|(item, _)| self.kind.is_empty() || item.kind == self.kind);
        found.map(|(_, place)| place)
    }
}

/// A change and its effects.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule that judges the change.
    pub rule: &'static Rule,
    /// The part of the spec that changed, such as `get_thing.request.id`.
    pub subject: String,
    /// The deployments whose messages break.
    pub wire: Vec<Deployment>,
    /// The languages whose programs stop compiling.
    pub source: Vec<Language>,
    /// `true` if programs behave differently although they read all messages.
    pub behaviour: bool,
    /// `true` if a value is wrong without an error.
    pub silent: bool,
    /// One sentence about the change.
    pub message: Text,
    /// The old and the new value in the message; empty if the change has none.
    pub(crate) values: [String; 2],
    /// Twelve hex digits. They identify the change and do not depend on line numbers.
    pub fingerprint: String,
    /// Places of the old version that show the change, the best first.
    pub old: Vec<Spot>,
    /// Places of the new version that show the change, the best first.
    pub new: Vec<Spot>,
    /// The waiver that accepts the change. [`waive`](crate::waive) sets it.
    pub waived: Option<Waiver>,
}

impl Finding {
    /// Returns a finding that `subject` changed from one value to another. Its effects are those of the rule, without
    /// effects on messages. [`on`](Self::on) sets these.
    pub(crate) fn new(
        rule: &'static Rule,
        subject: impl Into<String>,
        [from, to]: [&str; 2],
    ) -> Self {
        let subject = subject.into();
        Self {
            rule,
            wire: Vec::new(),
            source: rule.source.to_vec(),
            behaviour: rule.behaviour,
            silent: rule.silent,
            message: Text {
                zh: message(rule.title[1], &subject, from, to, ["：", "（", "）"]),
                en: message(rule.title[0], &subject, from, to, [": ", " (", ")"]),
            },
            fingerprint: fingerprint([rule.code().as_str(), &subject, from, to]),
            subject,
            values: [from.to_owned(), to.to_owned()],
            old: Vec::new(),
            new: Vec::new(),
            waived: None,
        }
    }

    /// Returns a finding about a thing that only one version has: the old one if it was `removed`. The message shows
    /// `value`.
    pub(crate) fn alone(
        rule: &'static Rule,
        removed: bool,
        subject: impl Into<String>,
        value: &str,
        (kind, name): (&'static str, impl Into<String>),
    ) -> Self {
        if removed {
            Self::new(rule, subject, [value, ""]).was(kind, name)
        } else {
            Self::new(rule, subject, ["", value]).is(kind, name)
        }
    }

    /// Returns the id for a waiver, such as `FC0725-1a2b3c4d5e6f`.
    #[must_use]
    pub fn waiver_id(&self) -> String {
        format!("{}-{}", self.rule.code(), self.fingerprint)
    }

    /// Returns `true` if messages that work today no longer work between old and new peers, and no waiver accepts this.
    /// A new operation is not a break, because no program uses it yet.
    #[must_use]
    pub fn is_break(&self) -> bool {
        !self.wire.is_empty() && self.waived.is_none() && !self.is_new_operation()
    }

    /// Returns `true` if an operation is new, or has a code for the first time.
    pub(crate) fn is_new_operation(&self) -> bool {
        let new = [&COMMAND_ADDED, &REPORT_ADDED, &CODE_ASSIGNED];
        new.iter().any(|rule| rule.number == self.rule.number)
    }

    /// Returns `true` if the finding is about a waiver and not about a change. Such a finding always fails the
    /// comparison.
    #[must_use]
    pub fn is_fault(&self) -> bool {
        self.rule.about == About::Waiver
    }

    /// Sets the deployments that break.
    pub(crate) fn on(mut self, senders: Senders, wire: Wire) -> Self {
        self.wire = senders.broken(wire);
        self
    }

    /// Sets the languages, if they differ from those of the rule.
    pub(crate) fn source(mut self, source: impl Into<Vec<Language>>) -> Self {
        self.source = source.into();
        self
    }

    /// Keeps the languages of the rule only if sources break.
    pub(crate) fn source_if(mut self, breaks: bool) -> Self {
        self.source.retain(|_| breaks);
        self
    }

    /// Sets `behaviour`, if it differs from that of the rule.
    pub(crate) fn behaviour(mut self, behaviour: bool) -> Self {
        self.behaviour = behaviour;
        self
    }

    /// Sets `silent`, if it differs from that of the rule.
    pub(crate) fn silent(mut self, silent: bool) -> Self {
        self.silent = silent;
        self
    }

    /// Adds a place of the old version.
    pub(crate) fn was(mut self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.old.push(Spot { kind, name });
        self
    }

    /// Adds a place of the new version.
    pub(crate) fn is(mut self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.new.push(Spot { kind, name });
        self
    }

    /// Adds a place of both versions.
    pub(crate) fn at(self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.was(kind, name.clone()).is(kind, name)
    }

    /// Adds the two versions of an operation.
    pub(crate) fn between(self, old: &Operation, new: &Operation) -> Self {
        self.was(old.kind().name(), &old.name)
            .is(new.kind().name(), &new.name)
    }
}

/// Returns the message of a finding, with its values if there are any.
fn message(title: &str, subject: &str, from: &str, to: &str, signs: [&str; 3]) -> String {
    let [colon, open, close] = signs;
    let values = match (from, to) {
        ("", "") => return format!("{subject}{colon}{title}"),
        (value, "") | ("", value) => value.to_owned(),
        (from, to) if from == to => to.to_owned(),
        (from, to) => format!("{from} → {to}"),
    };
    format!("{subject}{colon}{title}{open}{values}{close}")
}
