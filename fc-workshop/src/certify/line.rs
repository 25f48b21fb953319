//! A raw connection to a device, with a record of its bytes.

use super::{Failure, Outcome};
use crate::answer;
use crate::facts;
use crate::stream::FrameStream;
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Frame, FrameId, Reflector};
use fc_spec::model::{Encoding, EncodingRole, KindRole, Model, Operation, Text, Value};
use fc_spec::text;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{Instant, timeout, timeout_at};

/// The largest number of frames that a failure shows.
const SHOWN: usize = 20;

/// The reason why a trial has no result.
#[derive(Debug)]
pub(super) enum Stop {
    /// The device deviates from the spec.
    Deviation(Text),
    /// The trial does not apply.
    Skip(Text),
}

/// The result of a step of a trial.
pub(super) type Step<T = ()> = Result<T, Stop>;

/// Returns a deviation as an error.
pub(super) fn deviates<T>(reason: Text) -> Step<T> {
    Err(Stop::Deviation(reason))
}

/// Sent and received frames and bytes.
#[derive(Debug, Default)]
pub(super) struct Evidence {
    sent: Vec<Vec<u8>>,
    received: Vec<Vec<u8>>,
}

impl Evidence {
    /// Adds sent bytes.
    pub(super) fn sent(&mut self, bytes: &[u8]) {
        if self.sent.len() < SHOWN {
            self.sent.push(bytes.to_vec());
        }
    }

    /// Adds received bytes.
    pub(super) fn received(&mut self, bytes: Vec<u8>) {
        if self.received.len() < SHOWN {
            self.received.push(bytes);
        }
    }

    /// Returns the outcome of a trial with this result.
    pub(super) fn outcome(self, result: Step) -> Outcome {
        match result {
            Ok(()) => Outcome::Passed,
            Err(Stop::Skip(reason)) => Outcome::Skipped(reason),
            Err(Stop::Deviation(reason)) => Outcome::Failed(Failure {
                reason,
                sent: self.sent,
                received: self.received,
            }),
        }
    }
}

/// A connection of a trial.
pub(super) struct Line<'r, 'm> {
    reflector: &'r Reflector<'m>,
    stream: TcpStream,
    frames: FrameStream,
    evidence: &'r mut Evidence,
    /// `true` if reports are acknowledged.
    acknowledges: bool,
    /// `true` if frames with errors are passed over.
    is_tolerant: bool,
}

/// The next event of a connection.
pub(super) enum Next<'m> {
    /// A frame.
    Frame(Box<Frame<'m>>),
    /// The device has closed the connection.
    Closed,
    /// The device was silent.
    Silence,
}

impl<'r, 'm> Line<'r, 'm> {
    /// Connects to the device.
    pub(super) async fn connect(
        reflector: &'r Reflector<'m>,
        address: &str,
        evidence: &'r mut Evidence,
    ) -> Step<Self> {
        let wait = facts::call_timeout(reflector.model());
        let connected = timeout(wait, TcpStream::connect(address)).await;
        match connected {
            Ok(Ok(stream)) => {
                // Without it, small frames only travel later.
                let _ = stream.set_nodelay(true);
                Ok(Self {
                    reflector,
                    stream,
                    frames: FrameStream::default(),
                    evidence,
                    acknowledges: true,
                    is_tolerant: false,
                })
            }
            _ => deviates(text!("设备不接受连接", "the device accepts no connection")),
        }
    }

    /// From now on, reports are not acknowledged.
    pub(super) fn stop_acknowledging(&mut self) {
        self.acknowledges = false;
    }

    /// From now on, frames with errors are passed over.
    pub(super) fn tolerate_errors(&mut self) {
        self.is_tolerant = true;
    }

    /// Sends bytes. The device may have closed the connection already, or read nothing.
    pub(super) async fn send(&mut self, bytes: &[u8]) {
        self.evidence.sent(bytes);
        let wait = facts::call_timeout(self.reflector.model());
        let _ = timeout(wait, self.stream.write_all(bytes)).await;
    }

    /// Closes the sending side.
    pub(super) async fn close_half(&mut self) {
        let _ = self.stream.shutdown().await;
    }

    /// Returns the next frame that is not an acknowledged report.
    pub(super) async fn next(&mut self, wait: Duration) -> Step<Next<'m>> {
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
                Err(_) if self.is_tolerant => continue,
                Err(error) => {
                    return deviates(text!(
                        "收到的帧有错误：{error}",
                        "a received frame has an error: {error}"
                    ));
                }
            };
            let is_report =
                frame.kind.role == KindRole::Report && frame.id.direction == Direction::Request;
            if is_report && self.acknowledges {
                self.acknowledge(&frame).await;
                continue;
            }
            return Ok(Next::Frame(Box::new(frame)));
        }
    }

    /// Acknowledges a report with success.
    pub(super) async fn acknowledge(&mut self, report: &Frame<'m>) {
        if let Some(bytes) = facts::success(self.reflector, report) {
            self.send(&bytes).await;
        }
    }

    /// Returns the result of the response to a request within the timeout of a call.
    pub(super) async fn response(&mut self, id: FrameId) -> Step<answer::Outcome<'m>> {
        let wait = facts::call_timeout(self.reflector.model());
        match self.next(wait).await? {
            Next::Frame(frame) if frame.id == id.answer() => self.read(&frame),
            Next::Frame(frame) => deviates(text!(
                "应为 {expected} 的响应，实际为 {found}",
                "expected the response to {expected}, found {found}",
                expected = shown(id),
                found = shown(frame.id)
            )),
            Next::Closed => deviates(text!(
                "设备没有响应就断开了连接",
                "the device closed the connection without a response"
            )),
            Next::Silence => {
                let wait = wait.as_millis();
                deviates(text!(
                    "{wait} ms 内没有响应",
                    "no response within {wait} ms"
                ))
            }
        }
    }

    /// Checks the body of a response, and returns its result.
    fn read(&self, frame: &Frame<'m>) -> Step<answer::Outcome<'m>> {
        let model = self.reflector.model();
        let operation = frame.operation;
        let message = self
            .reflector
            .message(operation, frame.id.direction, &frame.data);
        let breaks = |error: &fc_reflect::BodyError| {
            text!(
                "响应不合规范：{error}",
                "the response breaks the spec: {error}"
            )
        };
        let message = match message {
            Ok(message) => message,
            Err(error) => return deviates(breaks(&error)),
        };
        let outcome = answer::Outcome::of(model, &message);
        if let (Some(code), None) = (outcome.code, outcome.known) {
            return deviates(text!(
                "规范没有结果码 {code}",
                "the spec has no result code {code}"
            ));
        }
        match &message.body {
            Err(error) if outcome.is_success() => deviates(breaks(error)),
            _ => Ok(outcome),
        }
    }
}

/// Returns a message id as people read it.
pub(super) fn shown(id: FrameId) -> String {
    format!("0x{:04X} #{}", id.code, id.id)
}

/// Returns the request or report with the example of an operation.
pub(super) fn example(
    reflector: &Reflector<'_>,
    operation: &Operation,
    id: u32,
) -> Option<(FrameId, Value)> {
    let id = reflector.id(operation, Direction::Request, id)?;
    let samples = reflector.samples();
    let mut message = samples.message(operation, Direction::Request, Profile::Example);
    facts::stamp(reflector.model(), Direction::Request, &mut message);
    Some((id, message))
}

/// Returns the encoding of compressed data.
pub(super) fn gzip(model: &Model) -> Step<&Encoding> {
    let gzip = model.frame.encoding(EncodingRole::Gzip);
    gzip.ok_or_else(|| Stop::Skip(text!("协议没有压缩", "the protocol has no compression")))
}
