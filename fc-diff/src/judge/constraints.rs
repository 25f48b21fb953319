//! Judges the constraints of fields.

use super::fields::Fields;
use super::{Judge, accept, json, sources};
use crate::rule::Wire;
use crate::rules::constraints as rules;
use fc_spec::model::{Constraints, Pattern, Scalar};

impl Judge<'_> {
    pub(super) fn constraints(&mut self, it: &Fields<'_>) {
        let [old, new] = [it.old, it.new].map(|it| &it.details().constraints);
        let is_same_type = it.old.ty == it.new.ty;
        let limits = |it: &Constraints| (it.min.clone(), it.max.clone());
        if limits(old) != limits(new) || old.only != new.only {
            // If the type also changed, the finding about the type covers the limits.
            if is_same_type {
                let (one, other) = (limits(old), limits(new));
                let holds =
                    accept::within(&one, &other) && accept::only_within(&old.only, &new.only);
                let held =
                    accept::within(&other, &one) && accept::only_within(&new.only, &old.only);
                let source = sources::changed(it.old, it.new);
                let values = [range(old), range(new)];
                let values = super::frame::both(&values);
                if !holds {
                    let finding = it.found(&rules::RANGE_TIGHTENED, values, Wire::OldSender);
                    self.report(finding.source(source.clone()));
                }
                if !held {
                    let finding = it.found(&rules::RANGE_WIDENED, values, Wire::NewSender);
                    self.report(finding.source(source));
                }
            }
            for key in ["min", "max", "only"] {
                self.claim_in(&it.path, &[key]);
            }
        }
        if old.length != new.length {
            let ends = |it: &Constraints| it.length.unwrap_or((0, u64::MAX));
            let (one, other) = (ends(old), ends(new));
            let shown = |it: &Constraints| match it.length {
                Some((least, most)) if most == u64::MAX => format!("{least}–"),
                Some((least, most)) => format!("{least}–{most}"),
                None => String::new(),
            };
            let values = [shown(old), shown(new)];
            let values = super::frame::both(&values);
            if one.0 < other.0 || other.1 < one.1 {
                self.report(it.found(&rules::LENGTH_TIGHTENED, values, Wire::OldSender));
            }
            if other.0 < one.0 || one.1 < other.1 {
                self.report(it.found(&rules::LENGTH_WIDENED, values, Wire::NewSender));
            }
            self.claim_in(&it.path, &["length"]);
        }
        if old.pattern != new.pattern {
            let values =
                [&old.pattern, &new.pattern].map(|it| it.as_ref().map_or("", Pattern::source));
            let wire = Wire::of(new.pattern.is_some(), old.pattern.is_some());
            self.report(it.found(&rules::PATTERN, values, wire));
            self.claim_in(&it.path, &["pattern"]);
        }
        let (old, new) = (it.old.details(), it.new.details());
        if old.default != new.default {
            let shown = |it: &Option<Scalar>| it.as_ref().map(json).unwrap_or_default();
            let values = [shown(&old.default), shown(&new.default)];
            let source = match &new.default {
                // The packages lose the default value.
                None => rules::DEFAULT.source.to_vec(),
                Some(_) if old.refers == new.refers => self.id_type_changed(it.old, it.new),
                Some(_) => Vec::new(),
            };
            let finding = it.found(&rules::DEFAULT, super::frame::both(&values), Wire::Fine);
            self.report(finding.source(source));
            self.claim_in(&it.path, &["default"]);
        }
        if it.old.sensitive && !it.new.sensitive {
            self.report(it.found(&rules::SENSITIVE, ["sensitive", ""], Wire::Fine));
            self.claim_in(&it.path, &["sensitive"]);
        }
    }
}

/// Returns the limits of a field as a string, such as `1–100` or `1, 6`.
fn range(it: &Constraints) -> String {
    let mut parts = Vec::new();
    if it.min.is_some() || it.max.is_some() {
        let end = |it: &Option<fc_spec::model::Number>| it.as_ref().map(json).unwrap_or_default();
        parts.push(format!("{}–{}", end(&it.min), end(&it.max)));
    }
    parts.extend(it.only.iter().map(json));
    parts.join(", ")
}
