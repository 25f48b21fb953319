//! Judges fields: their keys, types and forms.

use super::accept::{self, Interval};
use super::frame::both;
use super::types::Here;
use super::{Judge, ORDER, Path, sources};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair};
use crate::rule::{Language, Rule, Wire};
use crate::rules::fields as rules;
use crate::rules::process::DOCS;
use crate::rules::results::QUIRK_REMOVED;
use fc_spec::model::{Field, FloatKind, Model, Type};

/// The two versions of a field.
pub(super) struct Fields<'f> {
    pub(super) old: &'f Field,
    pub(super) new: &'f Field,
    pub(super) here: &'f Here,
    /// Path in the dump.
    pub(super) path: Path,
}

impl Fields<'_> {
    /// Returns a finding about the field.
    pub(super) fn found(&self, rule: &'static Rule, values: [&str; 2], wire: Wire) -> Finding {
        let keys = [&*self.old.wire, &*self.new.wire];
        let finding = self.here.part(rule, "field", keys, values);
        finding.on(self.here.senders, wire)
    }
}

impl Judge<'_> {
    /// Judges the fields of an object.
    pub(super) fn object(&mut self, here: &Here, old: &[Field], new: &[Field]) {
        let list = here.list("fields");
        self.fields_in(here, &list, old, new);
        self.member_order(here, &list, old, new);
    }

    /// Reports members of a C++ struct that change their position. Removed fields already break sources in C++.
    fn member_order(&mut self, here: &Here, list: &Path, old: &[Field], new: &[Field]) {
        let pairs = matching::fields(old, new);
        let kept = pairs.iter().filter_map(Pair::both);
        let kept: Vec<&str> = kept.map(|(_, field)| field.wire.as_str()).collect();
        let is_kept = |wire: &&str| kept.contains(wire);
        let wires = || new.iter().map(|it| it.wire.as_str());
        let now: Vec<&str> = wires().filter(is_kept).collect();
        let is_told = pairs.iter().any(|pair| matches!(pair, Pair::Removed(_)));
        let first: Vec<&str> = wires().take(kept.len()).collect();
        if now == kept && (is_told || first == kept) {
            return;
        }
        // Fields at another place, in the old and in the new order.
        let is_moved = |wire: &&str| {
            let was = pairs.iter().position(|pair| {
                let (Pair::Both(_, field) | Pair::Added(field) | Pair::Removed(field)) = pair;
                field.wire == *wire
            });
            was != wires().position(|it| it == *wire)
        };
        let moved = |order: &[&str]| {
            let moved = order.iter().copied().filter(is_moved);
            moved.collect::<Vec<_>>().join(", ")
        };
        let values = [moved(&kept), moved(&now)];
        let finding = Finding::new(&rules::MEMBER_ORDER, &here.subject, both(&values));
        self.report(here.owned("", finding));
        self.claim_in(list, &[ORDER]);
    }

    /// Judges the keys of the envelope, which every message has.
    pub(super) fn envelope(&mut self) {
        let (old, new) = (&self.old.envelope, &self.new.envelope);
        let first = self.found.len();
        for (key, old, new) in [
            ("request", &old.request, &new.request),
            ("response", &old.response, &new.response),
        ] {
            let subject = format!("envelope.{key}");
            let here = Here {
                path: vec!["protocol".to_owned(), "envelope".to_owned(), key.to_owned()],
                senders: Senders::BOTH,
                owners: [subject.clone(), subject.clone()],
                subject,
            };
            let (old, new) = (matching::envelope(old), matching::envelope(new));
            self.fields_in(&here, &here.path, &old, &new);
        }
        // The runtime builds the envelopes, so programs need no new keys. C++ has no types for envelopes.
        for finding in self.found.iter_mut().skip(first) {
            match finding.rule.number {
                number if number == rules::REQUIRED_ADDED.number => finding.source.clear(),
                _ => finding.source.retain(|it| *it != Language::Cpp),
            }
        }
    }

    fn fields_in(&mut self, here: &Here, list: &Path, old: &[Field], new: &[Field]) {
        for pair in matching::fields(old, new) {
            let (field, removed) = match pair {
                Pair::Both(old, new) => {
                    if old.wire != new.wire {
                        self.renamed(list, &old.wire, &new.wire);
                    }
                    let path = list.iter().cloned().chain([new.wire.clone()]).collect();
                    self.field(&Fields {
                        old,
                        new,
                        here,
                        path,
                    });
                    continue;
                }
                Pair::Removed(field) => (field, true),
                Pair::Added(field) => (field, false),
            };
            let (rule, wire) = match (field.optional, removed) {
                (true, true) => (&rules::OPTIONAL_REMOVED, Wire::Fine),
                (true, false) => (&rules::OPTIONAL_ADDED, Wire::Fine),
                (false, true) => (&rules::REQUIRED_REMOVED, Wire::NewSender),
                (false, false) => (&rules::REQUIRED_ADDED, Wire::OldSender),
            };
            let finding = here.alone(rule, removed, ("field", &field.wire), &field.wire);
            self.report(finding.on(here.senders, wire));
            self.claim_item(list, &field.wire);
        }
    }

    fn field(&mut self, it: &Fields<'_>) {
        self.key(it);
        let (old, new) = (it.old, it.new);
        if old.name != new.name {
            self.report(it.found(&rules::NAME_CHANGED, [&old.name, &new.name], Wire::Fine));
            self.claim_in(&it.path, &["name"]);
        }
        if old.optional != new.optional {
            let (rule, wire) = if new.optional {
                (&rules::BECAME_OPTIONAL, Wire::NewSender)
            } else {
                (&rules::BECAME_REQUIRED, Wire::OldSender)
            };
            let word = |optional| if optional { "optional" } else { "required" };
            let finding = it.found(rule, [word(old.optional), word(new.optional)], wire);
            self.report(finding.source(sources::changed(old, new)));
            self.claim_in(&it.path, &["optional"]);
        }
        if old.ty != new.ty {
            self.ty(it);
        }
        if old.wire_form != new.wire_form {
            let values = [old.wire_form.name(), new.wire_form.name()];
            self.report(it.found(&rules::FORM_CHANGED, values, accept::forms(old, new)));
            self.claim_in(&it.path, &["wire_form"]);
            // The example is written in the form of the message, so it changes too.
            self.claim_in(&it.path, &["example"]);
        }
        let (details, others) = (old.details(), new.details());
        if details.unit != others.unit {
            let values =
                [&details.unit, &others.unit].map(|unit| unit.as_deref().unwrap_or_default());
            // A missing unit is unknown, so the change may be a clarification.
            let is_known = details.unit.is_some() && others.unit.is_some();
            let wire = Wire::of(is_known, is_known);
            self.report(it.found(&rules::UNIT, values, wire));
            self.claim_in(&it.path, &["unit"]);
        }
        let systems = [&details.coordinates, &others.coordinates];
        if let Some(values) = self.other_coordinates(systems) {
            self.report(it.found(&rules::COORDINATES, values, Wire::Both));
            self.claim_in(&it.path, &["coordinates"]);
        }
        self.reference(it);
        for quirk in details
            .quirks
            .iter()
            .filter(|quirk| !others.quirks.contains(quirk))
        {
            self.report(it.found(&QUIRK_REMOVED, [quirk.name(), ""], Wire::OldSender));
            self.claim_in(&it.path, &["quirks"]);
        }
        self.constraints(it);
        if old.example != new.example && old.ty == new.ty {
            self.report(it.found(&DOCS, ["example", ""], Wire::Fine));
            self.claim_in(&it.path, &["example"]);
            self.claim_in(&it.path, &["example_is"]);
        }
    }

    fn key(&mut self, it: &Fields<'_>) {
        let (old, new) = (it.old, it.new);
        let (also, now) = (&old.details().also, &new.details().also);
        if old.wire != new.wire {
            let is_kept = now.contains(&old.wire);
            let wire = Wire::of(!is_kept, !also.contains(&new.wire));
            let rule = if is_kept {
                &rules::KEY_CHANGED_WITH_ALSO
            } else {
                &rules::KEY_CHANGED
            };
            // If the field is required, the receiver reports the missing key.
            let silent = old.optional || new.optional;
            self.report(it.found(rule, [&old.wire, &new.wire], wire).silent(silent));
            for key in ["path", "wire", "also"] {
                self.claim_in(&it.path, &[key]);
            }
        }
        for gone in also
            .iter()
            .filter(|key| !now.contains(key) && **key != new.wire)
        {
            let finding = it.found(&rules::ALSO_REMOVED, [gone, ""], Wire::OldSender);
            self.report(finding.silent(new.optional));
            self.claim_in(&it.path, &["also"]);
        }
    }

    fn ty(&mut self, it: &Fields<'_>) {
        let (old, new) = (it.old, it.new);
        self.claim_in(&it.path, &["type"]);
        self.claim_in(&it.path, &["example"]);
        self.claim_in(&it.path, &["example_is"]);
        // Other findings judge a pair of named types, including their names.
        if matching::named(&old.ty, &new.ty).is_some() {
            return;
        }
        let values = [old.ty.to_string(), new.ty.to_string()];
        let values = both(&values);
        let mut types = (&old.ty, &new.ty);
        while let (Type::Array(one), Type::Array(other)) = types {
            types = (one, other);
        }
        let intervals = (
            accept::interval(types.0, old.details()),
            accept::interval(types.1, new.details()),
        );
        let wire = |one: &Interval, other: &Interval| {
            Wire::of(!accept::within(one, other), !accept::within(other, one))
        };
        let source = sources::changed(old, new);
        let finding = match (types, intervals) {
            ((Type::TimestampMs, Type::TimestampS) | (Type::TimestampS, Type::TimestampMs), _) => {
                it.found(&rules::TIME_UNIT, values, Wire::Both)
            }
            ((Type::Int(one), Type::Int(other)), (Some(old), Some(new))) => {
                let (from, to) = (accept::of_integers(*one), accept::of_integers(*other));
                let rule = if accept::within(&from, &to) {
                    &rules::NUMBER_WIDENED
                } else {
                    &rules::NUMBER_NARROWED
                };
                it.found(rule, values, wire(&old, &new))
            }
            ((Type::Float(one), Type::Float(_)), _) => match one {
                FloatKind::F32 => it.found(&rules::NUMBER_WIDENED, values, Wire::NewSender),
                FloatKind::F64 => it.found(&rules::NUMBER_NARROWED, values, Wire::OldSender),
            },
            ((Type::Int(_), Type::Float(_)), _) => {
                it.found(&rules::INTEGER_FLOAT, values, Wire::NewSender)
            }
            ((Type::Float(_), Type::Int(_)), _) => {
                it.found(&rules::INTEGER_FLOAT, values, Wire::OldSender)
            }
            ((Type::Json, _), _) => it.found(&rules::JSON_TYPED, values, Wire::OldSender),
            // A timestamp and an integer.
            (_, (Some(one), Some(other))) => {
                it.found(&rules::TYPE_CHANGED, values, wire(&one, &other))
            }
            ((one, other), _) => it.found(&rules::TYPE_CHANGED, values, accept::types(one, other)),
        };
        self.report(finding.source(source));
    }

    /// Returns the coordinate systems if positions are in another one. A renamed system is the same.
    pub(super) fn other_coordinates<'s>(
        &self,
        systems: [&'s Option<String>; 2],
    ) -> Option<[&'s str; 2]> {
        let [Some(old), Some(new)] = systems else {
            return None;
        };
        let has =
            |model: &Model, name: &String| model.coordinates.iter().any(|it| it.name == *name);
        let is_renamed = !has(self.new, old) && !has(self.old, new);
        (old != new && !is_renamed).then_some([old, new])
    }

    /// Judges the entity to which a field refers.
    fn reference(&mut self, it: &Fields<'_>) {
        let (one, other) = (&it.old.details().refers, &it.new.details().refers);
        if one == other {
            return;
        }
        let source = self.id_type_changed(it.old, it.new);
        let is_known = |model: &Model, name: &str| model.entity(name).is_some();
        let is_other = match (one, other) {
            (Some(one), Some(other)) => is_known(self.new, one) || is_known(self.old, other),
            _ => false,
        };
        // If the ID type stays the same, adding or removing `refers` only changes documentation.
        if source.is_empty() && !is_other {
            return;
        }
        let values = [one, other].map(|it| it.as_deref().unwrap_or_default());
        let finding = it.found(&rules::REFERENCE, values, Wire::Fine);
        self.report(finding.source(source).behaviour(is_other).silent(is_other));
        self.claim_in(&it.path, &["refers"]);
    }

    /// Returns the languages in which the ID type of a field changes.
    pub(super) fn id_type_changed(&self, old: &Field, new: &Field) -> Vec<Language> {
        if self.packages.id_types && id_type(old) != id_type(new) {
            rules::REFERENCE.source.to_vec()
        } else {
            Vec::new()
        }
    }
}

/// Returns the entity whose ID type a field has. A string with a default stays a string.
fn id_type(field: &Field) -> Option<&str> {
    let details = field.details();
    let is_text = *field.ty.item() == Type::String;
    let refers = details.refers.as_deref();
    refers.filter(|_| !(is_text && details.default.is_some()))
}
