//! Groups and operations.

use super::body::Owner;
use super::text::{aliases, deprecation, own_changes, string, text, text_at};
use super::{Lowering, wire};
use crate::load::draft::{Place, Placed};
use crate::load::{names, scalar};
use crate::model::{
    Body, BodyField, BodyState, Code, Direction, Effect, Group, Kind, Lost, Operation, PortRole,
    Side, Subject, Text,
};
use crate::syntax::Node;
use crate::vocabulary::Word as _;

impl<'a> Lowering<'a, '_> {
    pub(super) fn group(&mut self, place: Place<'a>) {
        let node = place.node;
        let Some(id) = string(node, "id") else {
            return;
        };
        let item = Group {
            id,
            title: text(node),
            about: text_at(node, "about"),
            location: self.location(place.name()),
        };
        self.draft.groups.push(Placed { item, place });
    }

    pub(super) fn command(&mut self, place: Place<'a>) {
        let item = self.operation(place, Kind::Command);
        let mut operation = Placed { item, place };
        if let Some((effect, state)) = place.node.get("effect").and_then(effect) {
            operation.item.effect = Some(effect);
            operation.item.effect_state = Some(state);
        }
        operation.item.request = self.body(&operation, &COMMAND_REQUEST);
        operation.item.response = self.body(&operation, &COMMAND_RESPONSE);
        self.draft.operations.push(operation);
    }

    pub(super) fn report(&mut self, place: Place<'a>) {
        let item = self.operation(place, Kind::Report);
        let mut operation = Placed { item, place };
        operation.item.sender = Side::Robot;
        operation.item.ack = place.node.get("ack").map(wire::ack);
        operation.item.request = self.body(&operation, &REPORT_BODY);
        operation.item.response = self.body(&operation, &REPORT_ACK);
        self.draft.operations.push(operation);
    }

    pub(super) fn stream(&mut self, place: Place<'a>) {
        let mut item = self.operation(place, Kind::Stream);
        item.port = PortRole::Data;
        item.sender = wire::known(place.node, "from").unwrap_or(Side::App);
        self.draft.operations.push(Placed { item, place });
    }

    /// What all operations have in common; bodies are those of a stream.
    fn operation(&mut self, place: Place<'a>, kind: Kind) -> Operation {
        let node = place.node;
        let name = place.key.as_str().unwrap_or_default().to_owned();
        self.answers(node, &Subject::Operation(name.clone()));
        let sections = node.get("source").and_then(|source| source.get("sections"));
        let raw = Body {
            state: BodyState::Stated,
            ty: None,
            note: None,
        };
        let mut errors: Vec<_> = node
            .get("errors")
            .into_iter()
            .flat_map(Node::items)
            .filter_map(scalar::small_int)
            .collect();
        errors.sort_unstable();
        errors.dedup();
        let lost: Vec<_> = (node.get("source"))
            .map(|source| wire::all_known(source, "lost"))
            .unwrap_or_default();
        let is_kind_lost = lost.contains(&Lost::Type);
        Operation {
            name,
            kind,
            kind_state: if is_kind_lost {
                BodyState::Inferred
            } else {
                BodyState::Stated
            },
            sender: Side::App,
            code: code(node.get("code")),
            group: self.group.clone().unwrap_or_default(),
            title: text(node),
            aliases: aliases(node),
            about: text_at(node, "about"),
            effect: None,
            effect_state: None,
            port: PortRole::Command,
            sections: (sections.into_iter().flat_map(Node::items))
                .filter_map(scalar::small_int)
                .collect(),
            lost,
            since: string(node, "since"),
            deprecated: deprecation(node.get("deprecated")),
            changes: own_changes(node),
            request: raw.clone(),
            response: raw,
            ack: None,
            result_text: string(node, "result_text"),
            errors,
            location: self.location(place.name()),
        }
    }

    /// One side of an operation, and the type made for it.
    fn body(&mut self, operation: &Placed<'a, Operation>, side: &BodySide) -> Body {
        let Placed { item, place } = operation;
        let (state, note) = body_state(place.node.get(side.state_key));
        let entry = place.node.entry(side.key);
        let owner = Owner {
            type_name: format!(
                "{}{}",
                names::pascal(&names::snake(&item.name)),
                side.suffix
            ),
            body_of: Some(BodyField {
                operation: item.name.clone(),
                side: side.direction,
                path: Vec::new(),
            }),
        };
        let title = match (side.zh, side.en) {
            ("", "") => item.title.clone(),
            (zh, en) => Text {
                zh: format!("`{}` 的{zh}", item.name),
                en: format!("{en} of `{}`", item.name),
            },
        };
        let body_place = entry.map_or(*place, |entry| Place {
            key: entry.key,
            node: entry.value,
        });
        let fields = entry.map(|entry| entry.value.entries()).unwrap_or_default();
        let ty = self.made_struct(&owner, body_place, fields, title, state);
        Body {
            state,
            ty: Some(ty),
            note,
        }
    }
}

/// How one side of an operation is written and called.
struct BodySide {
    direction: Direction,
    /// Key of the body.
    key: &'static str,
    /// Key of its state.
    state_key: &'static str,
    /// What its type's name appends to the operation's.
    suffix: &'static str,
    /// What it is; empty for a report, which is called by its own title.
    zh: &'static str,
    en: &'static str,
}

const COMMAND_REQUEST: BodySide = BodySide {
    direction: Direction::Request,
    key: "request",
    state_key: "request_state",
    suffix: "Request",
    zh: "请求",
    en: "Request",
};

const COMMAND_RESPONSE: BodySide = BodySide {
    direction: Direction::Response,
    key: "response",
    state_key: "response_state",
    suffix: "Response",
    zh: "响应",
    en: "Response",
};

const REPORT_BODY: BodySide = BodySide {
    direction: Direction::Request,
    key: "body",
    state_key: "request_state",
    suffix: "",
    zh: "",
    en: "",
};

const REPORT_ACK: BodySide = BodySide {
    direction: Direction::Response,
    key: "response",
    state_key: "response_state",
    suffix: "Ack",
    zh: "确认",
    en: "Acknowledgement",
};

/// State and reason of `request_state:` or `response_state:`.
fn body_state(node: Option<Node<'_>>) -> (BodyState, Option<Text>) {
    let Some(node) = node else {
        return (BodyState::Stated, None);
    };
    let word = node.get("state").unwrap_or(node).as_str();
    let state = word.and_then(BodyState::named).unwrap_or(BodyState::Stated);
    (state, node.as_mapping().map(|_| text(node)))
}

/// An effect and how sure it is; `None` for what is none, which has been reported.
fn effect(node: Node<'_>) -> Option<(Effect, BodyState)> {
    let effect = Effect::named(node.get("value").unwrap_or(node).as_str()?)?;
    let state = match effect {
        Effect::Unknown => BodyState::Open,
        _ => fact_state(node),
    };
    Some((effect, state))
}

/// The `state` beside a `value`; what stands alone is stated.
fn fact_state(node: Node<'_>) -> BodyState {
    wire::known(node, "state").unwrap_or(BodyState::Stated)
}

/// `unassigned` for what is no code, which has been reported.
fn code(node: Option<Node<'_>>) -> Code {
    let value = node.map(|node| node.get("value").unwrap_or(node));
    match value.and_then(|value| Some((scalar::code(value)?, value.as_str()?))) {
        Some((code, spelling)) => Code {
            value: Some(code),
            spelling: spelling.to_owned(),
            state: node.map_or(BodyState::Stated, fact_state),
        },
        None => Code {
            value: None,
            spelling: "unassigned".to_owned(),
            state: BodyState::Open,
        },
    }
}
