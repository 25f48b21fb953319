//! Reports of a robot, and their repetition.

use super::line::{Evidence, Line, Next, Step, Stop, deviates, example, shown};
use super::robot::Stage;
use crate::facts;
use fc_reflect::{Direction, Frame};
use fc_spec::model::{Ack, Exchange, KindRole, Operation};
use fc_spec::text;
use std::time::{Duration, Instant};

/// Returns the first report of a new connection, which is not acknowledged. A command that sets one off is sent, too.
async fn first_report<'m>(stage: &Stage<'_, 'm>, line: &mut Line<'_, 'm>) -> Step<Box<Frame<'m>>> {
    line.stop_acknowledging();
    let (_, frame) = stage.frame(1)?;
    line.send(&frame).await;
    let mut causes = stage.commands.iter().filter(|it| !it.sets_off().is_empty());
    if let Some(command) = causes.next()
        && let Some((id, message)) = example(stage.reflector, command, 2)
    {
        line.send(&stage.plain(id, &message)?).await;
    }
    let wait = facts::call_timeout(stage.model());
    loop {
        match line.next(wait).await? {
            Next::Frame(frame) if is_report(&frame) => return Ok(frame),
            Next::Frame(_) => {}
            Next::Closed | Next::Silence => {
                return Err(Stop::Skip(text!(
                    "设备没有上报",
                    "the device has sent no report"
                )));
            }
        }
    }
}

fn is_report(frame: &Frame<'_>) -> bool {
    frame.kind.role == KindRole::Report && frame.id.direction == Direction::Request
}

pub(super) async fn valid(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut line = stage.connect(evidence).await?;
    let mut frame = first_report(stage, &mut line).await?;
    loop {
        let operation = frame.operation;
        let message = (stage.reflector).message(operation, Direction::Request, &frame.data);
        if let Err(error) = message.and_then(|message| message.canonical()) {
            return deviates(text!(
                "上报 {report} 不合规范：{error}",
                "the report {report} breaks the spec: {error}",
                report = shown(frame.id),
                error = error.to_string()
            ));
        }
        line.acknowledge(&frame).await;
        match line.next(wait(policy(stage, operation))).await? {
            Next::Frame(next) if is_report(&next) => frame = next,
            _ => return Ok(()),
        }
    }
}

/// Returns the time in which the repetition of a report must come.
fn wait(policy: Ack) -> Duration {
    2 * Duration::from_millis(policy.timeout_ms.into())
}

/// Returns the policy of a report.
fn policy(stage: &Stage<'_, '_>, report: Option<&Operation>) -> Ack {
    match report.map(|report| &report.exchange) {
        Some(Exchange::Report { ack, .. }) => *ack,
        _ => stage.model().calls.ack,
    }
}

pub(super) async fn repeated(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut line = stage.connect(evidence).await?;
    let first = first_report(stage, &mut line).await?;
    let policy = policy(stage, first.operation);
    let wait = wait(policy);
    let mut times = 0;
    let mut end = Instant::now() + wait;
    while let Some(left) = end.checked_duration_since(Instant::now()) {
        match line.next(left).await? {
            Next::Frame(frame) if is_report(&frame) && frame.id == first.id => {
                if frame.data != first.data {
                    return deviates(text!("重发的上报内容不同", "the repetition has other data"));
                }
                times += 1;
                end = Instant::now() + wait;
            }
            Next::Frame(frame) if is_report(&frame) => line.acknowledge(&frame).await,
            Next::Frame(_) => {}
            Next::Closed | Next::Silence => break,
        }
        if times > policy.retries {
            break;
        }
    }
    let retries = policy.retries;
    if times == retries {
        return Ok(());
    }
    deviates(text!(
        "应重发 {retries} 次，实际 {times} 次",
        "expected {retries} repetitions, found {times}"
    ))
}

pub(super) async fn acknowledged(stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
    let mut line = stage.connect(evidence).await?;
    let first = first_report(stage, &mut line).await?;
    line.acknowledge(&first).await;
    let end = Instant::now() + wait(policy(stage, first.operation));
    while let Some(left) = end.checked_duration_since(Instant::now()) {
        match line.next(left).await? {
            Next::Frame(frame) if is_report(&frame) && frame.id == first.id => {
                return deviates(text!(
                    "已应答的上报又发送了一次",
                    "the report came again after its acknowledgement"
                ));
            }
            Next::Frame(frame) if is_report(&frame) => line.acknowledge(&frame).await,
            Next::Frame(_) => {}
            Next::Closed | Next::Silence => break,
        }
    }
    Ok(())
}
