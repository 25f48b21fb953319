//! Judges types: objects, enums and choices.

use super::accept::{of_integers, within};
use super::frame::both;
use super::{Judge, ORDER, Path, called, json};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair, TypePair};
use crate::rule::{Language, Rule, Wire};
use crate::rules::choices as rules;
use crate::rules::fields::{
    COORDINATES, NAME_CHANGED, NUMBER_NARROWED, NUMBER_WIDENED, TYPE_CHANGED,
};
use crate::rules::operations::GROUP_MOVED;
use fc_spec::model::{EnumRepr, EnumType, IntKind, OneOf, TypeDef, TypeShape};

/// The place of a pair that is judged.
#[derive(Clone)]
pub(super) struct Here {
    /// The name in findings.
    pub(super) subject: String,
    /// The path in the dump.
    pub(super) path: Path,
    /// The senders of messages that contain it.
    pub(super) senders: Senders,
    /// The names of the old and the new type.
    pub(super) owners: [String; 2],
}

impl Here {
    /// Returns the path of a list in it.
    pub(super) fn list(&self, key: &str) -> Path {
        [&self.path[..], &[key.to_owned()]].concat()
    }

    /// Adds both types to a finding.
    pub(super) fn owned(&self, kind: &'static str, finding: Finding) -> Finding {
        let [old, new] = &self.owners;
        finding.was(kind, old).is(kind, new)
    }

    /// Returns a finding about a part with these old and new names.
    pub(super) fn part(
        &self,
        rule: &'static Rule,
        kind: &'static str,
        [was, is]: [&str; 2],
        values: [&str; 2],
    ) -> Finding {
        let [old, new] = &self.owners;
        Finding::new(rule, format!("{}.{is}", self.subject), values)
            .was(kind, format!("{old}.{was}"))
            .is(kind, format!("{new}.{is}"))
    }

    /// Returns a finding about a part that only one version has, as [`Finding::alone`] does.
    pub(super) fn alone(
        &self,
        rule: &'static Rule,
        removed: bool,
        (kind, name): (&'static str, &str),
        value: &str,
    ) -> Finding {
        let [old, new] = &self.owners;
        let owner = if removed { old } else { new };
        let subject = format!("{}.{name}", self.subject);
        Finding::alone(
            rule,
            removed,
            subject,
            value,
            (kind, format!("{owner}.{name}")),
        )
    }
}

impl Judge<'_> {
    pub(super) fn types(&mut self) {
        self.renamed_types();
        for TypePair { old, new, senders } in self.types.both.clone() {
            let here = Here {
                subject: called(new),
                path: vec!["types".to_owned(), new.name.clone()],
                senders,
                owners: [old.name.clone(), new.name.clone()],
            };
            if old.group != new.group {
                self.type_moved(old, new);
            }
            match (&old.shape, &new.shape) {
                (TypeShape::Struct(old), TypeShape::Struct(new)) => {
                    let systems = [&old.coordinates, &new.coordinates];
                    if let Some(values) = self.other_coordinates(systems) {
                        let finding = Finding::new(&COORDINATES, &here.subject, values);
                        self.report(here.owned("", finding).on(senders, Wire::Both));
                        self.claim_in(&here.path, &["coordinates"]);
                    }
                    self.object(&here, &old.fields, &new.fields);
                }
                (TypeShape::Enum(old), TypeShape::Enum(new)) => self.enumeration(&here, old, new),
                (TypeShape::OneOf(old), TypeShape::OneOf(new)) => self.choice(&here, old, new),
                (old, new) => {
                    let values = [kind(old), kind(new)];
                    let finding = Finding::new(&TYPE_CHANGED, &here.subject, values);
                    self.report(finding.at("", &here.owners[1]).on(senders, Wire::Both));
                    self.claim_in(&here.path, &[]);
                }
            }
        }
    }

    /// Judges a move to another group. A type in a message moves with its operation, and a renamed type has another
    /// path anyway.
    fn type_moved(&mut self, old: &TypeDef, new: &TypeDef) {
        self.claim(&["types", &new.name, "group"]);
        if new.body_of.is_none() && old.name == new.name {
            let [from, to] = [old, new].map(|it| it.group.as_deref().unwrap_or_default());
            let finding = Finding::new(&GROUP_MOVED, &new.name, [from, to]);
            let source = [Language::Rust, Language::Cpp, Language::Python];
            self.report(finding.source(source).at("", &new.name));
        }
    }

    fn enumeration(&mut self, here: &Here, old: &EnumType, new: &EnumType) {
        if old.repr != new.repr {
            self.repr(here, old, new);
        }
        if old.closed != new.closed {
            let word = |closed| if closed { "closed" } else { "" };
            let values = [word(old.closed), word(new.closed)];
            let finding = Finding::new(&rules::ENUM_CLOSED, &here.subject, values);
            let wire = Wire::of(new.closed, old.closed);
            self.report(here.owned("enum", finding).on(here.senders, wire));
            self.claim_in(&here.path, &["closed"]);
        }
        let pairs = matching::align(
            &old.values,
            &new.values,
            &[&|one, other| one.name == other.name, &|one, other| {
                one.wire == other.wire
            }],
        );
        self.states(here, [old, new], &pairs);
        let list = here.list("values");
        for pair in pairs {
            match pair {
                Pair::Both(one, other) if one.wire != other.wire => {
                    let values = [json(&one.wire), json(&other.wire)];
                    let names = [&*one.name, &*other.name];
                    let finding =
                        here.part(&rules::VALUE_RENUMBERED, "value", names, both(&values));
                    // In TypeScript, the type of a closed enum lists the values in messages.
                    let finding = finding.source_if(old.closed);
                    self.report(finding.on(here.senders, Wire::Both));
                    self.claim_in(&list, &[&other.name, "value"]);
                    self.claim_in(&list, &[ORDER]);
                }
                Pair::Both(one, other) if one.name != other.name => {
                    let names = [&*one.name, &*other.name];
                    self.report(here.part(&NAME_CHANGED, "value", names, names));
                    self.renamed(&list, &one.name, &other.name);
                    self.claim_in(&list, &[&other.name, "name"]);
                }
                Pair::Both(..) => {}
                Pair::Removed(one) => {
                    let named = ("value", &*one.name);
                    let finding = here.alone(&rules::VALUE_REMOVED, true, named, &json(&one.wire));
                    let finding = finding.on(here.senders, Wire::of(new.closed, false));
                    self.report(finding.behaviour(!new.closed));
                    self.claim_item(&list, &one.name);
                }
                Pair::Added(other) => {
                    let rule = if old.closed {
                        &rules::VALUE_ADDED_CLOSED
                    } else {
                        &rules::VALUE_ADDED_OPEN
                    };
                    let named = ("value", &*other.name);
                    let finding = here.alone(rule, false, named, &json(&other.wire));
                    self.report(finding.on(here.senders, Wire::of(false, old.closed)));
                    self.claim_item(&list, &other.name);
                }
            }
        }
    }

    /// Judges the representation of an enum in messages.
    fn repr(&mut self, here: &Here, old: &EnumType, new: &EnumType) {
        let values = [old.repr.name(), new.repr.name()];
        let is_large = |repr| matches!(repr, EnumRepr::Int(IntKind::I64 | IntKind::U64));
        let mut sized = vec![Language::Rust, Language::Cpp];
        sized.extend((is_large(old.repr) != is_large(new.repr)).then_some(Language::Typescript));
        let (rule, wire, source) = match (old.repr, new.repr) {
            (EnumRepr::Int(one), EnumRepr::Int(other)) => {
                let (one, other) = (of_integers(one), of_integers(other));
                let (fits, fitted) = (within(&one, &other), within(&other, &one));
                // The values of a closed enum fit both types. Otherwise the spec would have an error.
                let wire = Wire::of(!fits && !old.closed, !fitted && !new.closed);
                let rule = if fits {
                    &NUMBER_WIDENED
                } else {
                    &NUMBER_NARROWED
                };
                (rule, wire, sized)
            }
            _ => (&TYPE_CHANGED, Wire::Both, TYPE_CHANGED.source.to_vec()),
        };
        let finding = Finding::new(rule, &here.subject, values);
        let finding = here.owned("enum", finding).on(here.senders, wire);
        self.report(finding.source(source));
        self.claim_in(&here.path, &["repr"]);
    }

    fn choice(&mut self, here: &Here, old: &OneOf, new: &OneOf) {
        let list = here.list("variants");
        let mut common = Vec::new();
        for pair in matching::variants(old, new) {
            match pair {
                Pair::Both(one, other) => {
                    common.push(other.name.as_str());
                    if one.ty.name() != other.ty.name() {
                        self.claim_in(&list, &[&other.name, "type"]);
                    }
                }
                Pair::Removed(one) => {
                    let named = ("variant", &*one.name);
                    let finding = here.alone(&rules::VARIANT, true, named, &one.name);
                    self.report(finding.on(here.senders, Wire::OldSender));
                    self.claim_item(&list, &one.name);
                }
                Pair::Added(other) => {
                    let named = ("variant", &*other.name);
                    let finding = here.alone(&rules::VARIANT, false, named, &other.name);
                    let finding = finding.on(here.senders, Wire::NewSender);
                    self.report(finding.source(rules::MATCHED));
                    self.claim_item(&list, &other.name);
                }
            }
        }
        let now = new.variants.iter().map(|it| it.name.as_str());
        let now: Vec<&str> = now.filter(|name| common.contains(name)).collect();
        if common != now {
            let values = [common.join(", "), now.join(", ")];
            let finding = Finding::new(&rules::VARIANT_ORDER, &here.subject, both(&values));
            self.report(here.owned("", finding).on(here.senders, Wire::Both));
            self.claim_in(&list, &[ORDER]);
        }
    }
}

fn kind(shape: &TypeShape) -> &'static str {
    match shape {
        TypeShape::Struct(_) => "object",
        TypeShape::Enum(_) => "enum",
        TypeShape::OneOf(_) => "one_of",
    }
}
