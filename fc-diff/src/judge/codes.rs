//! Judges command codes and ranges of codes.

use super::frame::both;
use super::operations::asked_by;
use super::{Judge, by};
use crate::finding::{Finding, Senders};
use crate::rule::Wire;
use crate::rules::operations as rules;
use crate::rules::results::ACK_TIMING;
use fc_spec::model::{CodeRange, Model, Operation, RangeUse, Side};
use std::collections::{BTreeMap, HashMap};

impl<'m> Judge<'m> {
    /// Judges the ranges of codes that a robot passes through.
    pub(super) fn ranges(&mut self) {
        let (old, new) = (methods(self.old), methods(self.new));
        let shown = |of: &BTreeMap<String, &CodeRange>| {
            let spans: Vec<String> = of.values().map(|it| span(it)).collect();
            spans.join(", ")
        };
        let values = [shown(&old), shown(&new)];
        let is_lost = old.keys().any(|name| !new.contains_key(name));
        if values[0] == values[1] && !is_lost {
            return;
        }
        let subject = format!("codes.{}", RangeUse::PassThrough.name());
        let finding = Finding::new(&rules::PASS_THROUGH, subject, both(&values));
        let mut finding = finding.source_if(is_lost);
        for range in old.values() {
            finding = finding.was("range", span(range));
        }
        for range in new.values() {
            finding = finding.is("range", span(range));
        }
        let is_in = |ranges: &[CodeRange], first: u16| ranges.iter().any(|it| it.first == first);
        for range in old.values().chain(new.values()) {
            let first = range.first.to_string();
            if is_in(&self.old.ranges, range.first) && is_in(&self.new.ranges, range.first) {
                for key in ["to", "to_spelling", "use"] {
                    self.claim(&["ranges", &first, key]);
                }
            } else {
                self.claim(&["ranges", &first]);
            }
        }
        self.report(finding);
    }

    pub(super) fn code(&mut self, old: &'m Operation, new: &'m Operation) {
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
            let source = asked_by(new, &rules::CODE_ASSIGNED);
            let finding = Finding::new(&rules::CODE_ASSIGNED, name, values).source(source);
            finding.on(asks, Wire::NewSender)
        } else {
            let is_sent = new.code.value.is_some();
            let finding = Finding::new(&rules::CODE_CHANGED, name, values).source_if(!is_sent);
            finding.on(Senders::of(old.sender), Wire::of(true, is_sent))
        };
        self.report(finding.at(new.kind().name(), name));
        self.claim(&["operations", name, "code"]);
        self.claim(&["operations", name, "code_spelling"]);
        if old.code.value.is_none() {
            self.claim(&["operations", name, "code_state"]);
        }
    }

    /// Judges codes with a new meaning, removed entries of retired codes, and acknowledgement times.
    pub(super) fn codes(&mut self) {
        let place = |it: &Operation| it.code.value.map(|code| (it.kind(), code));
        let before: HashMap<_, &Operation> = self
            .old
            .operations
            .iter()
            .filter_map(|it| Some((place(it)?, it)))
            .collect();
        let retired = by(&self.old.retired, |it| it.code);
        let names = by(&self.old.operations, |it| it.name.as_str());
        for operation in &self.new.operations {
            let Some(code) = operation.code.value else {
                continue;
            };
            let (name, spelling) = (operation.name.as_str(), operation.code.spelling.as_str());
            let holder = before.get(&(operation.kind(), code));
            let is_renamed = holder.is_some_and(|it| {
                let mut renames = self.account.renames.values();
                renames.any(|names| names.get(&it.name).is_some_and(|new| new == name))
            });
            let had = names
                .get(name)
                .is_some_and(|it| it.code.value == Some(code));
            let earlier = holder.map(|it| it.name.as_str());
            let earlier = earlier.or_else(|| retired.get(&code).map(|it| it.text.en.as_str()));
            if let Some(earlier) = earlier.filter(|_| !had && !is_renamed) {
                let finding = Finding::new(&rules::CODE_REUSED, spelling, [earlier, name]);
                let finding = finding.was("", earlier).was("retired code", spelling);
                let finding = finding.is(operation.kind().name(), name);
                self.report(finding.on(Senders::of(operation.sender), Wire::Both));
            }
        }
        let kept = by(&self.new.retired, |it| it.code);
        for tombstone in &self.old.retired {
            if !kept.contains_key(&tombstone.code) {
                let code = tombstone.code.to_string();
                let spelling = tombstone.spelling.as_str();
                let (rule, what) = (&rules::TOMBSTONE_REMOVED, &tombstone.text.en);
                let place = ("retired code", spelling);
                self.report(Finding::alone(rule, true, spelling, what, place));
                self.claim(&["retired_codes", &code]);
            }
        }
        let (old, new) = (self.old.calls.ack, self.new.calls.ack);
        if old != new {
            let of = |it: &fc_spec::model::Ack| format!("{} ms × {}", it.timeout_ms, it.retries);
            let finding = Finding::new(&ACK_TIMING, "ack", both(&[of(&old), of(&new)]));
            self.report(finding.at("ack", "ack"));
            self.claim(&["protocol", "calls", "ack"]);
        }
    }
}

/// Returns the pass-through ranges by the names of their methods.
fn methods(model: &Model) -> BTreeMap<String, &CodeRange> {
    let ranges = model.ranges.iter();
    let mut named = BTreeMap::new();
    for range in ranges.filter(|range| range.usage == RangeUse::PassThrough) {
        let mut name = RangeUse::PassThrough.name().to_owned();
        if named.contains_key(&name) || model.operation(&name).is_some() {
            name = format!("{name}_{:04x}", range.first);
        }
        named.insert(name, range);
    }
    named
}

/// Formats a range.
fn span(range: &CodeRange) -> String {
    format!("{}–{}", range.first_spelling, range.last_spelling)
}
