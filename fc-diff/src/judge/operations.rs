//! Judges operations.

use super::frame::both;
use super::{Judge, ORDER, called};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair, TypePair};
use crate::rule::{Language, Rule, Wire};
use crate::rules::fields::{NAME_CHANGED, TYPE_CHANGED};
use crate::rules::operations as rules;
use crate::rules::process::DOCS;
use crate::rules::results::{ACK_TIMING, ERROR_ADDED, ERROR_REMOVED};
use fc_spec::model::{Content, Direction, Exchange, Fact, Kind, Model, Operation, Side};
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
        self.ranges();
    }

    /// Judges the id of the protocol, from which packages take names.
    pub(super) fn protocol(&mut self) {
        let (old, new) = (&self.old.protocol.id, &self.new.protocol.id);
        if old != new {
            let finding = Finding::new(&NAME_CHANGED, "protocol.id", [old, new]);
            self.report(finding.at("protocol", "protocol"));
            self.claim(&["protocol", "id"]);
        }
    }

    /// Judges an operation that only one version has.
    fn gone(&mut self, operation: &'m Operation, name: &str, removed: bool) {
        let is_asked = operation.sender == Side::App;
        let rule = match (is_asked, removed) {
            (true, true) => &rules::COMMAND_REMOVED,
            (true, false) => &rules::COMMAND_ADDED,
            (false, true) => &rules::REPORT_REMOVED,
            (false, false) => &rules::REPORT_ADDED,
        };
        let spelling = operation.code.spelling.as_str();
        let named = (operation.kind().name(), name);
        let mut finding = Finding::alone(rule, removed, name, spelling, named);
        if !removed {
            finding = finding.source(asked_by(operation, rule));
        }
        // An operation without a code has never been sent.
        if is_asked && operation.code.value.is_some() {
            let senders = Senders::of(operation.sender);
            finding = finding.on(senders, Wire::of(removed, !removed));
        }
        self.report(finding);
        self.claim(&["operations", name]);
        let model = if removed { self.old } else { self.new };
        let types = model.types.iter();
        let own = types.filter(|it| it.body_of.as_ref().is_some_and(|it| it.operation == *name));
        for ty in own {
            self.claim(&["types", &ty.name]);
        }
    }

    fn operation(&mut self, old: &'m Operation, new: &'m Operation) {
        let name = new.name.as_str();
        let at = |finding: Finding| finding.between(old, new);
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
        // If the whole kind moved to another port, one finding reports it.
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
        self.errors(old, new);
        self.accepted(old, new);
        self.sets_off(old, new);
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

    /// Judges the declared errors, paired as their results are.
    fn errors(&mut self, old: &Operation, new: &Operation) {
        let results = matching::results(self.old, self.new);
        let results = results.iter().filter_map(Pair::both);
        let results: HashMap<i64, i64> =
            results.map(|(one, other)| (one.code, other.code)).collect();
        let name = new.name.as_str();
        let list = ["operations", name, "errors"];
        let has_type = old.kind() == Kind::Command && !old.errors.is_empty();
        let mut kept = Vec::new();
        for error in &old.errors {
            let now = results.get(&error.code);
            let now = now.and_then(|code| new.error(*code));
            let code = error.code.to_string();
            if now.is_none_or(|now| now.code != error.code) {
                self.claim_in(&list, &[ORDER]);
            }
            if let Some(now) = now {
                kept.push(now.code);
                if now.code != error.code {
                    // A finding about the result reports the code.
                    self.renamed(&list, &code, &now.code.to_string());
                    self.claim_in(&list, &[&now.code.to_string(), "code"]);
                }
            } else {
                let finding = Finding::new(&ERROR_REMOVED, name, [&code, ""]);
                self.report(finding.source_if(has_type).between(old, new));
                self.claim_in(&list, &[&code]);
            }
        }
        for error in new.errors.iter().filter(|it| !kept.contains(&it.code)) {
            let code = error.code.to_string();
            let finding = Finding::new(&ERROR_ADDED, name, ["", &code]);
            self.report(finding.source_if(has_type).between(old, new));
            self.claim_item(&list, &code);
        }
    }

    /// Judges the reports that a command sets off.
    fn sets_off(&mut self, old: &'m Operation, new: &'m Operation) {
        let name = |report: &'m str| self.new_names.get(report).copied().unwrap_or(report);
        let before: Vec<&str> = old.sets_off().iter().map(|it| name(&it.report)).collect();
        let after: Vec<&str> = new.sets_off().iter().map(|it| &*it.report).collect();
        // Programs can follow a report if it and the command have codes.
        let can_follow = |model: &Model, command: &Operation, report: &str| {
            let report = model.operation(report);
            let report_code = report.and_then(|it| it.code.value);
            command.code.value.is_some() && report_code.is_some()
        };
        let followed = old.sets_off().iter();
        let followed = followed.filter(|it| can_follow(self.old, old, &it.report));
        let followed: Vec<&str> = followed.map(|it| name(&it.report)).collect();
        let follow = after.iter().copied();
        let follow: Vec<&str> = follow.filter(|it| can_follow(self.new, new, it)).collect();
        let is_first_other = followed.first() != follow.first();
        let mut findings = Vec::new();
        for report in before.iter().filter(|it| !after.contains(it)) {
            let finding = Finding::new(&rules::SET_OFF_REMOVED, &new.name, [report, ""]);
            let mut finding = finding.source_if(followed.contains(report));
            // In TypeScript, the type of a call names the first report only.
            let is_told = |it: &Language| *it != Language::Typescript || is_first_other;
            finding.source.retain(is_told);
            findings.push(finding);
        }
        for report in after.iter().filter(|it| !before.contains(it)) {
            let source: &[Language] = match followed.as_slice() {
                _ if !follow.contains(report) => &[],
                // The method returns a call that can be followed.
                [] => &[Language::Python, Language::Typescript],
                // The names of the methods get the name of the report.
                [_] => &[Language::Kotlin, Language::JvmBinary, Language::Python],
                _ => &[],
            };
            let is_first = !followed.is_empty() && is_first_other;
            let mut source = source.to_vec();
            source.extend(is_first.then_some(Language::Typescript));
            let finding = Finding::new(&rules::SET_OFF_ADDED, &new.name, ["", report]);
            findings.push(finding.source(source));
        }
        if findings.is_empty() {
            return;
        }
        for finding in findings {
            self.report(finding.between(old, new));
        }
        self.claim(&["operations", &new.name, "sets_off"]);
    }

    /// Judges whether the facts of an operation are stated, inferred or open.
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
        // The types of messages take their names from the operation. The rules for types judge their contents.
        for direction in Direction::ALL {
            self.claim(&["operations", name, direction.name(), "type"]);
        }
    }

    /// Judges renamed types, and claims the types without a counterpart.
    pub(super) fn renamed_types(&mut self) {
        use crate::rules::fields::TYPE_RENAMED;
        for TypePair { old, new, .. } in self.types.both.clone() {
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
        // The rules judge the places that use a new or removed type.
        let alone = [&mut self.types.added, &mut self.types.removed].map(std::mem::take);
        for ty in alone.into_iter().flatten() {
            self.claim(&["types", &ty.name]);
        }
    }
}

/// Returns the languages in which a new operation breaks sources. A robot implements every command. A match covers all
/// reports in Rust, C++ and TypeScript, and all streams in Rust.
pub(super) fn asked_by(operation: &Operation, rule: &Rule) -> Vec<Language> {
    if operation.code.value.is_none() {
        return Vec::new();
    }
    let matched = match operation.kind() {
        Kind::Command => return rule.source.to_vec(),
        Kind::Report => [Language::Rust, Language::Cpp, Language::Typescript].as_slice(),
        Kind::Stream => &[Language::Rust],
    };
    let source = rule.source.iter().copied();
    source.filter(|it| matched.contains(it)).collect()
}
