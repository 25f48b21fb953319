//! The page of one operation.

use super::needs::{self, AcceptedView, CadenceView};
use super::shared::{AnswerView, CodeView, Desk, HistoryItem};
use super::streams::{self, OwnStreams, StreamView};
use crate::emit::markdown::available::AvailableView;
use crate::emit::markdown::bytes::{FrameView, frame_view};
use crate::emit::markdown::commented::commented;
use crate::emit::markdown::enums::EnumView;
use crate::emit::markdown::links::{Anchor, Link, Page};
use crate::emit::markdown::places::Kept;
use crate::emit::markdown::rows::{DeprecationNote, Row};
use crate::emit::markdown::tabs::Tabs;
use crate::emit::markdown::words::{self, Word as _};
use crate::emit::packed;
use crate::sample::{Profile, SAMPLE_ID};
use fc_spec::model::Lang;
use fc_spec::model::{
    Ack, Answer, BodyState, Direction, Effect, EncodingRole, Exchange, Fact, HeaderRole, Kind,
    Operation, SetOff, Subject,
};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(in crate::emit::markdown) struct OperationView {
    name: String,
    title: String,
    aliases: Vec<String>,
    about: Option<String>,
    group: Link,
    /// `command`, `report`, `stream`.
    kind: &'static str,
    kind_word: &'static str,
    direction: String,
    code: CodeView,
    frame_kind: FrameKindView,
    /// The header field that pairs a response with its request.
    id_field: String,
    port: u16,
    /// `read`, `config`, `motion`, `unknown`.
    effect: Option<&'static str>,
    effect_word: Option<&'static str>,
    /// `true` if the effect is inferred. The page then says this before the effect.
    effect_inferred: bool,
    /// The store of the values that it reads and sets.
    kept: Option<Kept>,
    since: Option<String>,
    available: Option<AvailableView>,
    deprecated: Option<DeprecationNote>,
    facts: Vec<FactRow>,
    /// The conditions for accepting it.
    accepted: Option<AcceptedView>,
    /// The times at which it is sent.
    cadence: Option<CadenceView>,
    /// The reports that it triggers.
    followers: Vec<Follower>,
    /// The commands that trigger it.
    causes: Vec<Link>,
    /// The details of a stream.
    stream: Option<StreamView>,
    /// The streams that a command starts or stops.
    streams: Option<OwnStreams>,
    stage: StageView,
    sides: Vec<SideView>,
    enums: Vec<EnumView>,
    results: Vec<ResultLine>,
    ack: Option<AckView>,
    /// The code samples in each language.
    samples: Option<Tabs>,
    history: Vec<HistoryItem>,
    answers: Vec<AnswerView>,
    sections: Vec<u16>,
    lost: Vec<&'static str>,
    see: PageLinks,
    spec: Link,
}

/// A report in the diagram of a command.
#[derive(Debug, Serialize)]
struct Follower {
    code: String,
    name: String,
    link: Link,
    /// The keys that connect it to the command; empty if none do.
    ties: Vec<TieView>,
}

/// A key of a command and the key of a report with the same value.
#[derive(Debug, Serialize)]
struct TieView {
    /// `request`, `response`.
    side: &'static str,
    command: String,
    report: String,
}

/// The keys of a report for the progress of a process and its failures.
#[derive(Debug, Default, Serialize)]
struct StageView {
    state: Option<String>,
    failures: Vec<String>,
}

/// The value of the kind field.
#[derive(Debug, Serialize)]
struct FrameKindView {
    field: String,
    value: String,
    name: String,
}

/// The certainty of the type, the code, the effect or a body.
#[derive(Debug, Serialize)]
struct FactRow {
    what: &'static str,
    state: &'static str,
    /// `stated`, `inferred`, `open`.
    key: &'static str,
    note: Option<String>,
    /// `true` if another badge shows it already.
    badged: bool,
}

#[derive(Debug, Serialize)]
struct SideView {
    /// `request`, `response`; also the anchor.
    side: &'static str,
    open: bool,
    free: bool,
    rows: Vec<Row>,
    json: Option<String>,
    frame: Option<FrameView>,
}

#[derive(Debug, Serialize)]
struct ResultLine {
    code: i64,
    href: String,
    name: String,
    text: String,
    about: String,
    /// The meaning for this operation.
    cause: Option<String>,
    /// `true` if the operation declares it. The others are results that any operation can return.
    own: bool,
}

#[derive(Debug, Serialize)]
struct AckView {
    timeout_ms: u32,
    retries: u32,
    attempts: u32,
    is_default: bool,
}

#[derive(Debug, Serialize)]
struct PageLinks {
    wire: String,
    envelope: String,
    index: String,
    codes: String,
    open_questions: String,
    other_language: String,
}

pub(in crate::emit::markdown) fn operation<'m>(
    desk: Desk<'_, 'm>,
    operation: &'m Operation,
) -> OperationView {
    let model = desk.book.model;
    let lang = desk.lang;
    let group = model.group(&operation.group);
    let kind = model.frame.kinds.of(operation.kind());
    let sides: Vec<SideView> = operation
        .directions()
        .iter()
        .map(|direction| side(desk, operation, *direction))
        .collect();
    OperationView {
        name: operation.name.clone(),
        title: lang.text(&operation.title).to_owned(),
        aliases: lang.aliases(&operation.aliases),
        about: operation.about.as_ref().map(|about| desk.sentence(about)),
        group: Link {
            text: group
                .map_or(operation.group.as_str(), |group| lang.text(&group.title))
                .to_owned(),
            href: desk.link(Page::Index, Anchor::of("group", &operation.group)),
        },
        kind: operation.kind().name(),
        kind_word: operation.kind().word(lang),
        direction: words::direction(
            operation.sender,
            lang.text(&model.protocol.robot.title),
            lang.text(&model.protocol.app.title),
        ),
        code: CodeView::new(&operation.code),
        frame_kind: FrameKindView {
            field: header_field(desk, HeaderRole::Kind),
            value: format!("0x{:02X}", kind.value),
            name: kind.name.clone(),
        },
        id_field: header_field(desk, HeaderRole::Id),
        port: model.transport.ports.get(operation.port).number,
        effect: operation.effect().map(Effect::name),
        effect_word: operation.effect().map(|effect| effect.word(lang)),
        effect_inferred: operation.effect_state() == Some(BodyState::Inferred),
        kept: operation.kept.as_deref().map(|name| desk.rows().kept(name)),
        since: operation.since.clone(),
        available: AvailableView::of(model, operation.available.as_ref(), lang),
        deprecated: operation
            .deprecated
            .as_ref()
            .map(|note| desk.rows().deprecation(note)),
        facts: facts(desk, operation),
        accepted: operation
            .accepted()
            .map(|accepted| needs::accepted(desk, accepted)),
        cadence: needs::cadence(operation, sides.iter().flat_map(|side| &side.rows)),
        followers: followers(desk, operation),
        causes: model
            .commands_that_set_off(operation)
            .map(|command| desk.operation(command))
            .collect(),
        stream: streams::stream(desk, operation),
        streams: streams::of_command(desk, operation),
        stage: stage(operation),
        sides,
        enums: desk.rows().enums(operation),
        results: results(desk, operation),
        ack: ack(operation, model.calls.ack),
        samples: desk.book.tabs(operation).cloned(),
        history: history(desk, operation),
        answers: desk.answers(answers(desk, operation)),
        sections: operation.sections.clone(),
        lost: lost(desk, operation),
        see: PageLinks {
            wire: desk.link(Page::Wire, Anchor::named("frame")),
            envelope: desk.link(Page::Wire, Anchor::named("envelope")),
            index: desk.link(Page::Index, Anchor::none()),
            codes: desk.link(Page::Codes, Anchor::none()),
            open_questions: desk.link(Page::OpenQuestions, Anchor::none()),
            other_language: desk.page.link_to_other(lang),
        },
        spec: desk.spec(&operation.location),
    }
}

/// Returns the wire name of the header field with a role.
fn header_field(desk: Desk<'_, '_>, role: HeaderRole) -> String {
    let field = desk.book.model.frame.field(role);
    field.map_or_else(String::new, |field| field.wire.clone())
}

fn facts(desk: Desk<'_, '_>, operation: &Operation) -> Vec<FactRow> {
    let lang = desk.lang;
    let row = |fact, what, note: Option<String>| {
        let state = operation.fact_state(fact)?;
        Some(FactRow {
            what,
            state: state.word(lang),
            key: state.word(Lang::En),
            note: note.or_else(|| confirmed(desk, operation, fact)),
            badged: false,
        })
    };
    let effect = (operation.effect() == Some(Effect::Unknown)).then(|| {
        lang.pick(
            "源文档没有写明它对机器人的影响",
            "The source does not state its effect on the robot",
        )
        .to_owned()
    });
    let body = |direction| {
        let body = operation.body(direction);
        let note = body.and_then(|body| body.note.as_ref());
        note.map(|note| desk.sentence(note))
    };
    let side = |direction| words::body(operation.kind(), direction, lang);
    let badged = effect.is_some();
    let rows = [
        row(
            Fact::Type,
            lang.pick("类型", "type"),
            kind_note(desk, operation),
        ),
        row(Fact::Code, lang.pick("功能码", "code"), None),
        row(Fact::Effect, lang.pick("影响", "effect"), effect).map(|row| FactRow { badged, ..row }),
        row(
            Fact::Request,
            side(Direction::Request),
            body(Direction::Request),
        ),
        row(
            Fact::Response,
            side(Direction::Response),
            body(Direction::Response),
        ),
    ];
    let mut facts: Vec<FactRow> = rows.into_iter().flatten().collect();
    if !operation.is_from_source() {
        facts.retain(|fact| fact.key != BodyState::Stated.word(Lang::En));
    }
    facts
}

/// Returns the confirmation of a fact that the source lacks.
fn confirmed(desk: Desk<'_, '_>, operation: &Operation, fact: Fact) -> Option<String> {
    let mut answers = desk.book.model.answers.iter();
    let answer = answers.find(|answer| {
        matches!(&answer.subject, Subject::Operation(name) if *name == operation.name)
            && answer.confirmed.is_some()
            && answer
                .about
                .iter()
                .any(|governed| governed.path == fact.name())
    })?;
    let word = answer.confirmed.as_ref()?;
    Some(words::confirmed(word, desk.lang))
}

/// Returns a note about a type that the source does not print.
fn kind_note(desk: Desk<'_, '_>, operation: &Operation) -> Option<String> {
    if operation.kind_state != BodyState::Inferred {
        return None;
    }
    let value = desk.book.model.frame.kinds.of(operation.kind()).value;
    Some(match desk.lang {
        Lang::Zh => format!(
            "源文档没有给出；{}的类型都是 0x{value:02X}",
            operation.kind().word(Lang::Zh)
        ),
        Lang::En => format!(
            "Not printed in the source; every {} has 0x{value:02X}",
            operation.kind().word(Lang::En)
        ),
    })
}

fn side(desk: Desk<'_, '_>, operation: &Operation, direction: Direction) -> SideView {
    let body = operation.body(direction);
    let json = body.map(|_| {
        desk.book
            .samples
            .message(operation, direction, Profile::Example)
    });
    let reflector = &desk.book.reflector;
    let frame = |id| {
        let data = desk.book.samples.data(operation, direction);
        let frame = packed::frame(reflector, id, EncodingRole::Plain, &data);
        frame_view(reflector, &frame, desk.lang)
    };
    let rows = body.map_or_else(Vec::new, |body| match operation.kind() {
        // A stream has no envelope.
        Kind::Stream => {
            let ty = desk.book.model.types.get(&body.ty);
            desk.rows().of_type(ty, Anchor::named(direction.name()))
        }
        Kind::Command | Kind::Report => desk.rows().message(direction, &body.ty),
    });
    SideView {
        side: direction.name(),
        open: body.is_some_and(|body| body.state == BodyState::Open),
        free: body.is_some_and(|body| body.state == BodyState::Free),
        json: json.map(|json| commented(&json, &rows)),
        rows,
        frame: reflector
            .id(operation, direction, SAMPLE_ID)
            .and_then(frame),
    }
}

/// Returns the reports that a command triggers.
fn followers(desk: Desk<'_, '_>, operation: &Operation) -> Vec<Follower> {
    let all = operation.sets_off().iter();
    let follower = |set_off: &SetOff| {
        let report = desk.book.operation(&set_off.report)?;
        let ties = set_off.tied.iter().map(|tie| TieView {
            side: tie.side.name(),
            command: tie.command.join("."),
            report: tie.report.join("."),
        });
        Some(Follower {
            code: report.code.spelling.clone(),
            name: report.name.clone(),
            link: desk.operation(report),
            ties: ties.collect(),
        })
    };
    all.filter_map(follower).collect()
}

/// Returns the keys of a report for the progress of a process.
fn stage(operation: &Operation) -> StageView {
    let Exchange::Report {
        state, failures, ..
    } = &operation.exchange
    else {
        return StageView::default();
    };
    StageView {
        state: state.as_ref().map(|keys| keys.join(".")),
        failures: failures.iter().map(|keys| keys.join(".")).collect(),
    }
}

/// Returns success, the results of the runtime and the operation's own results. Returns none if responses carry no
/// result.
fn results(desk: Desk<'_, '_>, operation: &Operation) -> Vec<ResultLine> {
    let is_sent = desk.book.model.envelope.result_code().is_some();
    if operation.kind() == Kind::Stream || !is_sent {
        return Vec::new();
    }
    let lang = desk.lang;
    let results = desk.book.model.results.iter();
    let lines = results.filter_map(|result| {
        let own = operation.error(result.code);
        (own.is_some() || result.role.is_some()).then(|| ResultLine {
            code: result.code,
            href: desk.link(
                Page::Results,
                Anchor::of("result", &result.code.to_string()),
            ),
            name: result.name.clone(),
            text: lang.text(&result.text).to_owned(),
            about: lang.text(&result.about).to_owned(),
            cause: own
                .and_then(|error| error.cause.as_ref())
                .map(|cause| desk.sentence(cause)),
            own: own.is_some(),
        })
    });
    lines.collect()
}

fn ack(operation: &Operation, default: Ack) -> Option<AckView> {
    let Exchange::Report { ack, .. } = operation.exchange else {
        return None;
    };
    Some(AckView {
        timeout_ms: ack.timeout_ms,
        retries: ack.retries,
        attempts: ack.retries.saturating_add(1),
        is_default: ack == default,
    })
}

/// Returns the changes of the operation and of the types of its bodies, oldest first.
fn history(desk: Desk<'_, '_>, operation: &Operation) -> Vec<HistoryItem> {
    let types = desk.book.body_types(operation).iter();
    let changes = operation.changes.iter();
    let mut items = desk.history(changes.chain(types.flat_map(|ty| &ty.changes)));
    items.sort_by(|a, b| a.date.cmp(&b.date));
    items
}

/// Returns the answers to the operation, its bodies and their fields.
fn answers<'m>(desk: Desk<'_, 'm>, operation: &Operation) -> Vec<&'m Answer> {
    let subject = Subject::Operation(operation.name.clone());
    let mut answers = desk.book.answers_to(&subject).to_vec();
    for ty in desk.book.body_types(operation) {
        answers.extend(desk.book.answers_in_type(ty));
    }
    answers
}

/// Returns the parts that the source lacks, by their names in the spec.
fn lost(desk: Desk<'_, '_>, operation: &Operation) -> Vec<&'static str> {
    let word = |part: &Fact| match part {
        Fact::Title => desk.lang.pick("标题", "title"),
        Fact::Type => desk.lang.pick("类型", "type"),
        Fact::Code => desk.lang.pick("功能码", "code"),
        Fact::Effect => desk.lang.pick("影响", "effect"),
        Fact::Request => words::side(operation.kind(), Direction::Request, desk.lang),
        Fact::Response => words::side(operation.kind(), Direction::Response, desk.lang),
    };
    operation.lost.iter().map(word).collect()
}
