//! Finds keys, enum values, results and codes that return with another meaning after they were removed in a release.

use crate::finding::{Finding, Senders, Spot};
use crate::judge::judged;
use crate::matching::{self, Pair, TypePair};
use crate::rule::{Rule, Wire};
use crate::rules::fields as rules;
use crate::rules::operations::{CODE_REUSED, OPERATION_RENAMED};
use fc_spec::model::{Model, Operation, TypeShape};

/// Rules about the meaning of a field.
static MEANINGS: [&Rule; 10] = [
    &rules::TYPE_CHANGED,
    &rules::JSON_TYPED,
    &rules::NUMBER_WIDENED,
    &rules::NUMBER_NARROWED,
    &rules::INTEGER_FLOAT,
    &rules::FORM_CHANGED,
    &rules::TIME_UNIT,
    &rules::UNIT,
    &rules::COORDINATES,
    &rules::REFERENCE,
];

/// Compares parts of `new` that `old` lacks with earlier releases. If several releases differ, it reports the first one.
pub(crate) fn reused<'m>(
    earlier: impl IntoIterator<Item = (&'m str, &'m Model)>,
    old: &Model,
    new: &Model,
) -> Vec<Finding> {
    let mut earlier = earlier.into_iter().peekable();
    if earlier.peek().is_none() {
        return Vec::new();
    }
    let between = Between::of(old, new);
    let mut found: Vec<Finding> = Vec::new();
    for (release, model) in earlier {
        let mut back = between.results(release, model);
        for finding in judged(model, new) {
            back.extend(between.judge(release, finding));
        }
        let is_new = |it: &Finding| {
            let mut known = found.iter();
            !known.any(|known| known.rule.number == it.rule.number && known.subject == it.subject)
        };
        let new_ones: Vec<Finding> = back.into_iter().filter(is_new).collect();
        found.extend(new_ones);
    }
    found
}

/// The old and the new version, to look up fields and values of the old one.
struct Between<'m> {
    old: &'m Model,
    new: &'m Model,
    types: Vec<TypePair<'m>>,
}

impl<'m> Between<'m> {
    fn of(old: &'m Model, new: &'m Model) -> Self {
        let operations = matching::operations(old, new);
        let types = matching::types(old, new, &operations).both;
        Self { old, new, types }
    }

    /// Turns a difference from an earlier release into a finding, if `old` lacks the field or value.
    fn judge(&self, release: &str, finding: Finding) -> Option<Finding> {
        if finding.rule.number == CODE_REUSED.number {
            let name = &finding.values[1];
            let code = |model: &Model| model.operation(name).and_then(|it| it.code.value);
            let is_back = code(self.old) != code(self.new);
            return is_back.then_some(finding);
        }
        if finding.rule.number == OPERATION_RENAMED.number {
            return self.code(&finding.values);
        }
        let (was, is) = (finding.old.first()?, finding.new.first()?);
        let (_, key) = is.name.rsplit_once('.')?;
        let is_same = was.name.rsplit_once('.').map(|(_, key)| key) == Some(key);
        let is_meaning = MEANINGS.iter().any(|it| it.number == finding.rule.number);
        let is_value = is.kind == "value" && finding.rule.number == rules::NAME_CHANGED.number;
        let is_field = is.kind == "field" && is_meaning && is_same;
        if !(is_value || is_field) || self.has(is) {
            return None;
        }
        let [from, to] = &finding.values;
        let from = format!("{from} ({release})");
        let reused = Finding::new(&rules::REUSED, &finding.subject, [&from, to]);
        let mut reused = reused.silent(finding.silent || is_value);
        reused.new.clone_from(&finding.new);
        reused.wire = if is_value {
            // A finding about a name has no senders.
            self.senders(is).broken(Wire::Both)
        } else {
            finding.wire
        };
        (!reused.wire.is_empty()).then_some(reused)
    }

    /// Returns a finding for an operation that has the code of an earlier one, if the old version has no operation with it.
    fn code(&self, [earlier, name]: &[String; 2]) -> Option<Finding> {
        let new = self.new.operation(name)?;
        let has_code = |it: &Operation| (it.kind(), it.code.value) == (new.kind(), new.code.value);
        if self.old.operations.iter().any(has_code) {
            return None;
        }
        let finding = Finding::new(&CODE_REUSED, &new.code.spelling, [earlier, name]);
        let finding = finding.is(new.kind().name(), name);
        Some(finding.on(Senders::of(new.sender), Wire::Both))
    }

    /// Returns `true` if the old version has this field or value.
    fn has(&self, spot: &Spot) -> bool {
        let Some((owner, key)) = spot.name.rsplit_once('.') else {
            return true;
        };
        let keys = match owner {
            "envelope.request" => self.old.envelope.request.as_slice(),
            "envelope.response" => &self.old.envelope.response,
            _ => &[],
        };
        if keys.iter().any(|it| it.wire == key) {
            return true;
        }
        let mut types = self.types.iter().filter(|it| it.new.name == owner);
        types.any(|it| match (&it.old.shape, &it.new.shape) {
            (TypeShape::Struct(old), TypeShape::Struct(new)) => {
                let pairs = matching::fields(&old.fields, &new.fields);
                let mut pairs = pairs.iter().filter_map(Pair::both);
                pairs.any(|(_, field)| field.wire == key)
            }
            (TypeShape::Enum(old), TypeShape::Enum(new)) => {
                let wire = new.values.iter().find(|it| it.name == key);
                let wire = wire.map(|it| &it.wire);
                old.values.iter().any(|it| Some(&it.wire) == wire)
            }
            _ => false,
        })
    }

    /// Returns the senders of an enum.
    fn senders(&self, spot: &Spot) -> Senders {
        let operations = matching::operations(self.new, self.new);
        let types = matching::types(self.new, self.new, &operations);
        let owner = spot.name.rsplit_once('.').map(|(owner, _)| owner);
        let mut pairs = types.both.into_iter();
        let pair = pairs.find(|it| Some(it.new.name.as_str()) == owner);
        pair.map_or(Senders::BOTH, |it| it.senders)
    }

    /// Finds result codes that return with another name.
    fn results(&self, release: &str, earlier: &Model) -> Vec<Finding> {
        let name = |model: &'m Model, code: i64| {
            let mut results = model.results.iter();
            let result = results.find(|it| it.code == code);
            result.map(|it| it.name.as_str())
        };
        let mut found = Vec::new();
        for was in &earlier.results {
            let is = name(self.new, was.code).filter(|is| *is != was.name);
            if let (Some(is), None) = (is, name(self.old, was.code)) {
                let from = format!("{} ({release})", was.name);
                let subject = format!("results.{is}");
                let finding = Finding::new(&rules::REUSED, subject, [&from, is]);
                let finding = finding.is("result", was.code.to_string());
                found.push(finding.on(Senders::BOTH, Wire::Both));
            }
        }
        found
    }
}
