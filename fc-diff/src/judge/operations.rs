//! Operations.

use super::frame::both;
use super::{Judge, by, called};
use crate::finding::{Finding, Senders};
use crate::matching::Pair;
use crate::rule::Wire;
use crate::rules::fields::TYPE_CHANGED;
use crate::rules::operations as rules;
use crate::rules::process::DOCS;
use crate::rules::results::{ACK_TIMING, ERROR_ADDED};
use fc_spec::model::{Content, Direction, Exchange, Fact, Operation, Side};
use std::collections::HashMap;

impl<'m> Judge<'m> {
    pub(super) fn operations(&mut self) {
        for pair in std::mem::take(&mut self.operations) {
            match pair {
                Pair::Both(old, new) => self.operation(old, new),
                Pair::Removed(old) => self.gone(old, &old.name, true),
                Pair::Added(new) => self.gone(new, &new.name, false),
            }
        }
        self.codes();
    }

    /// What is in one version only.
    fn gone(&mut self, operation: &'m Operation, name: &str, removed: bool) {
        let is_asked = operation.sender == Side::App;
        let rule = match (is_asked, removed) {
            (true, true) => &rules::COMMAND_REMOVED,
            (true, false) => &rules::COMMAND_ADDED,
            (false, true) => &rules::REPORT_REMOVED,
            (false, false) => &rules::REPORT_ADDED,
        };
        let spelling = operation.code.spelling.as_str();
        let values = if removed {
            [spelling, ""]
        } else {
            ["", spelling]
        };
        let mut finding = Finding::new(rule, name, values);
        // Without a code nobody can have sent it.
        if is_asked && operation.code.value.is_some() {
            let senders = Senders::of(operation.sender);
            finding = finding.on(senders, Wire::of(removed, !removed));
        }
        let kind = operation.kind().name();
        finding = if removed {
            finding.was(kind, name)
        } else {
            finding.is(kind, name)
        };
        self.report(finding);
        self.claim(&["operations", name]);
        let types = if removed {
            &self.old.types
        } else {
            &self.new.types
        };
        let own = types
            .iter()
            .filter(|it| it.body_of.as_ref().is_some_and(|it| it.operation == *name));
        for ty in own {
            self.claim(&["types", &ty.name]);
        }
    }

    fn operation(&mut self, old: &'m Operation, new: &'m Operation) {
        let (kind, name) = (new.kind().name(), new.name.as_str());
        let at = |finding: Finding| finding.was(old.kind().name(), &old.name).is(kind, name);
        if old.name != new.name {
            let finding = Finding::new(&rules::OPERATION_RENAMED, &old.name, [&old.name, name]);
            self.report(at(finding));
            self.renamed(&["operations"], &old.name, name);
            self.claim(&["operations", name, "name"]);
        }
        if old.group != new.group {
            let finding = Finding::new(&rules::GROUP_MOVED, name, [&old.group, &new.group]);
            self.report(at(finding));
            self.claim(&["operations", name, "group"]);
        }
        self.code(old, new);
        self.sunset(old, new);
        let senders = Senders::of(old.sender);
        if old.kind() != new.kind() || old.sender != new.sender {
            let of = |it: &Operation| format!("{} / {}", it.kind().name(), it.sender.name());
            let finding = Finding::new(&rules::KIND_CHANGED, name, both(&[of(old), of(new)]));
            self.report(at(finding).on(Senders::BOTH, Wire::Both));
            for key in [
                "kind",
                "sender",
                "effect",
                "effect_state",
                "request",
                "response",
                "ack",
                "port_role",
            ] {
                self.claim(&["operations", name, key]);
            }
            return self.facts(old, new);
        }
        // Where the whole kind moved, that is said once.
        let kinds = (&self.old.frame.kinds, &self.new.frame.kinds);
        let moved = kinds.0.of(old.kind()).port != kinds.1.of(new.kind()).port;
        if old.port != new.port {
            if !moved {
                let values = [old.port.name(), new.port.name()];
                let finding = Finding::new(&crate::rules::frame::OPERATION_PORT, name, values);
                self.report(at(finding).on(Senders::BOTH, Wire::Both));
            }
            self.claim(&["operations", name, "port_role"]);
        }
        if let (Some(one), Some(other)) = (old.effect(), new.effect())
            && other != one
        {
            let rule = if other > one {
                &rules::EFFECT_RAISED
            } else {
                &rules::EFFECT_LOWERED
            };
            let finding = Finding::new(rule, name, [one.name(), other.name()]);
            self.report(at(finding));
            self.claim(&["operations", name, "effect"]);
        }
        if let (Exchange::Report { ack: one, .. }, Exchange::Report { ack: other, .. }) =
            (&old.exchange, &new.exchange)
            && one != other
        {
            let is_default = *one == self.old.calls.ack && *other == self.new.calls.ack;
            if !is_default {
                let of =
                    |it: &fc_spec::model::Ack| format!("{} ms × {}", it.timeout_ms, it.retries);
                let finding = Finding::new(&ACK_TIMING, name, both(&[of(one), of(other)]));
                self.report(at(finding));
            }
            self.claim(&["operations", name, "ack"]);
        }
        let known = by(&old.errors, |it| it.code);
        for error in &new.errors {
            if !known.contains_key(&error.code) {
                let code = error.code.to_string();
                let finding = Finding::new(&ERROR_ADDED, name, ["", &code]);
                self.report(at(finding));
                self.claim(&["operations", name, "errors", &code]);
                self.claim(&["operations", name, "errors", "#order"]);
            }
        }
        if let (Some(one), Some(other)) = (old.stream(), new.stream()) {
            let is_json = |content: &Content| content.json().is_some();
            if is_json(&one.content) != is_json(&other.content) {
                let of = |content: &Content| content.media_type().unwrap_or_default().to_owned();
                let values = [of(&one.content), of(&other.content)];
                let wire = Wire::of(is_json(&other.content), is_json(&one.content));
                let finding = Finding::new(
                    &TYPE_CHANGED,
                    format!("{name}.{}", Direction::Request.name()),
                    both(&values),
                );
                self.report(at(finding).on(senders, wire));
                self.claim(&["operations", name, "content"]);
                self.claim(&["operations", name, Direction::Request.name()]);
            }
        }
        self.facts(old, new);
    }

    fn code(&mut self, old: &'m Operation, new: &'m Operation) {
        let name = new.name.as_str();
        if old.code.value == new.code.value {
            return;
        }
        let values = [old.code.spelling.as_str(), new.code.spelling.as_str()];
        let finding = if old.code.value.is_none() {
            // A robot without the code answers that it does not know it.
            let asks = Senders {
                app: old.sender == Side::App,
                robot: false,
            };
            Finding::new(&rules::CODE_ASSIGNED, name, values).on(asks, Wire::NewSender)
        } else {
            let wire = Wire::of(true, new.code.value.is_some());
            Finding::new(&rules::CODE_CHANGED, name, values).on(Senders::of(old.sender), wire)
        };
        self.report(finding.at(new.kind().name(), name));
        self.claim(&["operations", name, "code"]);
        self.claim(&["operations", name, "code_spelling"]);
        if old.code.value.is_none() {
            self.claim(&["operations", name, "code_state"]);
        }
    }

    /// Whether the facts of an operation are stated, inferred or open.
    fn facts(&mut self, old: &Operation, new: &Operation) {
        let name = new.name.as_str();
        for fact in Fact::ALL {
            let (Some(one), Some(other)) = (old.fact_state(*fact), new.fact_state(*fact)) else {
                continue;
            };
            if other > one {
                let subject = format!("{name}.{}", fact.name());
                let finding = Finding::new(&DOCS, subject, [one.name(), other.name()]);
                self.report(finding.at(new.kind().name(), name));
                match fact {
                    Fact::Title => self.claim(&["operations", name, "title_state"]),
                    Fact::Type => self.claim(&["operations", name, "kind_state"]),
                    Fact::Code => self.claim(&["operations", name, "code_state"]),
                    Fact::Effect => self.claim(&["operations", name, "effect_state"]),
                    Fact::Request | Fact::Response => {
                        self.claim(&["operations", name, fact.name(), "state"]);
                    }
                }
            }
        }
        // The names of the types of its messages follow from its own; what they hold is judged with the types.
        for direction in Direction::ALL {
            self.claim(&["operations", name, direction.name(), "type"]);
        }
    }

    /// Codes that mean something else now.
    fn codes(&mut self) {
        let place = |it: &Operation| it.code.value.map(|code| (it.kind(), code));
        let before: HashMap<_, &Operation> = self
            .old
            .operations
            .iter()
            .filter_map(|it| Some((place(it)?, it)))
            .collect();
        let retired = by(&self.old.retired, |it| it.code);
        let names = by(&self.old.operations, |it| it.name.as_str());
        let mut findings = Vec::new();
        for operation in &self.new.operations {
            let Some(code) = operation.code.value else {
                continue;
            };
            let had = names
                .get(operation.name.as_str())
                .is_some_and(|it| it.code.value == Some(code));
            let name = operation.name.as_str();
            let spelling = operation.code.spelling.as_str();
            let is_new = !had
                && !before.get(&(operation.kind(), code)).is_some_and(|it| {
                    self.account
                        .renames
                        .values()
                        .any(|names| names.get(&it.name).is_some_and(|new| new == name))
                });
            let earlier = before
                .get(&(operation.kind(), code))
                .map(|it| it.name.as_str());
            let earlier = earlier.or_else(|| retired.get(&code).map(|it| it.text.en.as_str()));
            if let (true, Some(earlier)) = (is_new, earlier) {
                let finding = Finding::new(&rules::CODE_REUSED, spelling, [earlier, name]);
                let finding = finding.was("", earlier).was("retired code", spelling);
                findings.push(
                    finding
                        .is(operation.kind().name(), name)
                        .on(Senders::of(operation.sender), Wire::Both),
                );
            }
        }
        let kept = by(&self.new.retired, |it| it.code);
        for tombstone in &self.old.retired {
            if !kept.contains_key(&tombstone.code) {
                let code = tombstone.code.to_string();
                let spelling = tombstone.spelling.as_str();
                let finding = Finding::new(
                    &rules::TOMBSTONE_REMOVED,
                    spelling,
                    [&tombstone.text.en, ""],
                );
                findings.push(finding.was("retired code", spelling));
                self.claim(&["retired_codes", &code]);
            }
        }
        for finding in findings {
            self.report(finding);
        }
        let (old, new) = (self.old.calls.ack, self.new.calls.ack);
        if old != new {
            let of = |it: &fc_spec::model::Ack| format!("{} ms × {}", it.timeout_ms, it.retries);
            let finding = Finding::new(&ACK_TIMING, "ack", both(&[of(&old), of(&new)]));
            self.report(finding.at("ack", "ack"));
            self.claim(&["protocol", "calls", "ack"]);
        }
    }

    /// A type with another name, or without a counterpart.
    pub(super) fn renamed_types(&mut self) {
        use crate::rules::fields::TYPE_RENAMED;
        let pairs: Vec<_> = self
            .types
            .both
            .iter()
            .map(|pair| (pair.old, pair.new))
            .collect();
        for (old, new) in pairs {
            if old.name == new.name {
                continue;
            }
            let stays = self.new.types.named(&old.name).is_some();
            let is_first = self.old.types.named(&new.name).is_none();
            let own =
                |ty: &fc_spec::model::TypeDef| ty.body_of.as_ref().map(|it| it.operation.clone());
            let follows = matches!((own(old), own(new)), (Some(one), Some(other)) if one != other);
            if !follows {
                let finding = Finding::new(&TYPE_RENAMED, called(old), [&old.name, &new.name]);
                self.report(finding.was("", &old.name).is("", &new.name));
            }
            if stays || !is_first {
                self.claim(&["types", &new.name]);
            } else {
                self.renamed(&["types"], &old.name, &new.name);
            }
            for key in ["name", "group", "body_of"] {
                self.claim(&["types", &new.name, key]);
            }
        }
        // What uses one that is new or gone is judged.
        let alone = [&mut self.types.added, &mut self.types.removed].map(std::mem::take);
        for ty in alone.into_iter().flatten() {
            self.claim(&["types", &ty.name]);
        }
    }
}
