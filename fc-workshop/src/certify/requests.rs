//! Requests and their responses.

use super::line::{Evidence, Line, Next, Step, Stop, deviates, example, gzip, shown};
use super::robot::Stage;
use crate::facts;
use fc_reflect::{FrameId, Packing};
use fc_spec::model::{Operation, ResultRole, Type, Value};
use fc_spec::text;

/// The number of requests that are sent together.
const TOGETHER: u32 = 4;

/// Calls a command with its example. Returns `true` for a success.
pub(super) async fn call(
    stage: &Stage<'_, '_>,
    command: &Operation,
    evidence: &mut Evidence,
) -> Step<bool> {
    let mut line = stage.connect(evidence).await?;
    let (id, message) = example(stage.reflector, command, 1).ok_or_else(none)?;
    line.send(&stage.plain(id, &message)?).await;
    Ok(line.response(id).await?.is_success())
}

fn none() -> Stop {
    Stop::Skip(text!("没有可以发送的请求", "there is no request to send"))
}

pub(super) async fn ids(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut line = stage.connect(evidence).await?;
    for id in [0, 1, facts::rules(stage.model()).id_max] {
        stage.ask(&mut line, id).await?;
    }
    Ok(())
}

pub(super) async fn split(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, frame) = stage.frame(1)?;
    let mut line = stage.connect(evidence).await?;
    for byte in &frame {
        line.send(&[*byte]).await;
        tokio::task::yield_now().await;
    }
    line.response(id).await.map(|_| ())
}

pub(super) async fn pipelined(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut frames = Vec::new();
    let mut open = Vec::new();
    for number in 1..=TOGETHER {
        let (id, frame) = stage.frame(number)?;
        frames.extend(frame);
        open.push(id.answer());
    }
    let mut line = stage.connect(evidence).await?;
    line.send(&frames).await;
    while !open.is_empty() {
        let frame = answer(&mut line, stage).await?;
        let place = open.iter().position(|id| *id == frame);
        let Some(place) = place else {
            return deviates(text!(
                "多出一个响应：{found}",
                "one response too many: {found}",
                found = shown(frame)
            ));
        };
        open.remove(place);
    }
    // A second response to the last request would come now, before that to the next.
    stage.ask(&mut line, TOGETHER + 1).await
}

/// Returns the id of the next frame.
async fn answer(line: &mut Line<'_, '_>, stage: &Stage<'_, '_>) -> Step<FrameId> {
    match line.next(facts::call_timeout(stage.model())).await? {
        Next::Frame(frame) => Ok(frame.id),
        Next::Closed => deviates(text!("设备断开了连接", "the device closed the connection")),
        Next::Silence => deviates(text!(
            "不是每个请求都得到响应",
            "not every request gets a response"
        )),
    }
}

pub(super) async fn compressed(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    gzip(stage.model())?;
    let (id, message) = stage.probe(1)?;
    // Spaces make the data worth compressing.
    let data = message.to_string() + &" ".repeat(200);
    let frame = stage.seal(id, data.as_bytes(), Packing::Gzip { level: 6 })?;
    let mut line = stage.connect(evidence).await?;
    line.send(&frame).await;
    line.response(id).await.map(|_| ())
}

pub(super) async fn unknown_key(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, mut message) = stage.probe(1)?;
    message.set("fcprotoUnknownKey", Value::Bool(true));
    let mut line = stage.connect(evidence).await?;
    line.send(&stage.plain(id, &message)?).await;
    if line.response(id).await?.is_success() {
        return Ok(());
    }
    deviates(text!(
        "带未知的键的请求被拒绝",
        "the request with an unknown key was refused"
    ))
}

/// Returns a command that may be sent, its example, and the wire key of a required field in its body.
fn with_required<'m>(stage: &Stage<'_, 'm>) -> Step<(FrameId, Value, &'m str)> {
    let model = stage.model();
    for command in &stage.commands {
        let Some(body) = command.body(fc_reflect::Direction::Request) else {
            continue;
        };
        let shape = model.types.structure(&body.ty);
        let mut required = shape.fields.iter().filter(|field| !field.optional);
        let Some(field) = required.find(|field| !matches!(field.ty, Type::Json)) else {
            continue;
        };
        if let Some((id, message)) = example(stage.reflector, command, 1) {
            return Ok((id, message, &field.wire));
        }
    }
    Err(Stop::Skip(text!(
        "可以发送的指令都没有必需的键",
        "no command that may be sent has a required key"
    )))
}

pub(super) async fn missing_key(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, mut message, key) = with_required(stage)?;
    if let Value::Object(entries) = &mut message {
        entries.retain(|(name, _)| name != key);
    }
    let frame = stage.plain(id, &message)?;
    refused(stage, evidence, id, &frame, ResultRole::Invalid).await
}

pub(super) async fn wrong_type(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, mut message, key) = with_required(stage)?;
    // No required field takes a list of lists of bools.
    let inner = Value::Array(vec![Value::Array(vec![Value::Bool(true)])]);
    message.set(key, Value::Array(vec![inner]));
    let frame = stage.plain(id, &message)?;
    refused(stage, evidence, id, &frame, ResultRole::Invalid).await
}

pub(super) async fn bad_json(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, _) = stage.probe(1)?;
    let frame = stage.seal(id, b"{\"no json", Packing::Plain)?;
    refused(stage, evidence, id, &frame, ResultRole::Invalid).await
}

/// Sends a frame that must be refused with a result. The connection must stay. In a protocol without results, there is no
/// response.
pub(super) async fn refused(
    stage: &Stage<'_, '_>,
    evidence: &mut Evidence,
    id: FrameId,
    frame: &[u8],
    role: ResultRole,
) -> Step {
    let model = stage.model();
    let mut line = stage.connect(evidence).await?;
    line.send(frame).await;
    if model.envelope.result_code().is_some() {
        let outcome = line.response(id).await?;
        let found = outcome.known.and_then(|known| known.role);
        if let Some(expected) = facts::result(model, role).filter(|_| found != Some(role)) {
            let (code, found) = (expected.code, outcome.code.unwrap_or(0));
            return deviates(text!(
                "应为结果码 {code}，实际为 {found}",
                "expected the result {code}, found {found}"
            ));
        }
    }
    stage.ask(&mut line, 2).await
}

pub(super) async fn unknown_code(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let model = stage.model();
    let kind = model.frame.kinds.command.value;
    let is_free = |code: &u16| {
        model
            .operations
            .iter()
            .all(|it| it.code.value != Some(*code))
    };
    let code = (0xF000..=u16::MAX).find(is_free).ok_or_else(none)?;
    let id = FrameId {
        direction: fc_reflect::Direction::Request,
        kind,
        code,
        id: 1,
    };
    let frame = stage.seal(id, b"{}", Packing::Plain)?;
    refused(stage, evidence, id, &frame, ResultRole::Protocol).await
}

pub(super) async fn half_closed(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let (id, frame) = stage.frame(1)?;
    let mut line = stage.connect(evidence).await?;
    line.send(&frame).await;
    line.close_half().await;
    line.response(id).await.map(|_| ())
}

pub(super) async fn two_apps(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut line = stage.connect(evidence).await?;
    stage.ask(&mut line, 1).await?;
    stage.serves().await?;
    stage.ask(&mut line, 2).await
}
