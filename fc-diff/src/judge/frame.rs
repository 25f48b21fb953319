//! Frame and transport.

use super::{Judge, by, shown};
use crate::finding::{Finding, Senders};
use crate::rule::Wire;
use crate::rules::frame as rules;
use fc_spec::model::{HeaderField, KindRole};
use std::collections::BTreeMap;

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
        // A field is what it is used for; one without a use is its name.
        let key = |field: &HeaderField| {
            field
                .role
                .map_or_else(|| field.name.clone(), |it| it.name().to_owned())
        };
        let layout = |fields: &[HeaderField]| -> BTreeMap<String, (String, String)> {
            let shape = |it: &HeaderField| format!("{}@{}", it.ty, it.offset);
            fields
                .iter()
                .map(|it| (key(it), (it.wire.clone(), shape(it))))
                .collect()
        };
        let (fields, others) = (layout(&old.header), layout(&new.header));
        let mut keys: Vec<_> = fields.keys().chain(others.keys()).collect();
        keys.sort();
        keys.dedup();
        for key in keys {
            let (one, other) = (fields.get(key), others.get(key));
            let values =
                [one, other].map(|it| it.map(|(_, shape)| shape.as_str()).unwrap_or_default());
            let [from, to] = values;
            if from != to {
                let mut finding =
                    Finding::new(&rules::HEADER_LAYOUT, format!("frame.header.{key}"), values);
                if let Some((wire, _)) = one {
                    finding = finding.was("header field", wire);
                }
                if let Some((wire, _)) = other {
                    finding = finding.is("header field", wire);
                    self.claim(&["protocol", "frame", "header", wire, "type"]);
                    self.claim(&["protocol", "frame", "header", wire, "offset"]);
                    self.claim(&["protocol", "frame", "header", wire, "role"]);
                }
                self.claim(&["protocol", "frame", "header", "#order"]);
                for (wire, gone) in [(one, other.is_none()), (other, one.is_none())] {
                    if let (Some((wire, _)), true) = (wire, gone) {
                        self.claim(&["protocol", "frame", "header", wire]);
                    }
                }
                self.report(finding.on(Senders::BOTH, Wire::Both));
            }
        }
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
        let others = by(&new.header, |it| it.wire.as_str());
        for field in &old.header {
            let Some(other) = others.get(field.wire.as_str()) else {
                continue;
            };
            for quirk in field.quirks.iter().filter(|it| !other.quirks.contains(it)) {
                let subject = format!("frame.header.{}", key(field));
                let finding = Finding::new(
                    &crate::rules::results::QUIRK_REMOVED,
                    subject,
                    [quirk.name(), ""],
                );
                let finding = finding.at("header field", &field.wire);
                self.report(finding.on(Senders::BOTH, Wire::OldSender));
                self.claim(&["protocol", "frame", "header", &field.wire, "quirks"]);
            }
        }
    }

    fn kinds(&mut self) {
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
                self.claim(&["protocol", "frame", "kinds", &values[0]]);
                self.claim(&["protocol", "frame", "kinds", &values[1]]);
                self.claim(&["protocol", "frame", "kinds", "#order"]);
            }
            if old.reserved.iter().any(|it| it.value == other.value) {
                let subject = format!("frame.kinds.{}", other.value);
                let finding = Finding::new(
                    &rules::RESERVED_KIND,
                    subject,
                    [KindRole::Reserved.name(), role],
                );
                let finding = finding.at("frame kind", &values[1]);
                self.report(finding.on(Senders::BOTH, Wire::NewSender));
            }
            if one.port != other.port {
                let values = [one.port.name(), other.port.name()];
                let finding = Finding::new(
                    &rules::OPERATION_PORT,
                    format!("frame.kinds.{role}"),
                    values,
                );
                let finding = finding.at("frame kind", other.value.to_string());
                self.report(finding.on(Senders::BOTH, Wire::Both));
                self.claim(&[
                    "protocol",
                    "frame",
                    "kinds",
                    &other.value.to_string(),
                    "port",
                ]);
            }
        }
        for kind in &old.reserved {
            if new.with_value(kind.value).is_none() {
                let value = kind.value.to_string();
                let finding = Finding::new(
                    &rules::KIND_VALUE,
                    format!("frame.kinds.{value}"),
                    [&kind.name, ""],
                );
                self.report(finding.was("frame kind", &value));
                self.claim(&["protocol", "frame", "kinds", &value]);
            }
        }
    }

    fn encodings(&mut self) {
        let (old, new) = (&self.old.frame, &self.new.frame);
        for (rule, wire, from, to) in [
            (&rules::ENCODING_REMOVED, Wire::OldSender, old, new),
            (&rules::ENCODING_ADDED, Wire::NewSender, new, old),
        ] {
            for encoding in &from.encodings {
                if to
                    .encoding(encoding.role)
                    .is_none_or(|it| it.value != encoding.value)
                {
                    let value = encoding.value.to_string();
                    let role = encoding.role.name();
                    let values = if wire == Wire::OldSender {
                        [value.as_str(), ""]
                    } else {
                        ["", value.as_str()]
                    };
                    let finding = Finding::new(rule, format!("frame.encodings.{role}"), values);
                    let finding = if wire == Wire::OldSender {
                        finding.was("encoding", &value)
                    } else {
                        finding.is("encoding", &value)
                    };
                    self.report(finding.on(Senders::BOTH, wire));
                    self.claim(&["protocol", "frame", "encodings", &value]);
                    self.claim(&["protocol", "frame", "encodings", "#order"]);
                }
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

/// Both as texts.
pub(super) fn both(values: &[String; 2]) -> [&str; 2] {
    [&values[0], &values[1]]
}

/// Bytes in hex.
fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<_> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    pairs.join(" ")
}
