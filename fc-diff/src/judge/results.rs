//! Judges results, call times and tables.

use super::frame::both;
use super::{Judge, ORDER};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair};
use crate::rule::Wire;
use crate::rules::fields::NAME_CHANGED;
use crate::rules::results as rules;
use fc_spec::model::{CallDefaults, ResultCode, Side, Table};

impl Judge<'_> {
    pub(super) fn results(&mut self) {
        for pair in matching::results(self.old, self.new) {
            let (result, removed, rule) = match pair {
                Pair::Both(old, new) => {
                    self.result(old, new);
                    continue;
                }
                Pair::Removed(old) => (old, true, &rules::RESULT_REMOVED),
                Pair::Added(new) => (new, false, &rules::RESULT_ADDED),
            };
            let code = result.code.to_string();
            let subject = format!("results.{}", result.name);
            self.report(Finding::alone(
                rule,
                removed,
                subject,
                &code,
                ("result", &code),
            ));
            self.claim_item(&["result_codes"], &code);
        }
        self.times();
    }

    fn result(&mut self, old: &ResultCode, new: &ResultCode) {
        let at = |finding: Finding| {
            let finding = finding.was("result", old.code.to_string());
            finding.is("result", new.code.to_string())
        };
        let subject = format!("results.{}", new.name);
        if old.name != new.name {
            let finding = Finding::new(&NAME_CHANGED, &subject, [&old.name, &new.name]);
            self.report(at(finding));
            self.claim(&["result_codes", &new.code.to_string(), "name"]);
        }
        if old.code != new.code || old.role != new.role {
            let shown = |it: &ResultCode| match it.role {
                Some(role) => format!("{} ({})", it.code, role.name()),
                None => it.code.to_string(),
            };
            let values = [shown(old), shown(new)];
            let finding = Finding::new(&rules::RESULT_CODE, subject, both(&values));
            // Robots send results, and apps send them in acknowledgements of reports.
            self.report(at(finding).on(Senders::BOTH, Wire::Both));
            for code in [old.code, new.code] {
                self.claim(&["result_codes", &code.to_string()]);
            }
            self.claim(&["result_codes", ORDER]);
        }
    }

    /// Judges the tables of constants.
    pub(super) fn tables(&mut self) {
        for pair in matching::align(
            &self.old.tables,
            &self.new.tables,
            &[&|one: &Table, other: &Table| one.id == other.id],
        ) {
            let (table, removed, rule) = match pair {
                Pair::Both(_, new) => {
                    // The row type is judged with the types.
                    self.claim(&["tables", &new.id, "row"]);
                    continue;
                }
                Pair::Removed(old) => (old, true, &rules::TABLE_REMOVED),
                Pair::Added(new) => (new, false, &rules::TABLE_ADDED),
            };
            let subject = format!("tables.{}", table.id);
            self.report(Finding::alone(
                rule,
                removed,
                subject,
                "",
                ("table", &table.id),
            ));
            self.claim_item(&["tables"], &table.id);
        }
    }

    fn times(&mut self) {
        let (old, new) = (self.old.calls, self.new.calls);
        let is_longer = |it: CallDefaults| it.handler_timeout_ms >= it.timeout_ms;
        if is_longer(new) && !is_longer(old) {
            let shown =
                |it: CallDefaults| format!("{} / {} ms", it.handler_timeout_ms, it.timeout_ms);
            let values = [shown(old), shown(new)];
            let finding = Finding::new(&rules::TIMES, "calls.handler_timeout_ms", both(&values));
            self.report(finding.at("calls", "calls"));
            self.claim(&["protocol", "calls", "handler_timeout_ms"]);
            self.claim(&["protocol", "calls", "timeout_ms"]);
        }
        let age = |age: Option<u32>| age.map(|age| format!("{age} ms")).unwrap_or_default();
        if let Some(now) = new.max_age_ms
            && old.max_age_ms.is_none_or(|before| now < before)
        {
            let values = [age(old.max_age_ms), age(new.max_age_ms)];
            let finding = Finding::new(&rules::TIMES, "calls.max_age_ms", both(&values));
            let finding = finding.on(Senders::of(Side::App), Wire::OldSender);
            self.report(finding.at("calls", "calls"));
            self.claim(&["protocol", "calls", "max_age_ms"]);
        }
    }
}
