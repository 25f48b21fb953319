//! A call of a robot: the request, the response, and the reports that follow it.

use crate::address::with_port;
use crate::answer::{Process, Progress, Response};
use crate::arguments::json;
use crate::client::{Client, ClientError};
use crate::request::Request;
use fc_reflect::{BodyError, Direction, Frame, FrameError, Packing, Reflector};
use fc_spec::model::{Kind, Operation, Side, Value};
use std::io;
use std::time::{Duration, Instant};
use thiserror::Error;
use tokio::time::timeout;

/// The largest number of times that are kept for [`Event::Times`].
const MOST_TIMES: usize = 1 << 16;

/// The settings of a call.
#[derive(Clone, Copy)]
pub struct Call<'r, 'm> {
    /// The spec.
    pub reflector: &'m Reflector<'m>,
    /// Address of the robot. Its port, if it has none, is that of the request.
    pub to: &'r str,
    /// The number of requests, or of frames of a stream.
    pub repeat: u32,
    /// The time that a request waits for its response, and a stream for its next frame.
    pub timeout: Duration,
    /// The longest silence of the process that a command sets off. Without one, the process is not followed.
    pub follow: Option<Duration>,
}

/// An observation of a call.
#[derive(Debug)]
pub enum Event<'e, 'm> {
    /// A response.
    Response(&'e Response<'e, 'm>),
    /// A response that breaks the spec.
    Invalid(&'e BodyError),
    /// A report of the process, or a frame of the stream.
    Pushed(&'m Operation, &'e Frame<'m>),
    /// The times of all responses.
    Times(Vec<Duration>),
}

/// Receives the observations of a call.
pub type Sink<'o, 'm> = dyn FnMut(Event<'_, 'm>) -> io::Result<()> + 'o;

/// The outcome of the last call that was no success, or a success.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The robot did as asked.
    Success,
    /// The robot refused the request, or the process failed.
    Refused,
    /// The response breaks the spec.
    Invalid,
}

/// The reason why a call ended early.
#[derive(Debug, Error)]
pub enum CallError {
    /// There is no response.
    #[error(transparent)]
    Client(#[from] ClientError),
    /// The message of a stream has no frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The receiver of the observations has failed.
    #[error(transparent)]
    Sink(#[from] io::Error),
}

impl CallError {
    /// Returns `true` if the connection has ended.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Client(error) if error.is_lost())
    }
}

impl<'m> Call<'_, 'm> {
    /// Connects, and sends the request as often as asked.
    ///
    /// # Errors
    /// [`CallError`].
    pub async fn run(
        &self,
        request: &Request<'m>,
        sink: &mut Sink<'_, 'm>,
    ) -> Result<Ending, CallError> {
        let mut client = self.connect(request).await?;
        self.send(&mut client, request, sink).await
    }

    /// Connects to the port of a request.
    ///
    /// # Errors
    /// [`ClientError::Connect`].
    pub async fn connect(&self, request: &Request<'m>) -> Result<Client<'m>, ClientError> {
        let port = request.operation.map(|operation| operation.port);
        let ports = &self.reflector.model().transport.ports;
        let port = port.map_or(&ports.command, |role| ports.get(role));
        let address = with_port(self.to, port.number);
        Client::connect(self.reflector, &address, self.timeout).await
    }

    /// Sends the request over a connection as often as asked.
    ///
    /// # Errors
    /// [`CallError`].
    pub async fn send(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
        sink: &mut Sink<'_, 'm>,
    ) -> Result<Ending, CallError> {
        if let Some(operation) = request.operation
            && operation.kind() == Kind::Stream
        {
            self.stream(client, request, operation, sink).await?;
            return Ok(Ending::Success);
        }
        let mut ending = Ending::Success;
        let mut times = Vec::new();
        for _ in 0..self.repeat {
            let one = self.once(client, request, &mut times, sink).await?;
            if one != Ending::Success {
                ending = one;
            }
        }
        sink(Event::Times(times))?;
        Ok(ending)
    }

    async fn once(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
        times: &mut Vec<Duration>,
        sink: &mut Sink<'_, 'm>,
    ) -> Result<Ending, CallError> {
        let begun = Instant::now();
        let data = request.data.as_slice().into();
        let called = client.call(request.kind, request.code, data, self.timeout);
        let frame = called.await?;
        let took = begun.elapsed();
        if times.len() < MOST_TIMES {
            times.push(took);
        }
        let response = match Response::read(self.reflector, request.operation, &frame, took) {
            Ok(response) => response,
            Err(error) => return invalid(&error, sink),
        };
        sink(Event::Response(&response))?;
        if !response.outcome.is_success() {
            return Ok(Ending::Refused);
        }
        if let Err(error) = &response.message.body {
            return invalid(error, sink);
        }
        match (self.follow, request.operation) {
            (Some(silence), Some(command)) => {
                let process = Process {
                    model: self.reflector.model(),
                    command,
                    request: value(&request.data),
                    response: value(&frame.data),
                };
                self.follow(client, &process, silence, sink).await
            }
            _ => Ok(Ending::Success),
        }
    }

    /// Receives the reports of a process until it has ended.
    async fn follow(
        &self,
        client: &mut Client<'m>,
        process: &Process<'m>,
        silence: Duration,
        sink: &mut Sink<'_, 'm>,
    ) -> Result<Ending, CallError> {
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
            sink(Event::Pushed(operation, &frame))?;
            match progress {
                Progress::Running => {}
                Progress::Ended => return Ok(Ending::Success),
                Progress::Failed => return Ok(Ending::Refused),
            }
        }
    }

    /// Sends the frames of a stream, or receives those that the robot sends.
    async fn stream(
        &self,
        client: &mut Client<'m>,
        request: &Request<'m>,
        operation: &'m Operation,
        sink: &mut Sink<'_, 'm>,
    ) -> Result<(), CallError> {
        if operation.sender == Side::App {
            for number in 0..self.repeat {
                if let Some(id) = self.reflector.id(operation, Direction::Request, number) {
                    let frame = self.reflector.seal(id, &request.data, Packing::Plain)?;
                    client.send(&frame).await?;
                }
            }
            return Ok(());
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
            sink(Event::Pushed(operation, &next.await?))?;
        }
        Ok(())
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

fn invalid(error: &BodyError, sink: &mut Sink<'_, '_>) -> Result<Ending, CallError> {
    sink(Event::Invalid(error))?;
    Ok(Ending::Invalid)
}
