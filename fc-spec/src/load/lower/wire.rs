//! What lies below the messages.

use super::Lowering;
use super::text::{aliases, string, text, text_at};
use crate::load::draft::{EnvelopeDraft, FrameDraft, Place, Placed};
use crate::load::{names, scalar};
use crate::model::{
    Ack, ByteOrder, CallDefaults, CodeRange, Conflict, Encoding, EncodingRole, EnvelopeField,
    EnvelopeRole, FrameKind, HeaderField, HeaderType, JsonRule, KindRole, Limits, Party, Port,
    PortRole, Protocol, RangeUse, ResultCode, RetainedSection, RetiredCode, Severity, Subject,
    Transport, Type,
};
use crate::syntax::Node;
use crate::vocabulary::Word;

/// Bytes of a list of integers.
pub(crate) fn head_bytes(node: Option<Node<'_>>) -> Vec<u8> {
    let items = node.into_iter().flat_map(Node::items);
    items.filter_map(scalar::small_int).collect()
}

fn number<T: TryFrom<i128> + Default>(node: Node<'_>, key: &str) -> T {
    node.get(key)
        .and_then(scalar::small_int)
        .unwrap_or_default()
}

fn word<'a>(node: Node<'a>, key: &str) -> &'a str {
    node.get(key).and_then(Node::as_str).unwrap_or_default()
}

/// The word of a closed set under a key.
pub(super) fn known<W: Word>(node: Node<'_>, key: &str) -> Option<W> {
    W::named(node.get(key)?.as_str()?)
}

/// The words of a closed set in the list under a key.
pub(super) fn all_known<W: Word>(node: Node<'_>, key: &str) -> Vec<W> {
    let items = node.get(key).into_iter().flat_map(Node::items);
    items.filter_map(|item| W::named(item.as_str()?)).collect()
}

fn places(node: Option<Node<'_>>) -> impl Iterator<Item = Place<'_>> {
    let entries = node.map(Node::entries).unwrap_or_default();
    entries.map(|entry| Place {
        key: entry.key,
        node: entry.value,
    })
}

/// Name of a wire name in code.
pub(super) fn code_name(wire: &str, node: Node<'_>) -> String {
    string(node, "name").unwrap_or_else(|| names::snake(wire))
}

impl<'a> Lowering<'a, '_> {
    pub(super) fn protocol(&mut self, place: Place<'a>) {
        let node = place.node;
        let party = |key: &str| {
            let party = node.get(key);
            Some(Party {
                title: text(party?),
                about: text_at(party?, "about")?,
            })
        };
        let (Some(robot), Some(app), Some(about)) =
            (party("robot"), party("app"), text_at(node, "about"))
        else {
            return;
        };
        let item = Protocol {
            id: word(node, "id").to_owned(),
            title: text(node),
            about,
            version: word(node, "version").to_owned(),
            robot,
            app,
        };
        self.draft.protocol = Some(Placed { item, place });
        self.answers(node, &Subject::Protocol);
    }

    pub(super) fn transport(&mut self, place: Place<'a>) {
        let node = place.node;
        let ports = places(node.get("ports")).filter_map(|port| {
            Some(Port {
                role: PortRole::named(port.key.as_str()?)?,
                number: number(port.node, "number"),
                text: text(port.node),
            })
        });
        let item = Transport {
            host: word(node, "host").to_owned(),
            ports: ports.collect(),
        };
        self.draft.transport = Some(Placed { item, place });
        self.answers(node, &Subject::Transport);
    }

    pub(super) fn frame(&mut self, place: Place<'a>) {
        let node = place.node;
        let heads = |key: &str| head_bytes(node.get("heads").and_then(|heads| heads.get(key)));
        let mut kinds: Vec<_> = places(node.get("kinds")).filter_map(frame_kind).collect();
        kinds.sort_by_key(|kind| kind.item.value);
        let mut encodings: Vec<_> = places(node.get("encodings")).filter_map(encoding).collect();
        encodings.sort_by_key(|encoding| encoding.item.value);
        let mut header = Vec::new();
        let mut offset = 0;
        for place in places(node.get("header")) {
            let field = self.header_field(place, offset);
            offset += field.item.ty.size();
            header.push(field);
        }
        self.draft.frame = Some(FrameDraft {
            place,
            byte_order: known(node, "byte_order").unwrap_or(ByteOrder::Big),
            header,
            request_head: heads("request"),
            response_head: heads("response"),
            kinds,
            encodings,
            data: text(node),
        });
        self.answers(node, &Subject::Frame(None));
    }

    fn header_field(&mut self, place: Place<'a>, offset: usize) -> Placed<'a, HeaderField> {
        let wire = place.key.as_str().unwrap_or_default().to_owned();
        let node = place.node;
        self.answers(node, &Subject::Frame(Some(wire.clone())));
        Placed {
            item: HeaderField {
                name: code_name(&wire, node),
                // No bytes at all for what is no header type, which a check reports.
                ty: (word(node, "type").parse()).unwrap_or(HeaderType::Bytes(0)),
                offset,
                role: known(node, "role"),
                value: number(node, "value"),
                quirks: all_known(node, "quirk"),
                text: text(node),
                aliases: aliases(node),
                wire,
            },
            place,
        }
    }

    pub(super) fn json(&mut self, place: Place<'a>) {
        let rules = JsonRule::ALL.iter();
        let said = rules.filter_map(|rule| Some((*rule, text_at(place.node, rule.name())?)));
        self.draft.json = Some(said.collect());
    }

    pub(super) fn envelope(&mut self, place: Place<'a>) {
        let mut side = |key: &str| {
            places(place.node.get(key))
                .filter_map(|field| self.envelope_field(field))
                .collect()
        };
        let envelope = EnvelopeDraft {
            place,
            request: side("request"),
            response: side("response"),
        };
        self.draft.envelope = Some(envelope);
        self.answers(place.node, &Subject::Envelope(None));
    }

    fn envelope_field(&mut self, place: Place<'a>) -> Option<Placed<'a, EnvelopeField>> {
        let wire = place.key.as_str()?.to_owned();
        let node = place.node;
        self.answers(node, &Subject::Envelope(Some(wire.clone())));
        let (ty, optional) = scalar::field_type(node.get("type")?)?;
        let item = EnvelopeField {
            name: code_name(&wire, node),
            ty,
            optional,
            role: known(node, "role")?,
            example: super::body::scalar_value(node.get("example")?)?,
            text: text(node),
            aliases: aliases(node),
            wire,
        };
        Some(Placed { item, place })
    }

    pub(super) fn results(&mut self, place: Place<'a>) {
        self.draft.results_place = Some(place);
        for place in places(Some(place.node)) {
            let node = place.node;
            let Some(code) = scalar::small_int(place.key) else {
                continue;
            };
            let title = text(node);
            let item = ResultCode {
                code,
                name: word(node, "name").to_owned(),
                role: known(node, "role"),
                about: text_at(node, "about").unwrap_or_else(|| title.clone()),
                text: title,
            };
            self.draft.results.push(Placed { item, place });
            self.answers(node, &Subject::Results(Some(code)));
        }
        self.draft.results.sort_by_key(|result| result.item.code);
    }

    pub(super) fn calls(&mut self, place: Place<'a>) {
        let node = place.node;
        let item = CallDefaults {
            timeout_ms: number(node, "timeout_ms"),
            handler_timeout_ms: number(node, "handler_timeout_ms"),
            max_age_ms: node.get("max_age_ms").and_then(scalar::small_int),
            // `ack:` may stand behind `calls:`; resolving puts it in.
            ack: ack(node),
        };
        self.draft.calls = Some(Placed { item, place });
        self.answers(node, &Subject::Protocol);
    }

    pub(super) fn default_ack(&mut self, place: Place<'a>) {
        self.draft.default_ack = Some(ack(place.node));
        self.answers(place.node, &Subject::Protocol);
    }

    pub(super) fn limits(&mut self, place: Place<'a>) {
        let node = place.node;
        let item = Limits {
            frame_bytes: number(node, "frame_bytes"),
            inflated_bytes: number(node, "inflated_bytes"),
            json_depth: number(node, "json_depth"),
            in_flight: number(node, "in_flight"),
            queued_reports: number(node, "queued_reports"),
            connections: number(node, "connections"),
        };
        self.draft.limits = Some(Placed { item, place });
    }

    pub(super) fn codes(&mut self, place: Place<'a>) {
        let items = |key: &str| place.node.get(key).into_iter().flat_map(Node::items);
        for node in items("ranges") {
            self.answers(node, &Subject::Codes);
            if let Some(item) = range(node) {
                let place = Place { key: node, node };
                self.draft.ranges.push(Placed { item, place });
            }
        }
        for node in items("retired") {
            if let Some(code) = node.get("code").and_then(scalar::code) {
                let item = RetiredCode {
                    code,
                    spelling: word(node, "code").to_owned(),
                    text: text(node),
                };
                let place = Place { key: node, node };
                self.draft.retired.push(Placed { item, place });
            }
        }
        self.draft.ranges.sort_by_key(|range| range.item.first);
        self.draft.retired.sort_by_key(|retired| retired.item.code);
        self.draft.codes_known = true;
        self.answers(place.node, &Subject::Codes);
    }

    pub(super) fn retained_section(&mut self, place: Place<'a>) {
        if let Some(section) = scalar::small_int(place.key) {
            let item = RetainedSection {
                section,
                text: text(place.node),
            };
            self.draft.sections.push(Placed { item, place });
            self.answers(place.node, &Subject::Section(section));
        }
    }

    pub(super) fn conflict(&mut self, place: Place<'a>) {
        let node = place.node;
        let item = Conflict {
            id: place.key.as_str().unwrap_or_default().to_owned(),
            category: word(node, "category").to_owned(),
            severity: known(node, "severity").unwrap_or(Severity::Low),
            text: text(node),
        };
        self.draft.conflicts.push(Placed { item, place });
    }
}

/// `{ timeout_ms, retries }`.
pub(super) fn ack(node: Node<'_>) -> Ack {
    Ack {
        timeout_ms: number(node, "timeout_ms"),
        retries: number(node, "retries"),
    }
}

fn frame_kind(place: Place<'_>) -> Option<Placed<'_, FrameKind>> {
    let node = place.node;
    let item = FrameKind {
        value: scalar::small_int(place.key)?,
        name: word(node, "name").to_owned(),
        role: known(node, "role").unwrap_or(KindRole::Reserved),
        port: known(node, "port").unwrap_or(PortRole::Command),
        text: text(node),
    };
    Some(Placed { item, place })
}

fn encoding(place: Place<'_>) -> Option<Placed<'_, Encoding>> {
    let node = place.node;
    let item = Encoding {
        value: scalar::small_int(place.key)?,
        name: word(node, "name").to_owned(),
        role: known(node, "role").unwrap_or(EncodingRole::Plain),
        text: text(node),
    };
    Some(Placed { item, place })
}

fn range(node: Node<'_>) -> Option<CodeRange> {
    Some(CodeRange {
        first: scalar::code(node.get("from")?)?,
        last: scalar::code(node.get("to")?)?,
        first_spelling: word(node, "from").to_owned(),
        last_spelling: word(node, "to").to_owned(),
        usage: known(node, "use").unwrap_or(RangeUse::Reserved),
        text: text(node),
    })
}

/// Whether an envelope field of this type can have this role.
pub(crate) fn envelope_type_fits(role: EnvelopeRole, ty: &Type) -> bool {
    match role {
        EnvelopeRole::Time => *ty == Type::TimestampMs,
        EnvelopeRole::ResultCode => matches!(ty, Type::Int(_)),
        EnvelopeRole::ResultText => *ty == Type::String,
    }
}
