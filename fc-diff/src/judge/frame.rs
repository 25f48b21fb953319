//! Judges the frame and the transport.

use super::{Judge, ORDER, shown};
use crate::finding::{Finding, Senders};
use crate::matching::{self, Pair};
use crate::rule::{Language, Wire};
use crate::rules::fields::NAME_CHANGED;
use crate::rules::frame as rules;
use crate::rules::results::QUIRK_REMOVED;
use fc_spec::model::{Encoding, HeaderField, KindRole};

impl Judge<'_> {
    pub(super) fn frame(&mut self) {
        self.ports();
        self.header();
        self.kinds();
        self.encodings();
        self.limits();
    }

    fn ports(&mut self) {
        let (old, new) = (&self.old.transport.ports, &self.new.transport.ports);
        for (old, new) in old.each().into_iter().zip(new.each()) {
            if old.number != new.number {
                let role = old.role.name();
                let values = [old.number.to_string(), new.number.to_string()];
                let finding =
                    Finding::new(&rules::PORT_NUMBER, format!("port.{role}"), both(&values));
                self.report(finding.on(Senders::BOTH, Wire::Both).at("port", role));
                self.claim(&["protocol", "ports", role, "number"]);
            }
        }
    }

    fn header(&mut self) {
        let (old, new) = (&self.old.frame, &self.new.frame);
        if old.byte_order != new.byte_order {
            let values = [old.byte_order.name(), new.byte_order.name()];
            let finding = Finding::new(&rules::BYTE_ORDER, "frame.byte_order", values);
            self.report(finding.on(Senders::BOTH, Wire::Both).at("frame", "frame"));
            self.claim(&["protocol", "frame", "byte_order"]);
        }
        for (key, old, new) in [
            ("request_head", &old.request_head, &new.request_head),
            ("response_head", &old.response_head, &new.response_head),
        ] {
            if old != new {
                let values = [hex(old), hex(new)];
                let finding =
                    Finding::new(&rules::HEAD_BYTES, format!("frame.{key}"), both(&values));
                self.report(finding.on(Senders::BOTH, Wire::Both).at("frame", "frame"));
                self.claim(&["protocol", "frame", key]);
            }
        }
        self.layout(&old.header, &new.header);
        let digest = |fields: &[HeaderField]| {
            fields
                .iter()
                .find_map(HeaderField::digest)
                .map(fc_spec::model::DigestAlgorithm::name)
        };
        let (one, other) = (digest(&old.header), digest(&new.header));
        if one != other {
            let values = [one.unwrap_or_default(), other.unwrap_or_default()];
            let mut finding =
                Finding::new(&rules::DIGEST, "frame.digest", values).on(Senders::BOTH, Wire::Both);
            for field in old.header.iter().filter(|it| it.digest().is_some()) {
                finding = finding.was("header field", &field.wire);
            }
            for field in new.header.iter().filter(|it| it.digest().is_some()) {
                finding = finding.is("header field", &field.wire);
                self.claim(&["protocol", "frame", "header", &field.wire, "algorithm"]);
            }
            self.report(finding);
        }
    }

    /// Judges the fields of the header, paired by role, then by name, then by position.
    fn layout(&mut self, old: &[HeaderField], new: &[HeaderField]) {
        let list = ["protocol", "frame", "header"];
        let pairs = matching::align(
            old,
            new,
            &[
                &|one, other| one.role.is_some() && one.role == other.role,
                &|one, other| (one.role, &one.name) == (other.role, &other.name),
                &|one, other| (one.role, &one.wire) == (other.role, &other.wire),
                &|one, other| {
                    (one.role, one.ty, one.offset) == (other.role, other.ty, other.offset)
                },
            ],
        );
        for pair in pairs {
            let (one, other) = match pair {
                Pair::Both(one, other) => (Some(one), Some(other)),
                Pair::Removed(one) => (Some(one), None),
                Pair::Added(other) => (None, Some(other)),
            };
            let Some(field) = other.or(one) else {
                continue;
            };
            let called = field.role.map_or(field.name.as_str(), |role| role.name());
            let subject = format!("frame.header.{called}");
            let at = |mut finding: Finding| {
                if let Some(one) = one {
                    finding = finding.was("header field", &one.wire);
                }
                if let Some(other) = other {
                    finding = finding.is("header field", &other.wire);
                }
                finding
            };
            let shape = |field: Option<&HeaderField>| {
                shown(field.map(|it| format!("{}@{}", it.ty, it.offset)))
            };
            let values = [shape(one), shape(other)];
            if values[0] != values[1] {
                let finding = Finding::new(&rules::HEADER_LAYOUT, &subject, both(&values));
                // A new or moved field does not change the type of any Rust field.
                let ty = |field: Option<&HeaderField>| field.map(|it| it.ty);
                let is_other = one.is_some() && ty(one) != ty(other);
                let finding = finding.source_if(is_other);
                self.report(at(finding).on(Senders::BOTH, Wire::Both));
                self.claim_in(&list, &[ORDER]);
                match (one, other) {
                    (Some(_), Some(other)) => {
                        for key in ["type", "offset"] {
                            self.claim_in(&list, &[&other.wire, key]);
                        }
                    }
                    _ => self.claim_in(&list, &[&field.wire]),
                }
            }
            let (Some(one), Some(other)) = (one, other) else {
                continue;
            };
            if one.wire != other.wire {
                self.renamed(&list, &one.wire, &other.wire);
            }
            if one.name != other.name {
                let finding = Finding::new(&NAME_CHANGED, &subject, [&one.name, &other.name]);
                self.report(at(finding).source([Language::Rust]));
                // The code name comes from the wire name.
                for key in ["name", "wire"] {
                    self.claim_in(&list, &[&other.wire, key]);
                }
            }
            for quirk in one.quirks.iter().filter(|it| !other.quirks.contains(it)) {
                let finding = Finding::new(&QUIRK_REMOVED, &subject, [quirk.name(), ""]);
                self.report(at(finding).on(Senders::BOTH, Wire::OldSender));
                self.claim_in(&list, &[&other.wire, "quirks"]);
            }
        }
    }

    fn kinds(&mut self) {
        let list = ["protocol", "frame", "kinds"];
        let (old, new) = (&self.old.frame.kinds, &self.new.frame.kinds);
        for (one, other) in [
            (&old.stream, &new.stream),
            (&old.command, &new.command),
            (&old.report, &new.report),
        ] {
            let role = one.role.name();
            let values = [one.value.to_string(), other.value.to_string()];
            if one.value != other.value {
                let subject = format!("frame.kinds.{role}");
                let finding = Finding::new(&rules::KIND_VALUE, subject, both(&values));
                let finding = finding
                    .was("frame kind", &values[0])
                    .is("frame kind", &values[1]);
                self.report(finding.on(Senders::BOTH, Wire::Both));
                self.claim_in(&list, &[&values[0]]);
                self.claim_item(&list, &values[1]);
            }
            if old.reserved.iter().any(|it| it.value == other.value) {
                let subject = format!("frame.kinds.{}", other.value);
                let roles = [KindRole::Reserved.name(), role];
                let finding = Finding::new(&rules::RESERVED_KIND, subject, roles);
                let finding = finding.at("frame kind", &values[1]);
                self.report(finding.on(Senders::BOTH, Wire::NewSender));
            }
            if one.port != other.port {
                let values = [one.port.name(), other.port.name()];
                let value = other.value.to_string();
                let subject = format!("frame.kinds.{role}");
                let finding = Finding::new(&rules::OPERATION_PORT, subject, values);
                let finding = finding.at("frame kind", &value);
                self.report(finding.on(Senders::BOTH, Wire::Both));
                self.claim_in(&list, &[&value, "port"]);
            }
        }
        for kind in &old.reserved {
            if new.with_value(kind.value).is_none() {
                let value = kind.value.to_string();
                let subject = format!("frame.kinds.{value}");
                let named = ("frame kind", &value);
                self.report(Finding::alone(
                    &rules::KIND_VALUE,
                    true,
                    subject,
                    &kind.name,
                    named,
                ));
                self.claim_in(&list, &[&value]);
            }
        }
    }

    fn encodings(&mut self) {
        let (old, new) = (&self.old.frame, &self.new.frame);
        for (rule, removed, from, to) in [
            (&rules::ENCODING_REMOVED, true, old, new),
            (&rules::ENCODING_ADDED, false, new, old),
        ] {
            let is_kept = |one: &&Encoding| {
                let other = to.encoding(one.role);
                other.is_some_and(|it| it.value == one.value)
            };
            for encoding in from.encodings.iter().filter(|it| !is_kept(it)) {
                let value = encoding.value.to_string();
                let subject = format!("frame.encodings.{}", encoding.role.name());
                let finding = Finding::alone(rule, removed, subject, &value, ("encoding", &value));
                self.report(finding.on(Senders::BOTH, Wire::of(removed, !removed)));
                self.claim_item(&["protocol", "frame", "encodings"], &value);
            }
        }
    }

    fn limits(&mut self) {
        let (old, new) = (&self.old.limits, &self.new.limits);
        for (key, old, new) in [
            ("frame_bytes", old.frame_bytes, new.frame_bytes),
            ("inflated_bytes", old.inflated_bytes, new.inflated_bytes),
            ("json_depth", old.json_depth, new.json_depth),
        ] {
            let (rule, wire) = match new.cmp(&old) {
                std::cmp::Ordering::Less => (&rules::LIMIT_LOWERED, Wire::OldSender),
                std::cmp::Ordering::Greater => (&rules::LIMIT_RAISED, Wire::NewSender),
                std::cmp::Ordering::Equal => continue,
            };
            let values = [shown(Some(old)), shown(Some(new))];
            let finding = Finding::new(rule, format!("limits.{key}"), both(&values));
            self.report(finding.on(Senders::BOTH, wire).at("limits", "limits"));
            self.claim(&["protocol", "limits", key]);
        }
    }
}

/// Borrows both values.
pub(super) fn both(values: &[String; 2]) -> [&str; 2] {
    [&values[0], &values[1]]
}

/// Bytes in hex.
fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    pairs.join(" ")
}
