//! The trials of an app: a robot that answers its commands, and sends reports and faults.

use super::Trial;
use super::line::{Evidence, Next, Step, Stop, deviates, example, gzip, shown};
use crate::answer;
use crate::facts;
use crate::listen::{Listeners, accept};
use crate::stream::FrameStream;
use fc_reflect::{Direction, Frame, FrameId, Packing, Reflector};
use fc_spec::model::{
    Exchange, HeaderRole, Kind, KindRole, Model, Operation, ResultRole, Text, Value,
};
use fc_spec::text;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, timeout, timeout_at};

/// Runs the trials of the app that connects within `wait`. `told` receives each trial at its end. Returns `None` if no
/// app connects, or if `end` is ready before.
pub async fn app(
    reflector: &Reflector<'_>,
    listeners: Listeners,
    wait: Duration,
    told: &mut dyn FnMut(&Trial),
    end: impl Future<Output = ()>,
) -> Option<Vec<Trial>> {
    let mut trials = Vec::new();
    let run = async {
        let accepted = timeout(wait, accept(&listeners.commands)).await;
        let stream = accepted.ok()?;
        let mut app = App {
            reflector,
            listener: &listeners.commands,
            wait,
            stream,
            frames: FrameStream::default(),
            evidence: Evidence::default(),
            id: 0,
            broken: None,
            requests: 0,
        };
        app.all(&mut |trial| {
            told(&trial);
            trials.push(trial);
        })
        .await;
        Some(())
    };
    let is_done = tokio::select! {
        done = run => done,
        () = end => None,
    };
    is_done.map(|()| trials)
}

/// The connection of an app.
struct App<'r, 'm> {
    reflector: &'r Reflector<'m>,
    listener: &'r TcpListener,
    wait: Duration,
    stream: TcpStream,
    frames: FrameStream,
    evidence: Evidence,
    /// The message id of the last report.
    id: u32,
    /// The first request that breaks the spec.
    broken: Option<Text>,
    /// The number of requests.
    requests: usize,
}

impl<'m> App<'_, 'm> {
    fn model(&self) -> &'m Model {
        self.reflector.model()
    }

    async fn all(&mut self, told: &mut dyn FnMut(Trial)) {
        let mut end = |app: &mut Self, name: String, demand: Text, result: Step| {
            let evidence = std::mem::take(&mut app.evidence);
            told(Trial {
                name,
                demand,
                outcome: evidence.outcome(result),
            });
        };
        for report in reports(self.model()) {
            let demand = text!(
                "应答上报 `{name}`",
                "the report `{name}` is acknowledged",
                name = &report.name
            );
            let result = self.acknowledges(report).await;
            end(self, format!("report.{}", report.name), demand, result);
        }
        for (check, name, zh, en) in CHECKS {
            let result = self.run(check).await;
            end(self, name.to_owned(), text!("{zh}", "{en}"), result);
        }
        let demand = text!("请求合乎规范", "requests fit the spec");
        let result = match self.broken.take() {
            Some(reason) => deviates(reason),
            None if self.requests == 0 => Err(Stop::Skip(text!(
                "app 没有发送请求",
                "the app has sent no request"
            ))),
            None => Ok(()),
        };
        end(self, "request.valid".to_owned(), demand, result);
    }

    async fn run(&mut self, check: Check) -> Step {
        let report = reports(self.model()).next();
        let report =
            report.ok_or_else(|| Stop::Skip(text!("规范没有上报", "the spec has no report")))?;
        match check {
            Check::Repeated => {
                let sent = self.report(report, Packing::Plain, |_| {})?;
                self.confirms(&sent).await?;
                self.confirms(&sent).await
            }
            Check::Split => {
                let (id, bytes) = self.report(report, Packing::Plain, |_| {})?;
                for byte in &bytes {
                    self.send(&[*byte]).await;
                    tokio::task::yield_now().await;
                }
                self.acknowledgement(id).await
            }
            Check::Compressed => {
                gzip(self.model())?;
                let sent = self.report(report, Packing::Gzip { level: 6 }, |_| {})?;
                self.confirms(&sent).await
            }
            Check::UnknownKey => {
                let sent = self.report(report, Packing::Plain, |message| {
                    message.set("fcprotoUnknownKey", Value::Bool(true));
                })?;
                self.confirms(&sent).await
            }
            Check::LateResponse => self.late_response(report).await,
            Check::BadDigest => self.bad_digest(report).await,
            Check::Reconnects => self.reconnects(report).await,
        }
    }

    /// Returns the frame of a report with the next message id.
    fn report(
        &mut self,
        report: &Operation,
        packing: Packing,
        change: impl FnOnce(&mut Value),
    ) -> Step<(FrameId, Vec<u8>)> {
        self.id = self.id.wrapping_add(1);
        let sealed = example(self.reflector, report, self.id).and_then(|(id, mut message)| {
            change(&mut message);
            let data = message.to_string();
            let bytes = self.reflector.seal(id, data.as_bytes(), packing);
            Some((id, bytes.ok()?))
        });
        sealed.ok_or_else(|| {
            Stop::Skip(text!(
                "上报放不进一帧",
                "the report does not fit into a frame"
            ))
        })
    }

    async fn acknowledges(&mut self, report: &Operation) -> Step {
        if matches!(&report.exchange, Exchange::Report { ack, .. } if ack.timeout_ms == 0) {
            return Err(Stop::Skip(text!("没有应答", "it has no acknowledgement")));
        }
        let sent = self.report(report, Packing::Plain, |_| {})?;
        self.confirms(&sent).await
    }

    /// Sends a report and waits for its acknowledgement.
    async fn confirms(&mut self, (id, bytes): &(FrameId, Vec<u8>)) -> Step {
        self.send(bytes).await;
        self.acknowledgement(*id).await
    }

    async fn late_response(&mut self, report: &Operation) -> Step {
        let model = self.model();
        let mut commands = model.operations.iter();
        let command = commands.find(|it| it.kind() == Kind::Command && it.code.value.is_some());
        let id = command.and_then(|it| self.reflector.id(it, Direction::Response, u32::MAX / 3));
        if let (Some(id), Some(success)) = (id, facts::result(model, ResultRole::Success)) {
            let message = self.reflector.samples().response(command, success);
            let data = message.to_string();
            if let Ok(bytes) = self.reflector.seal(id, data.as_bytes(), Packing::Plain) {
                self.send(&bytes).await;
            }
        }
        self.acknowledges(report).await
    }

    async fn bad_digest(&mut self, report: &Operation) -> Step {
        if self.model().frame.field(HeaderRole::Digest).is_none() {
            return Err(Stop::Skip(text!(
                "帧头没有摘要",
                "the header has no digest"
            )));
        }
        let (id, mut bytes) = self.report(report, Packing::Plain, |_| {})?;
        self.reflector
            .overwrite(&mut bytes, HeaderRole::Digest, 0xBAD);
        self.send(&bytes).await;
        let (next, bytes) = self.report(report, Packing::Plain, |_| {})?;
        self.send(&bytes).await;
        loop {
            match self.next(self.patience()).await? {
                Next::Frame(frame) if frame.id == id.answer() && self.is_success(&frame) => {
                    return deviates(text!(
                        "损坏的上报得到了应答",
                        "a damaged report was acknowledged"
                    ));
                }
                Next::Frame(frame) if frame.id == next.answer() => return Ok(()),
                Next::Frame(_) => {}
                // An app may also connect again.
                Next::Closed => return self.reconnects(report).await,
                Next::Silence => return deviates(no_acknowledgement(next)),
            }
        }
    }

    async fn reconnects(&mut self, report: &Operation) -> Step {
        let _ = self.stream.shutdown().await;
        let Ok(stream) = timeout(self.wait, accept(self.listener)).await else {
            return Err(Stop::Skip(text!(
                "app 没有重新连接",
                "the app has not connected again"
            )));
        };
        self.stream = stream;
        self.frames = FrameStream::default();
        self.acknowledges(report).await
    }

    /// Waits for the acknowledgement of a report, and answers the requests before it.
    async fn acknowledgement(&mut self, id: FrameId) -> Step {
        match self.next(self.patience()).await? {
            Next::Frame(frame) if frame.id == id.answer() && self.is_success(&frame) => Ok(()),
            Next::Frame(frame) if frame.id == id.answer() => deviates(text!(
                "上报被拒绝：{report}",
                "the report was refused: {report}",
                report = shown(id)
            )),
            Next::Frame(frame) => deviates(text!(
                "应为 {expected} 的应答，实际为 {found}",
                "expected the acknowledgement of {expected}, found {found}",
                expected = shown(id),
                found = shown(frame.id)
            )),
            Next::Closed => deviates(text!("app 断开了连接", "the app closed the connection")),
            Next::Silence => deviates(no_acknowledgement(id)),
        }
    }

    /// Returns the time in which an acknowledgement must come.
    fn patience(&self) -> Duration {
        facts::ack(self.model().calls.ack).timeout
    }

    fn is_success(&self, frame: &Frame<'_>) -> bool {
        let message = (self.reflector).message(frame.operation, Direction::Response, &frame.data);
        message.is_ok_and(|message| answer::Outcome::of(self.model(), &message).is_success())
    }

    /// Sends bytes. The app may have closed the connection already, or read nothing.
    async fn send(&mut self, bytes: &[u8]) {
        self.evidence.sent(bytes);
        let _ = timeout(self.patience(), self.stream.write_all(bytes)).await;
    }

    /// Returns the next frame that is not a command. Commands are answered with their example.
    async fn next(&mut self, wait: Duration) -> Step<Next<'m>> {
        let end = Instant::now() + wait;
        loop {
            let piece = match self.frames.next(self.reflector) {
                Ok(piece) => piece,
                Err(error) => {
                    let rest = self.frames.rest().to_vec();
                    self.evidence.received(rest);
                    return deviates(text!(
                        "收到的字节不是帧：{error}",
                        "the received bytes are no frame: {error}"
                    ));
                }
            };
            let Some(piece) = piece else {
                let read = self.stream.read_buf(self.frames.room());
                match timeout_at(end, read).await {
                    Err(_) => return Ok(Next::Silence),
                    Ok(Ok(0) | Err(_)) => return Ok(Next::Closed),
                    Ok(Ok(_)) => continue,
                }
            };
            self.evidence.received(piece.bytes);
            let frame = match piece.frame {
                Ok(frame) => frame,
                Err(error) => {
                    return deviates(text!(
                        "收到的帧有错误：{error}",
                        "a received frame has an error: {error}"
                    ));
                }
            };
            let is_command =
                frame.kind.role == KindRole::Command && frame.id.direction == Direction::Request;
            if !is_command {
                return Ok(Next::Frame(Box::new(frame)));
            }
            self.answer(&frame).await;
        }
    }

    /// Responds to a request with the example, and remembers the first one that breaks the spec.
    async fn answer(&mut self, frame: &Frame<'m>) {
        self.requests += 1;
        let direction = Direction::Request;
        let message = (self.reflector).message(frame.operation, direction, &frame.data);
        if let Err(error) = message.and_then(|message| message.canonical())
            && self.broken.is_none()
        {
            self.broken = Some(text!(
                "请求 {request} 不合规范：{error}",
                "the request {request} breaks the spec: {error}",
                request = shown(frame.id),
                error = error.to_string()
            ));
        }
        if let Some(bytes) = facts::success(self.reflector, frame) {
            self.send(&bytes).await;
        }
    }
}

/// Returns the reports that can be sent.
fn reports(model: &Model) -> impl Iterator<Item = &Operation> {
    let operations = model.operations.iter();
    operations.filter(|it| it.kind() == Kind::Report && it.code.value.is_some())
}

fn no_acknowledgement(id: FrameId) -> Text {
    text!(
        "没有应答 {report}",
        "no acknowledgement of {report}",
        report = shown(id)
    )
}

/// A check that needs any report.
enum Check {
    Repeated,
    Split,
    Compressed,
    UnknownKey,
    LateResponse,
    BadDigest,
    Reconnects,
}

/// The checks in their order, each with its name and its demand in Chinese and in English.
const CHECKS: [(Check, &str, &str, &str); 7] = [
    (
        Check::Repeated,
        "acknowledgement.repeated",
        "重发的上报再次得到应答",
        "a repeated report is acknowledged again",
    ),
    (
        Check::Split,
        "acknowledgement.split",
        "逐字节到达的上报得到应答",
        "a report that arrives byte by byte is acknowledged",
    ),
    (
        Check::Compressed,
        "acknowledgement.compressed",
        "压缩的上报得到应答",
        "a compressed report is acknowledged",
    ),
    (
        Check::UnknownKey,
        "acknowledgement.unknown_key",
        "忽略上报中未知的键",
        "an unknown key in a report is ignored",
    ),
    (
        Check::LateResponse,
        "connection.late_response",
        "不属于任何请求的响应不影响连接",
        "a response to no request does not disturb the connection",
    ),
    (
        Check::BadDigest,
        "connection.bad_digest",
        "损坏的上报没有应答，之后的上报得到应答",
        "a damaged report is not acknowledged, and the next one is",
    ),
    (
        Check::Reconnects,
        "connection.lost",
        "连接断开后 app 重新连接",
        "the app connects again after a lost connection",
    ),
];
