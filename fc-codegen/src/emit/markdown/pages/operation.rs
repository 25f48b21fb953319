//! The page of one operation.

use super::needs;
use super::shared::{Desk, code, list};
use super::streams;
use crate::emit::markdown::bytes::frame_view;
use crate::emit::markdown::commented::commented;
use crate::emit::markdown::links::{Anchor, Page};
use crate::emit::markdown::rows::Row;
use crate::emit::markdown::words::{self, Word as _};
use crate::emit::packed;
use crate::sample::{Profile, SAMPLE_ID};
use fc_spec::model::Lang;
use fc_spec::model::{
    Ack, Answer, BodyState, Direction, Effect, EncodingRole, Exchange, Fact, HeaderRole, Kind,
    Operation, SetOff, Subject,
};
use minijinja::value::Serde;
use minijinja::{Value, context};

pub(in crate::emit::markdown) fn operation<'m>(
    desk: Desk<'_, 'm>,
    operation: &'m Operation,
) -> Value {
    let model = desk.book.model;
    let lang = desk.lang;
    let group = model.group(&operation.group);
    let kind = model.frame.kinds.of(operation.kind());
    let directions = operation.directions().iter();
    let rows = directions.map(|direction| (*direction, rows(desk, operation, *direction)));
    let rows: Vec<(Direction, Vec<Row>)> = rows.collect();
    let cadence = needs::cadence(operation, rows.iter().flat_map(|(_, rows)| rows));
    let sides = rows.into_iter();
    let sides = sides.map(|(direction, rows)| side(desk, operation, direction, rows));
    let causes = model.commands_that_set_off(operation);
    let causes = causes.map(|command| desk.operation(command));
    context! {
        name => &operation.name,
        title => lang.text(&operation.title),
        aliases => lang.aliases(&operation.aliases),
        about => operation.about.as_ref().map(|about| desk.sentence(about)),
        group => desk.to(
            group.map_or(operation.group.as_str(), |group| lang.text(&group.title)),
            (Page::Index, Anchor::of("group", &operation.group)),
        ),
        kind => operation.kind().name(),
        kind_word => operation.kind().word(lang),
        direction => words::direction(
            operation.sender,
            lang.text(&model.protocol.robot.title),
            lang.text(&model.protocol.app.title),
        ),
        code => code(&operation.code),
        frame_kind => context! {
            field => header_field(desk, HeaderRole::Kind),
            value => format!("0x{:02X}", kind.value),
            name => &kind.name,
        },
        id_field => header_field(desk, HeaderRole::Id),
        port => model.transport.ports.get(operation.port).number,
        effect => operation.effect().map(Effect::name),
        effect_word => operation.effect().map(|effect| effect.word(lang)),
        effect_inferred => operation.effect_state() == Some(BodyState::Inferred),
        kept => operation.kept.as_deref().map(|name| desk.kept(name)),
        since => &operation.since,
        available => desk.available(operation.available.as_ref()),
        deprecated => operation
            .deprecated
            .as_ref()
            .map(|note| desk.deprecation(note)),
        facts => facts(desk, operation),
        accepted => operation
            .accepted()
            .map(|accepted| needs::accepted(desk, accepted)),
        cadence,
        followers => followers(desk, operation),
        causes => list(causes),
        stream => streams::stream(desk, operation),
        streams => streams::of_command(desk, operation),
        stage => stage(operation),
        sides => list(sides),
        enums => list(desk.enums(operation)),
        results => results(desk, operation),
        ack => ack(operation, model.calls.ack),
        samples => Serde(desk.book.tabs(operation)),
        history => history(desk, operation),
        answers => desk.answers(answers(desk, operation)),
        sections => &operation.sections,
        lost => lost(desk, operation),
        see => context! {
            wire => desk.link(Page::Wire, Anchor::named("frame")),
            envelope => desk.link(Page::Wire, Anchor::named("envelope")),
            index => desk.link(Page::Index, Anchor::none()),
            codes => desk.link(Page::Codes, Anchor::none()),
            open_questions => desk.link(Page::OpenQuestions, Anchor::none()),
            other_language => desk.page.link_to_other(lang),
        },
        spec => desk.spec(&operation.location),
    }
}

/// Returns the wire name of the header field with a role.
fn header_field(desk: Desk<'_, '_>, role: HeaderRole) -> String {
    let field = desk.book.model.frame.field(role);
    field.map_or_else(String::new, |field| field.wire.clone())
}

fn facts(desk: Desk<'_, '_>, operation: &Operation) -> Vec<Value> {
    let lang = desk.lang;
    let effect = (operation.effect() == Some(Effect::Unknown)).then(|| {
        lang.pick(
            "源文档没有写明它对机器人的影响",
            "The source does not state its effect on the robot",
        )
        .to_owned()
    });
    let row = |(fact, what, note): (Fact, &'static str, Option<String>)| {
        let state = operation.fact_state(fact)?;
        let is_shown = operation.is_from_source() || state != BodyState::Stated;
        is_shown.then(|| {
            context! {
                what,
                state => state.word(lang),
                // The class of its badge.
                key => state.word(Lang::En),
                // Another badge shows it already.
                badged => fact == Fact::Effect && note.is_some(),
                note => note.or_else(|| confirmed(desk, operation, fact)),
            }
        })
    };
    let body = |direction| {
        let body = operation.body(direction);
        let note = body.and_then(|body| body.note.as_ref());
        note.map(|note| desk.sentence(note))
    };
    let side = |direction| words::body(operation.kind(), direction, lang);
    let (request, response) = (Direction::Request, Direction::Response);
    let facts = [
        (
            Fact::Type,
            lang.pick("类型", "type"),
            kind_note(desk, operation),
        ),
        (Fact::Code, lang.pick("功能码", "code"), None),
        (Fact::Effect, lang.pick("影响", "effect"), effect),
        (Fact::Request, side(request), body(request)),
        (Fact::Response, side(response), body(response)),
    ];
    facts.into_iter().filter_map(row).collect()
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

/// Returns the rows of a message, or of a stream, which has no envelope.
fn rows(desk: Desk<'_, '_>, operation: &Operation, direction: Direction) -> Vec<Row> {
    let Some(body) = operation.body(direction) else {
        return Vec::new();
    };
    match operation.kind() {
        Kind::Stream => {
            let ty = desk.book.model.types.get(&body.ty);
            desk.type_rows(ty, Anchor::named(direction.name()))
        }
        Kind::Command | Kind::Report => desk.message_rows(direction, &body.ty),
    }
}

fn side(desk: Desk<'_, '_>, operation: &Operation, direction: Direction, rows: Vec<Row>) -> Value {
    let (samples, reflector) = (&desk.book.samples, &desk.book.reflector);
    let body = operation.body(direction);
    let json = body.map(|_| samples.message(operation, direction, Profile::Example));
    let frame = |id| {
        let data = samples.data(operation, direction);
        let frame = packed::frame(reflector, id, EncodingRole::Plain, &data);
        frame_view(reflector, &frame, desk.lang)
    };
    let id = reflector.id(operation, direction, SAMPLE_ID);
    context! {
        // Also the anchor.
        side => direction.name(),
        open => body.is_some_and(|body| body.state == BodyState::Open),
        free => body.is_some_and(|body| body.state == BodyState::Free),
        json => json.map(|json| commented(&json, &rows)),
        rows => Serde(rows),
        frame => id.and_then(frame),
    }
}

/// Returns the reports that a command triggers.
fn followers(desk: Desk<'_, '_>, operation: &Operation) -> Vec<Value> {
    let all = operation.sets_off().iter();
    let follower = |set_off: &SetOff| {
        let report = desk.book.operation(&set_off.report)?;
        let ties = set_off.tied.iter().map(|tie| {
            context! {
                side => tie.side.name(),
                command => tie.command.join("."),
                report => tie.report.join("."),
            }
        });
        Some(context! {
            code => &report.code.spelling,
            name => &report.name,
            link => desk.operation(report),
            ties => list(ties),
        })
    };
    all.filter_map(follower).collect()
}

/// Returns the keys of a report for the progress of a process.
fn stage(operation: &Operation) -> Value {
    let (state, failures) = match &operation.exchange {
        Exchange::Report {
            state, failures, ..
        } => (state.as_ref(), failures.as_slice()),
        _ => (None, &[][..]),
    };
    context! {
        state => state.map(|keys| keys.join(".")),
        failures => list(failures.iter().map(|keys| keys.join("."))),
    }
}

/// Returns success, the results of the runtime and the operation's own results. Returns none if responses carry no
/// result.
fn results(desk: Desk<'_, '_>, operation: &Operation) -> Vec<Value> {
    let is_sent = desk.book.model.envelope.result_code().is_some();
    if operation.kind() == Kind::Stream || !is_sent {
        return Vec::new();
    }
    let lang = desk.lang;
    let results = desk.book.model.results.iter();
    let lines = results.filter_map(|result| {
        let own = operation.error(result.code);
        (own.is_some() || result.role.is_some()).then(|| {
            context! {
                code => result.code,
                href => desk.link(
                    Page::Results,
                    Anchor::of("result", &result.code.to_string()),
                ),
                name => &result.name,
                text => lang.text(&result.text),
                about => lang.text(&result.about),
                cause => own
                    .and_then(|error| error.cause.as_ref())
                    .map(|cause| desk.sentence(cause)),
                own => own.is_some(),
            }
        })
    });
    lines.collect()
}

fn ack(operation: &Operation, default: Ack) -> Option<Value> {
    let Exchange::Report { ack, .. } = operation.exchange else {
        return None;
    };
    Some(context! {
        timeout_ms => ack.timeout_ms,
        retries => ack.retries,
        attempts => ack.retries.saturating_add(1),
        is_default => ack == default,
    })
}

/// Returns the changes of the operation and of the types of its bodies, oldest first.
fn history(desk: Desk<'_, '_>, operation: &Operation) -> Vec<Value> {
    let types = desk.book.body_types(operation).iter();
    let changes = operation.changes.iter();
    let mut changes: Vec<_> = changes.chain(types.flat_map(|ty| &ty.changes)).collect();
    changes.sort_by(|a, b| a.date.cmp(&b.date));
    desk.history(changes)
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
