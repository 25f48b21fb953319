//! Results, and the times that calls take.

use super::frame::both;
use super::{Judge, by};
use crate::finding::{Finding, Senders};
use crate::rule::Wire;
use crate::rules::results as rules;

impl Judge<'_> {
    pub(super) fn results(&mut self) {
        let now = by(&self.new.results, |it| it.name.as_str());
        for old in &self.old.results {
            let Some(new) = now.get(old.name.as_str()) else {
                continue;
            };
            if old.code == new.code && old.role == new.role {
                continue;
            }
            let shown = |it: &fc_spec::model::ResultCode| match it.role {
                Some(role) => format!("{} ({})", it.code, role.name()),
                None => it.code.to_string(),
            };
            let values = [shown(old), shown(new)];
            let finding = Finding::new(
                &rules::RESULT_CODE,
                format!("results.{}", old.name),
                both(&values),
            );
            let finding = finding
                .was("result", old.code.to_string())
                .is("result", new.code.to_string());
            // The robot says it, and so does the app of reports.
            self.report(finding.on(Senders::BOTH, Wire::Both));
            for code in [old.code, new.code] {
                self.claim(&["result_codes", &code.to_string()]);
            }
            self.claim(&["result_codes", "#order"]);
        }
        let (old, new) = (self.old.calls, self.new.calls);
        let is_longer = |it: fc_spec::model::CallDefaults| it.handler_timeout_ms >= it.timeout_ms;
        if is_longer(new) && !is_longer(old) {
            let shown = |it: fc_spec::model::CallDefaults| {
                format!("{} / {} ms", it.handler_timeout_ms, it.timeout_ms)
            };
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
            let senders = Senders {
                app: true,
                robot: false,
            };
            self.report(finding.at("calls", "calls").on(senders, Wire::OldSender));
            self.claim(&["protocol", "calls", "max_age_ms"]);
        }
    }
}
