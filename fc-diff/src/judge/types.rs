//! Judges types: objects, enums and choices.

use super::{Judge, Path, called, json};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair, TypePair};
use crate::rule::{Language, Wire};
use crate::rules::choices as rules;
use crate::rules::fields::{NAME_CHANGED, NUMBER_NARROWED, NUMBER_WIDENED, TYPE_CHANGED};
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
                    if let Some(finding) = self.coordinates(here.subject.clone(), systems) {
                        let finding = finding.was("", &here.owners[0]).is("", &here.owners[1]);
                        self.report(finding.on(senders, Wire::Both));
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
        let at = |finding: Finding| {
            finding
                .was("enum", &here.owners[0])
                .is("enum", &here.owners[1])
        };
        if old.repr != new.repr {
            self.repr(here, old, new);
        }
        if old.closed != new.closed {
            let word = |closed| if closed { "closed" } else { "" };
            let finding = Finding::new(
                &rules::ENUM_CLOSED,
                &here.subject,
                [word(old.closed), word(new.closed)],
            );
            let finding = at(finding).on(here.senders, Wire::of(new.closed, old.closed));
            self.report(finding);
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
        let list: Path = here
            .path
            .iter()
            .cloned()
            .chain(["values".to_owned()])
            .collect();
        for pair in pairs {
            match pair {
                Pair::Both(one, other) if one.wire != other.wire => {
                    let values = [json(&one.wire), json(&other.wire)];
                    let subject = format!("{}.{}", here.subject, other.name);
                    let finding = Finding::new(
                        &rules::VALUE_RENUMBERED,
                        subject,
                        super::frame::both(&values),
                    );
                    // In TypeScript, the type of a closed enum lists the values in messages.
                    let source = if old.closed {
                        rules::VALUE_RENUMBERED.source
                    } else {
                        &[]
                    };
                    self.report(
                        Self::value(finding, here, &one.name, &other.name)
                            .on(here.senders, Wire::Both)
                            .source(source),
                    );
                    self.claim_in(&list, &[&other.name, "value"]);
                    self.claim_in(&list, &["#order"]);
                }
                Pair::Both(one, other) if one.name != other.name => {
                    let subject = format!("{}.{}", here.subject, other.name);
                    let finding = Finding::new(&NAME_CHANGED, subject, [&one.name, &other.name]);
                    self.report(Self::value(finding, here, &one.name, &other.name));
                    self.renamed_in(&list, &one.name, &other.name);
                    self.claim_in(&list, &[&other.name, "name"]);
                }
                Pair::Both(..) => {}
                Pair::Removed(one) => {
                    let subject = format!("{}.{}", here.subject, one.name);
                    let finding =
                        Finding::new(&rules::VALUE_REMOVED, subject, [&json(&one.wire), ""]);
                    let finding = finding.was("value", format!("{}.{}", here.owners[0], one.name));
                    let finding = finding.on(here.senders, Wire::of(new.closed, false));
                    self.report(finding.behaviour(!new.closed));
                    self.claim_in(&list, &[&one.name]);
                    self.claim_in(&list, &["#order"]);
                }
                Pair::Added(other) => {
                    let rule = if old.closed {
                        &rules::VALUE_ADDED_CLOSED
                    } else {
                        &rules::VALUE_ADDED_OPEN
                    };
                    let subject = format!("{}.{}", here.subject, other.name);
                    let finding = Finding::new(rule, subject, ["", &json(&other.wire)]);
                    let finding = finding.is("value", format!("{}.{}", here.owners[1], other.name));
                    self.report(finding.on(here.senders, Wire::of(false, old.closed)));
                    self.claim_in(&list, &[&other.name]);
                    self.claim_in(&list, &["#order"]);
                }
            }
        }
    }

    fn value(finding: Finding, here: &Here, old: &str, new: &str) -> Finding {
        let [one, other] = &here.owners;
        finding
            .was("value", format!("{one}.{old}"))
            .is("value", format!("{other}.{new}"))
    }

    /// Judges the representation of an enum in messages.
    fn repr(&mut self, here: &Here, old: &EnumType, new: &EnumType) {
        let name = |repr: EnumRepr| match repr {
            EnumRepr::Int(kind) => kind.name(),
            EnumRepr::String => "string",
        };
        let values = [name(old.repr), name(new.repr)];
        let is_large = |repr| matches!(repr, EnumRepr::Int(IntKind::I64 | IntKind::U64));
        let mut sized = vec![Language::Rust, Language::Cpp];
        sized.extend((is_large(old.repr) != is_large(new.repr)).then_some(Language::Typescript));
        let (rule, wire, source) = match (old.repr, new.repr) {
            (EnumRepr::Int(one), EnumRepr::Int(other)) => {
                let (one, other) = (one.range(), other.range());
                let is_within = |inner: (i128, i128), outer: (i128, i128)| {
                    outer.0 <= inner.0 && inner.1 <= outer.1
                };
                let (fits, fitted) = (is_within(one, other), is_within(other, one));
                // The values of a closed enum fit both types. Otherwise the spec would have an error.
                let wire = Wire::of(!fits && !old.closed, !fitted && !new.closed);
                (
                    if fits {
                        &NUMBER_WIDENED
                    } else {
                        &NUMBER_NARROWED
                    },
                    wire,
                    sized,
                )
            }
            _ => (&TYPE_CHANGED, Wire::Both, TYPE_CHANGED.source.to_vec()),
        };
        let finding = Finding::new(rule, &here.subject, values);
        let finding = finding
            .was("enum", &here.owners[0])
            .is("enum", &here.owners[1]);
        self.report(finding.on(here.senders, wire).source(source));
        self.claim_in(&here.path, &["repr"]);
    }

    fn choice(&mut self, here: &Here, old: &OneOf, new: &OneOf) {
        let list: Path = here
            .path
            .iter()
            .cloned()
            .chain(["variants".to_owned()])
            .collect();
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
                    let subject = format!("{}.{}", here.subject, one.name);
                    let finding = Finding::new(&rules::VARIANT, subject, [&one.name, ""]);
                    let finding =
                        finding.was("variant", format!("{}.{}", here.owners[0], one.name));
                    self.report(finding.on(here.senders, Wire::OldSender));
                    self.claim_in(&list, &[&one.name]);
                    self.claim_in(&list, &["#order"]);
                }
                Pair::Added(other) => {
                    let subject = format!("{}.{}", here.subject, other.name);
                    let finding = Finding::new(&rules::VARIANT, subject, ["", &other.name]);
                    let finding =
                        finding.is("variant", format!("{}.{}", here.owners[1], other.name));
                    let finding = finding.on(here.senders, Wire::NewSender);
                    self.report(finding.source(rules::MATCHED));
                    self.claim_in(&list, &[&other.name]);
                    self.claim_in(&list, &["#order"]);
                }
            }
        }
        let now = new.variants.iter().map(|it| it.name.as_str());
        let now: Vec<&str> = now.filter(|name| common.contains(name)).collect();
        if common != now {
            let values = [common.join(", "), now.join(", ")];
            let finding = Finding::new(
                &rules::VARIANT_ORDER,
                &here.subject,
                super::frame::both(&values),
            );
            self.report(
                finding
                    .was("", &here.owners[0])
                    .is("", &here.owners[1])
                    .on(here.senders, Wire::Both),
            );
            self.claim_in(&list, &["#order"]);
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
