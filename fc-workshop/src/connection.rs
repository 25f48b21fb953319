//! A connection: frames of a model over a byte stream, with the session of the runtime.

use crate::facts;
use crate::stream::FrameStream;
use fc_reflect::{Direction, Frame, FrameError, FrameId, Packing, Reflector};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{AckPolicy, Busy, Due, Incoming, Session};
use std::future::pending;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};
use thiserror::Error;
use tokio::io::{
    AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, ReadHalf, WriteHalf,
};
use tokio::time::timeout;

/// While more bytes than these wait to be written, the connection reads nothing.
const MOST_UNWRITTEN: usize = 1 << 20;

/// The time in which a peer must take some of the last bytes.
const LAST_WRITE: Duration = Duration::from_secs(5);

/// An event of a connection.
#[derive(Debug)]
pub enum Event<'m, T> {
    /// The response to a request, which ends here.
    Answer(T, Frame<'m>),
    /// A request has ended without a response.
    Expired(T),
    /// A response to no request in flight.
    Late(Frame<'m>),
    /// A command.
    Command(Frame<'m>),
    /// A new report. [`Connection::acknowledge`] answers it.
    Report(Frame<'m>),
    /// Raw bytes, or the JSON of a stream.
    Stream(Frame<'m>),
    /// A frame with an error that belongs to a known message.
    Invalid(FrameId, FrameError),
    /// The connection has ended, by the peer or by an error.
    Ended(End),
}

/// The reason for the end of a connection.
#[derive(Debug)]
pub enum End {
    /// The peer closed the connection.
    Closed,
    /// The bytes of the peer contain no further frame.
    Frame(FrameError),
    /// Reading or writing failed.
    Io(io::Error),
}

/// A request in flight. Sealing its data again gives the same bytes.
struct Open<T> {
    data: Arc<[u8]>,
    token: T,
}

/// A connection over a byte stream. The caller drives it with [`next`](Self::next).
pub struct Connection<'m, S, T> {
    reflector: &'m Reflector<'m>,
    reader: ReadHalf<S>,
    writer: WriteHalf<S>,
    received: FrameStream,
    session: Session<Open<T>>,
    out: Vec<u8>,
    written: usize,
}

impl<'m, S: AsyncRead + AsyncWrite, T> Connection<'m, S, T> {
    /// Begins a conversation over a byte stream. `first_id` is the message id of the first request.
    #[must_use]
    pub fn new(reflector: &'m Reflector<'m>, stream: S, first_id: u32) -> Self {
        let model = reflector.model();
        let (reader, writer) = tokio::io::split(stream);
        let ack = facts::ack(model.calls.ack);
        Self {
            reflector,
            reader,
            writer,
            received: FrameStream::default(),
            session: Session::new(facts::rules(model), &facts::limits(model), ack, first_id),
            out: Vec::new(),
            written: 0,
        }
    }

    /// Sends a request with this data: a command or a report. The token is returned once, by [`Event::Answer`] or
    /// [`Event::Expired`], unless the connection ends before.
    ///
    /// # Errors
    /// [`NotSent`] if too many requests are in flight, or if the data is too long for a frame.
    pub fn request(
        &mut self,
        kind: u8,
        code: u16,
        data: &Arc<[u8]>,
        policy: AckPolicy,
        token: T,
    ) -> Result<FrameId, NotSent> {
        let open = Open {
            data: Arc::clone(data),
            token,
        };
        let opened = self.session.open(kind, code, policy, now(), open);
        let frame = opened.map_err(NotSent::Busy)?;
        let id = in_frame(frame);
        match self.reflector.seal(id, data, Packing::Plain) {
            Ok(bytes) => {
                self.send(&bytes);
                Ok(id)
            }
            Err(error) => {
                self.session.cancel(frame);
                Err(NotSent::Frame(error))
            }
        }
    }

    /// Appends bytes to those that are to be written.
    pub fn send(&mut self, bytes: &[u8]) {
        self.out.drain(..self.written);
        self.written = 0;
        self.out.extend_from_slice(bytes);
    }

    /// Returns `true` while the peer must take bytes before more are sent.
    pub(crate) fn is_full(&self) -> bool {
        self.out.len() - self.written >= MOST_UNWRITTEN
    }

    /// Remembers a report as delivered, and acknowledges it with success.
    pub fn acknowledge(&mut self, report: &Frame<'m>) {
        let digest = Md5::digest(&report.data);
        self.session
            .handed_on_digested(in_session(report.id), digest, now());
        self.send_ack(report);
    }

    fn send_ack(&mut self, report: &Frame<'m>) {
        if let Some(bytes) = facts::success(self.reflector, report) {
            self.send(&bytes);
        }
    }

    /// Returns the number of requests in flight.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.session.in_flight()
    }

    /// Waits for the next event. Dropping the future loses nothing.
    pub async fn next(&mut self) -> Event<'m, T> {
        loop {
            if let Some(event) = self.ready() {
                return event;
            }
            let due = self.session.next_due();
            let is_full = self.is_full();
            let unwritten = self.out.get(self.written..).unwrap_or_default();
            let result = tokio::select! {
                read = self.reader.read_buf(self.received.room()), if !is_full => {
                    match read {
                        Ok(0) => return Event::Ended(End::Closed),
                        other => other.map(|_| ()),
                    }
                }
                written = self.writer.write(unwritten), if !unwritten.is_empty() => {
                    written.map(|count| self.written += count)
                }
                () = until(due) => Ok(()),
            };
            if let Err(error) = result {
                return Event::Ended(End::Io(error));
            }
        }
    }

    /// Writes everything and closes the sending side.
    ///
    /// # Errors
    /// The error of the byte stream, or `TimedOut` if the peer takes nothing for five seconds.
    pub async fn finish(&mut self) -> io::Result<()> {
        while let Some(unwritten) = self.out.get(self.written..).filter(|it| !it.is_empty()) {
            match timeout(LAST_WRITE, self.writer.write(unwritten)).await?? {
                0 => return Err(io::ErrorKind::WriteZero.into()),
                count => self.written += count,
            }
        }
        timeout(LAST_WRITE, self.writer.shutdown()).await?
    }

    /// Returns an event that needs no further bytes.
    fn ready(&mut self) -> Option<Event<'m, T>> {
        if let Some(event) = self.due() {
            return Some(event);
        }
        loop {
            let frame = match self.received.next(self.reflector) {
                Ok(piece) => piece?.frame,
                Err(error) => return Some(Event::Ended(End::Frame(error))),
            };
            let frame = match frame {
                Ok(frame) => frame,
                Err(error) => {
                    let event = match error.frame {
                        Some(id) => Event::Invalid(id, error),
                        None => Event::Ended(End::Frame(error)),
                    };
                    return Some(event);
                }
            };
            let digest = Some(Md5::digest(&frame.data));
            let id = in_session(frame.id);
            return Some(match self.session.receive_digested(id, digest, now()) {
                Incoming::Answer(open) => Event::Answer(open.token, frame),
                Incoming::Late => Event::Late(frame),
                Incoming::Command => Event::Command(frame),
                Incoming::Report => Event::Report(frame),
                Incoming::Stream => Event::Stream(frame),
                Incoming::Repeated => {
                    self.send_ack(&frame);
                    continue;
                }
            });
        }
    }

    /// Sends due repetitions. Returns a request whose last deadline has passed.
    fn due(&mut self) -> Option<Event<'m, T>> {
        let now = now();
        loop {
            let (frame, data) = match self.session.due(now)? {
                Due::Expired(_, open) => return Some(Event::Expired(open.token)),
                Due::Again(frame, open) => (frame, Arc::clone(&open.data)),
            };
            // It was sealed before, so it is not too long.
            if let Ok(bytes) = self.reflector.seal(in_frame(frame), &data, Packing::Plain) {
                self.send(&bytes);
            }
        }
    }
}

/// The reason why a request was not sent.
#[derive(Debug, Error)]
pub enum NotSent {
    /// Too many requests are in flight.
    #[error("{0}")]
    Busy(Busy),
    /// The frame is too long.
    #[error("{0}")]
    Frame(FrameError),
}

/// Returns the id as the session of the runtime has it.
fn in_session(id: FrameId) -> fc_runtime::FrameId {
    fc_runtime::FrameId {
        response: id.direction == Direction::Response,
        kind: id.kind,
        code: id.code,
        id: id.id,
    }
}

/// Returns the id of a request as its frame has it.
fn in_frame(id: fc_runtime::FrameId) -> FrameId {
    FrameId {
        direction: Direction::Request,
        kind: id.kind,
        code: id.code,
        id: id.id,
    }
}

/// Returns the time of the clock that timers have.
fn now() -> Instant {
    tokio::time::Instant::now().into_std()
}

/// Waits until a time, or forever.
pub(crate) async fn until(due: Option<Instant>) {
    match due {
        Some(due) => tokio::time::sleep_until(due.into()).await,
        None => pending().await,
    }
}
