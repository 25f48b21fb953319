//! Lowers the sections below the messages.

use super::Lowering;
use super::text::aliases;
use crate::language::grammar::{
    ACK, CALLS, CODES, COMMON, CONFLICT, DIGEST, ENCODING, ENVELOPE, ENVELOPE_FIELD, FRAME,
    FRAME_KIND, HEADER_FIELD, HEADS, LIMITS, PARTY, PORT, PROTOCOL, RANGE, RESULT, RETIRED,
    TRANSPORT, both_languages as text,
};
use crate::language::scalar;
use crate::load::draft::{EnvelopeDraft, FrameDraft, Origin, Sourced};
use crate::model::{
    Ack, ByteOrder, CallDefaults, CodeRange, Conflict, Encoding, EncodingRole, EnvelopeField,
    EnvelopeRole, FrameKind, HeaderField, HeaderRole, HeaderType, JsonRule, KindRole, Limits,
    MissingSection, Party, Port, PortRole, Ports, Protocol, RangeUse, ResultCode, RetiredCode,
    Severity, Subject, Transport, Type,
};
use crate::names;
use crate::syntax::{Entries, Node};
use crate::vocabulary::Word as _;

/// Returns the name in code of a wire name.
pub(super) fn code_name(wire: &str, node: Node<'_>) -> String {
    COMMON.name.read(node).unwrap_or_else(|| names::snake(wire))
}

impl<'a> Lowering<'a, '_> {
    pub(super) fn protocol(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let party = |node| {
            Some(Party {
                title: text(node),
                about: PARTY.about.read(node)?,
            })
        };
        let (Some(robot), Some(app), Some(about)) = (
            PROTOCOL.robot.of(node).and_then(party),
            PROTOCOL.app.of(node).and_then(party),
            PROTOCOL.about.read(node),
        ) else {
            return;
        };
        let item = Protocol {
            id: PROTOCOL.id.get(node),
            title: text(node),
            about,
            version: PROTOCOL.version.get(node),
            robot,
            app,
        };
        self.draft.protocol = Some(Sourced { item, origin });
        self.answers(node, &Subject::Protocol);
    }

    pub(super) fn transport(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let ports = TRANSPORT.ports.of(node).map(Node::entries);
        let ports = ports.into_iter().flatten().filter_map(|port| {
            Some(Port {
                role: PortRole::named(port.key.as_str()?)?,
                number: PORT.number.get(port.value),
                text: text(port.value),
            })
        });
        if let Ok(ports) = Ports::try_from(ports.collect::<Vec<_>>()) {
            let item = Transport {
                host: TRANSPORT.host.get(node),
                ports,
            };
            self.draft.transport = Some(Sourced { item, origin });
        }
        self.answers(node, &Subject::Transport);
    }

    pub(super) fn frame(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let heads = FRAME.heads.of(node);
        let kinds = FRAME.kinds.get(node).map(Origin::from);
        let mut kinds: Vec<_> = kinds.filter_map(frame_kind).collect();
        kinds.sort_by_key(|kind| kind.item.value);
        let encodings = FRAME.encodings.get(node).map(Origin::from);
        let mut encodings: Vec<_> = encodings.filter_map(encoding).collect();
        encodings.sort_by_key(|encoding| encoding.item.value);
        let mut header = Vec::new();
        let mut offset = 0;
        for origin in FRAME.header.get(node).map(Origin::from) {
            let field = self.header_field(origin, offset);
            offset += field.item.ty.size();
            header.push(field);
        }
        self.draft.frame = Some(FrameDraft {
            origin,
            byte_order: FRAME.byte_order.read(node).unwrap_or(ByteOrder::Big),
            header,
            request_head: HEADS.request.get(heads),
            response_head: HEADS.response.get(heads),
            kinds,
            encodings,
            data: text(node),
        });
        self.answers(node, &Subject::Frame(None));
    }

    fn header_field(&mut self, origin: Origin<'a>, offset: usize) -> Sourced<'a, HeaderField> {
        let wire = origin.key.as_str().unwrap_or_default().to_owned();
        let node = origin.node;
        self.answers(node, &Subject::Frame(Some(wire.clone())));
        let role = HEADER_FIELD.role.read(node);
        Sourced {
            item: HeaderField {
                name: code_name(&wire, node),
                // A malformed header type, which a check reports, has no bytes.
                ty: (HEADER_FIELD.r#type.read(node)).unwrap_or(HeaderType::Bytes(0)),
                offset,
                role,
                algorithm: (role == Some(HeaderRole::Digest))
                    .then(|| HEADER_FIELD.algorithm.read(node).unwrap_or(DIGEST)),
                value: HEADER_FIELD.value.get(node),
                quirks: HEADER_FIELD.quirk.get(node),
                text: text(node),
                aliases: aliases(node),
                wire,
            },
            origin,
        }
    }

    pub(super) fn json(&mut self, origin: Origin<'a>) {
        let rules = JsonRule::ALL.iter();
        let said = rules.filter_map(|rule| Some((*rule, text(origin.node.get(rule.name())?))));
        self.draft.plain.json = Some(said.collect());
    }

    pub(super) fn envelope(&mut self, origin: Origin<'a>) {
        let mut side = |fields: Entries<'a>| {
            let fields = fields.map(Origin::from);
            fields.filter_map(|it| self.envelope_field(it)).collect()
        };
        let envelope = EnvelopeDraft {
            origin,
            request: side(ENVELOPE.request.get(origin.node)),
            response: side(ENVELOPE.response.get(origin.node)),
        };
        self.draft.envelope = Some(envelope);
        self.answers(origin.node, &Subject::Envelope(None));
    }

    fn envelope_field(&mut self, origin: Origin<'a>) -> Option<Sourced<'a, EnvelopeField>> {
        let wire = origin.key.as_str()?.to_owned();
        let node = origin.node;
        self.answers(node, &Subject::Envelope(Some(wire.clone())));
        let (ty, optional) = ENVELOPE_FIELD.r#type.read(node)?;
        let item = EnvelopeField {
            name: code_name(&wire, node),
            ty,
            optional,
            role: ENVELOPE_FIELD.role.read(node)?,
            example: ENVELOPE_FIELD.example.read(node)?,
            text: text(node),
            aliases: aliases(node),
            wire,
        };
        Some(Sourced { item, origin })
    }

    pub(super) fn results(&mut self, origin: Origin<'a>) {
        for origin in origin.node.entries().map(Origin::from) {
            let node = origin.node;
            let Some(code) = scalar::small_int(origin.key) else {
                continue;
            };
            let title = text(node);
            let item = ResultCode {
                code,
                name: RESULT.name.get(node),
                role: RESULT.role.read(node),
                about: COMMON.about.read(node).unwrap_or_else(|| title.clone()),
                text: title,
            };
            self.draft.results.push(Sourced { item, origin });
            self.answers(node, &Subject::Results(Some(code)));
        }
        self.draft.results.sort_by_key(|result| result.item.code);
    }

    pub(super) fn calls(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let item = CallDefaults {
            timeout_ms: CALLS.timeout_ms.get(node),
            handler_timeout_ms: CALLS.handler_timeout_ms.get(node),
            max_age_ms: CALLS.max_age_ms.of(node).and_then(scalar::small_int),
            // `ack:` may follow `calls:`, so a later step sets this value.
            ack: ack(node),
        };
        self.draft.calls = Some(Sourced { item, origin });
        self.answers(node, &Subject::Protocol);
    }

    pub(super) fn default_ack(&mut self, origin: Origin<'a>) {
        self.draft.default_ack = Some(ack(origin.node));
        self.answers(origin.node, &Subject::Protocol);
    }

    pub(super) fn limits(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let item = Limits {
            frame_bytes: LIMITS.frame_bytes.get(node),
            inflated_bytes: LIMITS.inflated_bytes.get(node),
            json_depth: LIMITS.json_depth.get(node),
            in_flight: LIMITS.in_flight.get(node),
            queued_reports: LIMITS.queued_reports.get(node),
            connections: LIMITS.connections.get(node),
        };
        self.draft.limits = Some(Sourced { item, origin });
    }

    pub(super) fn codes(&mut self, origin: Origin<'a>) {
        for node in CODES.ranges.items(origin.node) {
            self.answers(node, &Subject::Codes);
            if let Some(item) = range(node) {
                let origin = Origin { key: node, node };
                self.draft.ranges.push(Sourced { item, origin });
            }
        }
        for node in CODES.retired.items(origin.node) {
            if let Some((code, spelling)) = RETIRED.code.read(node) {
                let item = RetiredCode {
                    code,
                    spelling,
                    text: text(node),
                };
                let origin = Origin { key: node, node };
                self.draft.retired.push(Sourced { item, origin });
            }
        }
        self.draft.ranges.sort_by_key(|range| range.item.first);
        self.draft.retired.sort_by_key(|retired| retired.item.code);
        self.answers(origin.node, &Subject::Codes);
    }

    pub(super) fn missing_section(&mut self, origin: Origin<'a>) {
        if let Some(section) = scalar::small_int(origin.key) {
            let item = MissingSection {
                section,
                text: text(origin.node),
            };
            self.draft.sections.push(Sourced { item, origin });
            self.answers(origin.node, &Subject::Section(section));
        }
    }

    pub(super) fn conflict(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let item = Conflict {
            id: origin.key.as_str().unwrap_or_default().to_owned(),
            category: CONFLICT.category.get(node),
            severity: CONFLICT.severity.read(node).unwrap_or(Severity::Low),
            text: text(node),
        };
        self.draft.conflicts.push(Sourced { item, origin });
    }
}

/// Lowers `{ timeout_ms, retries }`.
pub(super) fn ack(node: Node<'_>) -> Ack {
    Ack {
        timeout_ms: ACK.timeout_ms.get(node),
        retries: ACK.retries.get(node),
    }
}

fn frame_kind(origin: Origin<'_>) -> Option<Sourced<'_, FrameKind>> {
    let node = origin.node;
    let item = FrameKind {
        value: scalar::small_int(origin.key)?,
        name: FRAME_KIND.name.get(node),
        role: FRAME_KIND.role.read(node).unwrap_or(KindRole::Reserved),
        port: FRAME_KIND.port.read(node).unwrap_or(PortRole::Command),
        text: text(node),
    };
    Some(Sourced { item, origin })
}

fn encoding(origin: Origin<'_>) -> Option<Sourced<'_, Encoding>> {
    let node = origin.node;
    let item = Encoding {
        value: scalar::small_int(origin.key)?,
        name: ENCODING.name.get(node),
        role: ENCODING.role.read(node).unwrap_or(EncodingRole::Plain),
        text: text(node),
    };
    Some(Sourced { item, origin })
}

fn range(node: Node<'_>) -> Option<CodeRange> {
    let (first, first_spelling) = RANGE.from.read(node)?;
    let (last, last_spelling) = RANGE.to.read(node)?;
    Some(CodeRange {
        first,
        last,
        first_spelling,
        last_spelling,
        usage: RANGE.r#use.read(node).unwrap_or(RangeUse::Reserved),
        groups: RANGE.groups.get(node),
        text: text(node),
    })
}

/// Returns `true` if an envelope field of this type can have this role.
pub(crate) fn envelope_type_fits(role: EnvelopeRole, ty: &Type) -> bool {
    match role {
        EnvelopeRole::Time => *ty == Type::TimestampMs,
        EnvelopeRole::ResultCode => matches!(ty, Type::Int(_)),
        EnvelopeRole::ResultText => *ty == Type::String,
    }
}
