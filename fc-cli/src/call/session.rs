//! The conversation of a call.

use std::time::{Duration, Instant};

use fc_reflect::{Direction, Frame, Packing, Reflector};
use fc_spec::model::{Kind, Operation, Side, Value};
use fc_workshop::answer::{Outcome, Process, Progress};
use fc_workshop::arguments::json;
use fc_workshop::client::{Client, ClientError};
use tokio::time::timeout;

use super::{Request, show};
use crate::endpoint::with_port;
use crate::lang::said;
use crate::outcome::{Failure, Status, unanswered};
use crate::print;

/// The largest number of times that are kept for the summary.
const MOST_TIMES: usize = 1 << 16;

/// The settings of a call.
pub struct Call<'r, 'm> {
    pub reflector: &'m Reflector<'m>,
    pub to: &'r str,
    pub repeat: u32,
    pub timeout: Duration,
    /// Longest silence of a process to follow.
    pub follow: Option<Duration>,
    pub shown: show::Format,
}

impl<'m> Call<'_, 'm> {
    /// Sends the request as often as asked. Returns the status of the last call that was no success.
    pub async fn run(&self, request: &Request<'m>) -> Result<Status, Failure> {
        let each = async {
            let mut client = self.connect(request).await?;
            self.with(&mut client, request).await
        };
        each.await.or_else(unanswered)
    }

    /// Connects to the port of a request.
    pub async fn connect(&self, request: &Request<'m>) -> Result<Client<'m>, Failure> {
        let port = request.operation.map(|operation| operation.port);
        let ports = &self.reflector.model().transport.ports;
        let port = port.map_or(&ports.command, |role| ports.get(role));
        let address = with_port(self.to, port.number);
        Ok(Client::connect(self.reflector, &address, self.timeout).await?)
    }

    /// Sends the request over a connection as often as asked.
    pub async fn with(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
    ) -> Result<Status, Failure> {
        if let Some(operation) = request.operation
            && operation.kind() == Kind::Stream
        {
            return self.stream(client, request, operation).await;
        }
        let mut status = Status::Fine;
        let mut times = Vec::new();
        for _ in 0..self.repeat {
            let one = self.once(client, request, &mut times).await?;
            if one != Status::Fine {
                status = one;
            }
        }
        print::result(&self.shown.times(times))?;
        Ok(status)
    }

    async fn once(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
        times: &mut Vec<Duration>,
    ) -> Result<Status, Failure> {
        let begun = Instant::now();
        let data = request.data.as_slice().into();
        let called = client.call(request.kind, request.code, data, self.timeout);
        let frame = called.await?;
        let took = begun.elapsed();
        if times.len() < MOST_TIMES {
            times.push(took);
        }
        let message = (self.reflector).message(request.operation, Direction::Response, &frame.data);
        let message = match message {
            Ok(message) => message,
            Err(error) => return Ok(invalid(&error)),
        };
        let outcome = Outcome::of(self.reflector.model(), &message);
        let name = request.operation.map(|operation| operation.name.as_str());
        print::result(&self.shown.response(name, &frame, &outcome, &message, took))?;
        if !outcome.is_success() {
            return Ok(Status::Refused);
        }
        if let Err(error) = &message.body {
            return Ok(invalid(error));
        }
        match (self.follow, request.operation) {
            (Some(silence), Some(operation)) => {
                let process = Process {
                    model: self.reflector.model(),
                    command: operation,
                    request: value(&request.data),
                    response: value(&frame.data),
                };
                self.follow(client, &process, silence).await
            }
            _ => Ok(Status::Fine),
        }
    }

    /// Shows the reports of a process until it has ended.
    async fn follow(
        &self,
        client: &mut Client<'m>,
        process: &Process<'m>,
        silence: Duration,
    ) -> Result<Status, Failure> {
        loop {
            // Reports of other processes do not prolong the silence.
            let next = within(silence, async {
                loop {
                    let frame = client.report(silence).await?;
                    let Some(operation) = frame.operation else {
                        continue;
                    };
                    if let Some(progress) = process.progress(operation, &value(&frame.data)) {
                        return Ok((frame, operation, progress));
                    }
                }
            });
            let (frame, operation, progress) = next.await?;
            self.show_pushed(operation, &frame)?;
            match progress {
                Progress::Running => {}
                Progress::Ended => return Ok(Status::Fine),
                Progress::Failed => return Ok(Status::Refused),
            }
        }
    }

    /// Sends the frames of a stream, or shows those that the robot sends.
    async fn stream(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
        operation: &Operation,
    ) -> Result<Status, Failure> {
        if operation.sender == Side::App {
            for number in 0..self.repeat {
                if let Some(id) = self.reflector.id(operation, Direction::Request, number) {
                    let frame = self.reflector.seal(id, &request.data, Packing::Plain)?;
                    client.send(&frame).await?;
                }
            }
            return Ok(Status::Fine);
        }
        for _ in 0..self.repeat {
            // Frames of other streams do not prolong the timeout.
            let next = within(self.timeout, async {
                loop {
                    let frame = client.stream_frame(self.timeout).await?;
                    if frame.id.code == request.code {
                        return Ok(frame);
                    }
                }
            });
            self.show_pushed(operation, &next.await?)?;
        }
        Ok(Status::Fine)
    }

    fn show_pushed(&self, operation: &Operation, frame: &Frame<'_>) -> Result<(), Failure> {
        Ok(print::result(&self.pushed(operation, frame))?)
    }

    /// Returns the text of a report or a frame of a stream.
    pub fn pushed(&self, operation: &Operation, frame: &Frame<'_>) -> String {
        let message = (self.reflector).message(Some(operation), frame.id.direction, &frame.data);
        self.shown.pushed(operation, frame, message.as_ref().ok())
    }
}

/// Waits for a frame. Its absence within the time is silence.
async fn within<T>(
    time: Duration,
    frame: impl Future<Output = Result<T, ClientError>>,
) -> Result<T, ClientError> {
    let arrived = timeout(time, frame).await;
    arrived.unwrap_or(Err(ClientError::Silence(time)))
}

/// Reads a message that is only compared. Other data is null.
fn value(data: &[u8]) -> Value {
    let text = std::str::from_utf8(data).ok();
    text.and_then(json).unwrap_or(Value::Null)
}

fn invalid(error: &fc_reflect::BodyError) -> Status {
    let _ = print::error(&said!(
        "响应不合规范：{error}",
        "the response breaks the spec: {error}"
    ));
    Status::Unanswered
}
