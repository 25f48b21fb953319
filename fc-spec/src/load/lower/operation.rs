//! Lowers groups and operations.

use super::available::available;
use super::body::Owner;
use super::text::{aliases, deprecation, own_changes};
use super::{Lowering, needs, wire};
use crate::language::grammar::{
    BODY_STATE, BodyKey, CODE, COMMAND, COMMON, EFFECT, ERROR, GROUP, OPERATION, REPORT, SOURCE,
    STATED, STREAM, StateKey, both_languages as text,
};
use crate::load::draft::{Origin, Sourced};
use crate::load::process;
use crate::model::{
    Body, BodyField, BodyState, Code, Content, DeclaredError, Direction, Effect, Exchange, Fact,
    Group, Messages, Operation, PortRole, SetOff, Side, Stream, StructType, Subject, Text,
};
use crate::names;
use crate::syntax::Node;

impl<'a> Lowering<'a, '_> {
    pub(super) fn group(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let Some(id) = GROUP.id.read(node) else {
            return;
        };
        let item = Group {
            id,
            title: text(node),
            about: COMMON.about.read(node),
            location: self.location(origin.name()),
        };
        self.draft.groups.push(Sourced { item, origin });
    }

    pub(super) fn command(&mut self, origin: Origin<'a>) {
        let item = self.operation(origin);
        let mut operation = Sourced { item, origin };
        let effect = COMMAND.effect.of(origin.node).and_then(effect);
        let (effect, effect_state) = effect.unwrap_or((Effect::Unknown, BodyState::Open));
        operation.item.exchange = Exchange::Command {
            effect,
            effect_state,
            sets_off: sets_off(origin.node),
            accepted: COMMAND.accepted.of(origin.node).map(needs::accepted),
            messages: self.messages(&operation, [&COMMAND_REQUEST, &COMMAND_RESPONSE]),
        };
        self.draft.operations.push(operation);
    }

    pub(super) fn report(&mut self, origin: Origin<'a>) {
        let item = self.operation(origin);
        let mut operation = Sourced { item, origin };
        operation.item.sender = Side::Robot;
        operation.item.exchange = Exchange::Report {
            // A report without `ack` gets the default in a later step.
            ack: REPORT
                .ack
                .of(origin.node)
                .map(wire::ack)
                .unwrap_or_default(),
            cadence: REPORT.cadence.of(origin.node).and_then(needs::cadence),
            state: REPORT
                .state_in
                .read(origin.node)
                .map(|it| process::path(&it)),
            failures: Vec::new(),
            messages: self.messages(&operation, [&REPORT_BODY, &REPORT_ACK]),
        };
        self.draft.operations.push(operation);
    }

    pub(super) fn stream(&mut self, origin: Origin<'a>) {
        let item = self.operation(origin);
        let mut operation = Sourced { item, origin };
        operation.item.port = PortRole::Data;
        operation.item.sender = STREAM.from.read(origin.node).unwrap_or(Side::App);
        let content = match STREAM.body.of(origin.node) {
            Some(_) => Content::Json(self.body(&operation, &STREAM_BODY)),
            None => Content::Bytes(STREAM.content.read(origin.node)),
        };
        operation.item.exchange = Exchange::Stream(Stream {
            content,
            started_by: STREAM.started_by.read(origin.node),
            stopped_by: STREAM.stopped_by.read(origin.node),
        });
        self.draft.operations.push(operation);
    }

    /// Lowers the common keys of all operations. The result is a stream until the caller sets its exchange.
    fn operation(&mut self, origin: Origin<'a>) -> Operation {
        let node = origin.node;
        let name = origin.key.as_str().unwrap_or_default().to_owned();
        self.answers(node, &Subject::Operation(name.clone()));
        let source = OPERATION.source.of(node);
        let mut errors: Vec<_> = OPERATION.errors.items(node).filter_map(error).collect();
        errors.sort_by_key(|error| error.code);
        errors.dedup_by_key(|error| error.code);
        let lost = SOURCE.lost.get(source);
        // No other key of the file tells that a heading or a type byte is lost.
        let state = |fact| {
            if lost.contains(&fact) {
                BodyState::Inferred
            } else {
                BodyState::Stated
            }
        };
        Operation {
            name,
            kind_state: state(Fact::Type),
            title_state: state(Fact::Title),
            sender: Side::App,
            code: code(OPERATION.code.of(node)),
            group: self.group.clone().unwrap_or_default(),
            title: text(node),
            aliases: aliases(node),
            about: COMMON.about.read(node),
            port: PortRole::Command,
            sections: SOURCE.sections.get(source),
            lost,
            kept: COMMON.kept.read(node),
            since: COMMON.since.read(node),
            available: available(node),
            deprecated: deprecation(OPERATION.deprecated.of(node)),
            changes: own_changes(node),
            exchange: Exchange::Stream(Stream {
                content: Content::Bytes(None),
                started_by: None,
                stopped_by: None,
            }),
            result_text: OPERATION.result_text.read(node),
            errors,
            location: self.location(origin.name()),
        }
    }

    /// Lowers both sides of an operation and makes their types.
    fn messages(
        &mut self,
        operation: &Sourced<'a, Operation>,
        [request, response]: [&BodySide; 2],
    ) -> Messages {
        Messages {
            request: self.body(operation, request),
            response: self.body(operation, response),
        }
    }

    /// Lowers one side of an operation and makes its type.
    fn body(&mut self, operation: &Sourced<'a, Operation>, side: &BodySide) -> Body {
        let Sourced { item, origin } = operation;
        let (state, note) = body_state(side.state_key.of(origin.node));
        let entry = side.key.entry(origin.node);
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
            (zh, en) => self.draft.texts.limit(Text {
                zh: format!("`{}` 的{zh}", item.name),
                en: format!("{en} of `{}`", item.name),
            }),
        };
        let body_place = entry.map_or(*origin, Origin::from);
        let fields = entry.map(|entry| entry.value.entries()).unwrap_or_default();
        let shape = StructType::new(state, None);
        let ty = self.made_struct(&owner, body_place, fields, title, shape);
        Body { state, ty, note }
    }
}

/// The keys and names of one side of an operation.
struct BodySide {
    direction: Direction,
    /// Key of the body.
    key: BodyKey,
    /// Key of its state.
    state_key: StateKey,
    /// Suffix that its type name appends to the operation's.
    suffix: &'static str,
    /// Title of the side; empty for a report, which uses its own title.
    zh: &'static str,
    en: &'static str,
}

const COMMAND_REQUEST: BodySide = BodySide {
    direction: Direction::Request,
    key: COMMAND.request,
    state_key: OPERATION.request_state,
    suffix: "Request",
    zh: "请求",
    en: "Request",
};

const COMMAND_RESPONSE: BodySide = BodySide {
    direction: Direction::Response,
    key: COMMAND.response,
    state_key: OPERATION.response_state,
    suffix: "Response",
    zh: "响应",
    en: "Response",
};

const REPORT_BODY: BodySide = BodySide {
    direction: Direction::Request,
    key: REPORT.body,
    state_key: OPERATION.request_state,
    suffix: "",
    zh: "",
    en: "",
};

/// The frame of a stream. It has no state key, so its state is stated.
const STREAM_BODY: BodySide = BodySide {
    key: STREAM.body,
    ..REPORT_BODY
};

const REPORT_ACK: BodySide = BodySide {
    direction: Direction::Response,
    key: REPORT.response,
    state_key: OPERATION.response_state,
    suffix: "Ack",
    zh: "确认",
    en: "Acknowledgement",
};

/// Returns the reports that a command sets off, without repetitions. Repetitions have their own error.
fn sets_off(node: Node<'_>) -> Vec<SetOff> {
    let mut all: Vec<SetOff> = Vec::new();
    for set_off in COMMAND.sets_off.items(node).filter_map(process::set_off) {
        if all.iter().all(|known| known.report != set_off.report) {
            all.push(set_off);
        }
    }
    all
}

/// Returns state and reason of `request_state:` or `response_state:`.
fn body_state(node: Option<Node<'_>>) -> (BodyState, Option<Text>) {
    let Some(node) = node else {
        return (STATED, None);
    };
    let state = BODY_STATE.state.read_in_or_at(node).unwrap_or(STATED);
    (state, node.as_mapping().map(|_| text(node)))
}

/// Lowers a code with an optional cause; `None` for a malformed code, which has its own error.
fn error(node: Node<'_>) -> Option<DeclaredError> {
    Some(DeclaredError {
        code: ERROR.code.read_in_or_at(node)?,
        cause: node.as_mapping().map(|_| text(node)),
    })
}

/// Lowers an effect and its state; `None` for a malformed effect, which has its own error.
fn effect(node: Node<'_>) -> Option<(Effect, BodyState)> {
    let effect = EFFECT.value.read_in_or_at(node)?;
    let state = match effect {
        Effect::Unknown => BodyState::Open,
        _ => fact_state(node),
    };
    Some((effect, state))
}

/// Returns the `state` next to a `value`. A plain value is stated.
fn fact_state(node: Node<'_>) -> BodyState {
    CODE.state.read(node).unwrap_or(STATED)
}

/// Lowers a code. A malformed code, which has its own error, becomes `unassigned`.
fn code(node: Option<Node<'_>>) -> Code {
    match node.and_then(|node| CODE.value.read_in_or_at(node)) {
        Some((code, spelling)) => Code {
            value: Some(code),
            spelling,
            state: node.map_or(BodyState::Stated, fact_state),
        },
        None => Code {
            value: None,
            spelling: "unassigned".to_owned(),
            state: BodyState::Open,
        },
    }
}
