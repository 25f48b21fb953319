//! What was found: a change, the rule that judges it, and for whom it breaks.

use crate::rule::{About, Language, Rule, Wire};
use crate::rules::operations::{CODE_ASSIGNED, COMMAND_ADDED, REPORT_ADDED};
use fc_spec::model::{Side, Text, Waiver, fingerprint};
use serde::{Serialize, Serializer, ser::SerializeStruct as _};

/// Versions that meet: one end has the old one, the other the new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Deployment {
    /// Old apps with new robots.
    OldAppNewRobot,
    /// New apps with old robots.
    NewAppOldRobot,
}

/// Who sends the messages in which a part of a spec occurs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Senders {
    /// Apps.
    pub app: bool,
    /// Robots.
    pub robot: bool,
}

impl Senders {
    /// Both ends.
    pub const BOTH: Self = Self {
        app: true,
        robot: true,
    };

    /// One end.
    #[must_use]
    pub fn of(side: Side) -> Self {
        Self {
            app: side == Side::App,
            robot: side == Side::Robot,
        }
    }

    /// Adds others, and whether that made a difference.
    pub(crate) fn add(&mut self, other: Self) -> bool {
        let before = *self;
        self.app |= other.app;
        self.robot |= other.robot;
        before != *self
    }

    /// Where their messages break.
    pub(crate) fn broken(self, wire: Wire) -> Vec<Deployment> {
        let (old, new) = (wire.breaks_old_sender(), wire.breaks_new_sender());
        let old_app = (self.app && old) || (self.robot && new);
        let new_app = (self.app && new) || (self.robot && old);
        let each = [
            (old_app, Deployment::OldAppNewRobot),
            (new_app, Deployment::NewAppOldRobot),
        ];
        let broken = each.into_iter().filter(|(broken, _)| *broken);
        broken.map(|(_, deployment)| deployment).collect()
    }
}

/// What a place of a spec is called there: the kind that the language calls it by, and its name with that of its owner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spot {
    /// Its kind, such as `field`; empty for any.
    pub kind: &'static str,
    /// Its name, such as `Station.name`.
    pub name: String,
}

/// A change and whom it breaks.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The rule that judges it.
    pub rule: &'static Rule,
    /// What changed, such as `get_thing.request.id`.
    pub subject: String,
    /// Where versions that meet do not understand each other.
    pub wire: Vec<Deployment>,
    /// In which languages programs stop compiling.
    pub source: Vec<Language>,
    /// Whether programs behave differently although messages are read.
    pub behaviour: bool,
    /// Whether nothing fails although a value is wrong.
    pub silent: bool,
    /// What happened, in one sentence.
    pub message: Text,
    /// From what to what, as the message has it; empty where it has no such thing.
    pub(crate) values: [String; 2],
    /// Twelve hex digits: the same for the same change, whatever lines it is on.
    pub fingerprint: String,
    /// Places of the old version that show it, the best first.
    pub old: Vec<Spot>,
    /// Places of the new version.
    pub new: Vec<Spot>,
    /// The waiver that accepts it, after [`waive`](crate::waive).
    pub waived: Option<Waiver>,
}

impl Finding {
    /// A change of `subject` from one value to another, with the most that the rule can break but on the wire, which
    /// [`on`](Self::on) says.
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

    /// What a waiver calls it: `FC0725-1a2b3c4d5e6f`.
    #[must_use]
    pub fn waiver_id(&self) -> String {
        format!("{}-{}", self.rule.code(), self.fingerprint)
    }

    /// Whether what old and new peers say to each other today no longer works between them, and nobody has accepted that. An
    /// operation that old robots do not know yet is none: nobody has used it before.
    #[must_use]
    pub fn is_break(&self) -> bool {
        !self.wire.is_empty() && self.waived.is_none() && !self.is_new_operation()
    }

    /// Whether it says that an operation is new, or has its code now.
    pub(crate) fn is_new_operation(&self) -> bool {
        let new = [&COMMAND_ADDED, &REPORT_ADDED, &CODE_ASSIGNED];
        new.iter().any(|rule| rule.number == self.rule.number)
    }

    /// Whether it is about a waiver and not about a change: such a one fails whatever is asked for.
    #[must_use]
    pub fn is_fault(&self) -> bool {
        self.rule.about == About::Waiver
    }

    /// Which messages of whom break.
    pub(crate) fn on(mut self, senders: Senders, wire: Wire) -> Self {
        self.wire = senders.broken(wire);
        self
    }

    /// In which languages, where these are not all that the rule names.
    pub(crate) fn source(mut self, source: impl Into<Vec<Language>>) -> Self {
        self.source = source.into();
        self
    }

    /// Whether the behaviour changes, where the rule leaves that open.
    pub(crate) fn behaviour(mut self, behaviour: bool) -> Self {
        self.behaviour = behaviour;
        self
    }

    /// Whether nothing fails, where the rule leaves that open.
    pub(crate) fn silent(mut self, silent: bool) -> Self {
        self.silent = silent;
        self
    }

    /// A place of the old version.
    pub(crate) fn was(mut self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.old.push(Spot { kind, name });
        self
    }

    /// A place of the new version.
    pub(crate) fn is(mut self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.new.push(Spot { kind, name });
        self
    }

    /// A place of both versions.
    pub(crate) fn at(self, kind: &'static str, name: impl Into<String>) -> Self {
        let name = name.into();
        self.was(kind, name.clone()).is(kind, name)
    }
}

/// What happened to what, and from what to what where that can be said.
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

/// With the keys that other programs read; the message is English.
impl Serialize for Finding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.shown(&self.message.en, serializer)
    }
}

impl Finding {
    /// As other programs read it, with this message.
    pub(crate) fn shown<S: Serializer>(
        &self,
        message: &str,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let keys = 9 + usize::from(self.waived.is_some());
        let mut object = serializer.serialize_struct("Finding", keys)?;
        object.serialize_field("rule", self.rule)?;
        object.serialize_field("number", &self.rule.number)?;
        object.serialize_field("subject", &self.subject)?;
        object.serialize_field("wire", &self.wire)?;
        object.serialize_field("source", &self.source)?;
        object.serialize_field("behaviour", &self.behaviour)?;
        object.serialize_field("silent", &self.silent)?;
        object.serialize_field("message", message)?;
        object.serialize_field("fingerprint", &self.fingerprint)?;
        if let Some(waiver) = &self.waived {
            object.serialize_field("waived", waiver)?;
        }
        object.end()
    }
}
