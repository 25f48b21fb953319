//! The data port: frames of raw bytes from and to apps.

use super::budget::{Charge, ConnectionMemory, MemoryHolder, NO_MEMORY};
use super::config::Settings;
use super::connection_id::ConnectionId;
use super::counters::Counters;
use super::driver::FRAME;
use super::gate::{Gate, LARGE, process_frame};
use super::penalty::{Penalty, inflated};
use crate::clock;
use crate::frame::{FrameId, LONG, Prepared};
use crate::link::{CLOSING, Transport};
use crate::log_limiter::LogLimiter;
use crate::message::{Empty, write_enveloped};
use crate::protocol::{Protocol, ResponseEnvelope};
use crate::stream::{Patience, Receiver, Sender, StreamError, StreamFrame};
use crate::sync::lock;
use std::convert::Infallible;
use std::future::poll_fn;
use std::marker::PhantomData;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use tokio::io::{AsyncRead, ReadHalf, WriteHalf};
use tokio::sync::{Notify, mpsc, oneshot};
use tokio::task::yield_now;
use tokio::time::{sleep, timeout};

/// Frames in the queue to one app or to the robot, besides the frame in flight.
pub(super) const QUEUE: usize = 4;

/// A frame to be sent.
pub(super) struct Outgoing {
    pub(super) id: FrameId,
    pub(super) body: Prepared,
    /// Memory of the body, as if it were not shared.
    pub(super) charge: Charge,
}

/// The receiver of frames from apps.
pub(super) type Inbox = Mutex<Option<mpsc::Sender<AppStream>>>;

/// A frame of raw bytes from an app.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AppStream {
    /// Data connection of the frame.
    pub connection: ConnectionId,
    /// Address of the app.
    pub peer: SocketAddr,
    /// The frame.
    pub frame: StreamFrame,
    charge: MemoryGuard,
}

/// The memory of a frame, charged to the server until the frame is taken apart.
#[derive(Debug)]
struct MemoryGuard(#[allow(dead_code, reason = "counts while it lives")] Option<Charge>);

/// A copy is not charged; it belongs to the robot.
impl Clone for MemoryGuard {
    fn clone(&self) -> Self {
        Self(None)
    }
}

impl PartialEq for MemoryGuard {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for MemoryGuard {}

/// Frames of raw bytes from apps, in the order received on each connection.
#[derive(Debug)]
pub struct AppStreams(pub(super) mpsc::Receiver<AppStream>);

impl AppStreams {
    /// Returns the next frame, or `None` if the server has ended or another receiver has replaced this one.
    ///
    /// Cancellation safe.
    pub async fn recv(&mut self) -> Option<AppStream> {
        self.0.recv().await
    }

    /// Polls for the next frame.
    pub fn poll_recv(
        &mut self,
        cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<Option<AppStream>> {
        self.0.poll_recv(cx)
    }
}

impl futures_core::Stream for AppStreams {
    type Item = AppStream;

    fn poll_next(
        self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<Option<AppStream>> {
        self.get_mut().0.poll_recv(cx)
    }
}

/// The app of a data connection. The protocol does not specify it. Its address identifies it as long as only one app
/// has that address.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Owner {
    /// No command connection from the same address so far.
    #[default]
    Nobody,
    /// Only this command connection so far.
    One(ConnectionId),
    /// Several command connections so far, so the owner is unknown.
    Several,
}

impl Owner {
    /// Notes a command connection from the same address.
    pub(super) fn note(&mut self, app: ConnectionId) {
        *self = match *self {
            Self::Nobody => Self::One(app),
            Self::One(known) if known == app => Self::One(app),
            Self::One(_) | Self::Several => Self::Several,
        };
    }
}

/// The shared part of a data connection. The connection ends when this is dropped and everything is sent.
pub(super) struct DataEntry<P> {
    pub(super) sender: mpsc::Sender<Outgoing>,
    pub(super) peer: Arc<DataPeer<P>>,
    pub(super) owner: Owner,
    /// Ends the handshake when the entry is dropped.
    pub(super) _entered: oneshot::Sender<Infallible>,
}

/// One data connection.
pub(super) struct DataPeer<P> {
    pub(super) id: ConnectionId,
    pub(super) address: SocketAddr,
    pub(super) settings: Arc<Settings>,
    pub(super) counters: Arc<Counters>,
    pub(super) inbox: Arc<Inbox>,
    /// Queue for responses. It is weak, so that the connection ends when there are no other senders.
    pub(super) answers: mpsc::WeakSender<Outgoing>,
    pub(super) gate: Gate,
    pub(super) memory: Arc<ConnectionMemory>,
    /// Tells the connection to end at once.
    pub(super) evicted: Notify,
    /// `true` if a frame has been received.
    pub(super) heard: AtomicBool,
    pub(super) protocol: PhantomData<P>,
}

impl<P: Protocol> MemoryHolder for DataPeer<P> {
    /// Does nothing, because it keeps no unused memory.
    fn tidy(&self) {}

    fn evict(&self, held: usize) {
        self.counters
            .evicted::<P>(self.id, self.address, "data", held);
        self.evicted.notify_one();
    }
}

impl<P: Protocol> DataPeer<P> {
    /// Serves the connection until it or `outbox` ends.
    pub(super) async fn run<S: Transport>(&self, stream: S, outbox: mpsc::Receiver<Outgoing>) {
        let (read, write) = tokio::io::split(stream);
        let patience = Patience {
            header: Some(self.settings.header_timeout),
            stall: Some(self.settings.stall),
        };
        let receiver = Receiver::new(read, self.settings.stream_decoder(), patience);
        let sender = Sender::new(write, patience);
        self.counters.connected::<P>(self.id, self.address, "data");
        let reason = tokio::select! {
            ended = self.converse(receiver, sender, outbox) => match ended {
                Ok(()) => "closed",
                Err(error) => {
                    if matches!(error, StreamError::Stalled) {
                        self.counters.connections_timed_out.increment();
                    }
                    error.name()
                }
            },
            () = self.evicted.notified() => NO_MEMORY,
        };
        self.memory.close();
        self.counters
            .ended::<P>(self.id, self.address, "data", reason);
    }

    /// Reads and writes until one of them ends. If the app sends no more, the queued frames are still sent.
    async fn converse<S: Transport>(
        &self,
        mut receiver: Receiver<ReadHalf<S>, P>,
        sender: Sender<WriteHalf<S>>,
        outbox: mpsc::Receiver<Outgoing>,
    ) -> Result<(), StreamError> {
        let (reading, over) = oneshot::channel();
        let mut write = pin!(self.write(sender, outbox, over));
        let read = tokio::select! {
            ended = self.read(&mut receiver) => ended,
            ended = &mut write => return ended,
        };
        drop(reading);
        write.await?;
        let _ = timeout(CLOSING, receiver.skip_to_end()).await;
        read
    }

    async fn read<S: Transport>(
        &self,
        receiver: &mut Receiver<ReadHalf<S>, P>,
    ) -> Result<(), StreamError> {
        let mut work = 0;
        let mut penalty = Penalty::default();
        let mut limiters = LogLimiter::default();
        loop {
            if work >= LONG {
                work = 0;
                yield_now().await;
            }
            let next = self.next(receiver).await;
            let bytes = receiver.take_received();
            self.counters.bytes_in.add(bytes);
            work += FRAME + bytes;
            let mut rest = inflated(receiver.decoder().take_surplus());
            match next {
                Ok(None) => return Ok(()),
                Ok(Some(frame)) => {
                    self.heard.store(true, Ordering::Relaxed);
                    work += frame.data.len();
                    self.hand_on(frame).await;
                }
                Err(error) => {
                    let counters = &self.counters;
                    let whose = (self.id, self.address);
                    counters.bad_frame::<P>(&mut limiters, whose, error.name(), &error);
                    if error.is_fatal() {
                        return Err(error);
                    }
                    if let Some(frame) = error.answerable() {
                        self.refuse(frame);
                    }
                    rest = rest.max(penalty.unusable(1, clock::now()));
                }
            }
            if !rest.is_zero() {
                self.counters.connections_paced.increment();
                sleep(rest).await;
            }
        }
    }

    /// Returns the next frame, or `None` at the end.
    async fn next<R: AsyncRead + Unpin>(
        &self,
        receiver: &mut Receiver<R, P>,
    ) -> Result<Option<StreamFrame>, StreamError> {
        loop {
            if let Some(frame) = self.pass(receiver).await? {
                return Ok(Some(frame));
            }
            if self.read_on(receiver).await? == 0 {
                receiver.decoder().finish()?;
                return Ok(None);
            }
        }
    }

    /// Returns the next complete frame, after the gate if it is large.
    async fn pass<R: AsyncRead + Unpin>(
        &self,
        receiver: &mut Receiver<R, P>,
    ) -> Result<Option<StreamFrame>, StreamError> {
        let taken = if let Some(work) = receiver.decoder().work(LARGE) {
            let _inflated = poll_fn(|cx| self.memory.poll_lend(cx, work.inflated)).await;
            let pass = self.gate.clone().pass().await;
            process_frame(Some(&pass), || receiver.take())
        } else {
            receiver.take()
        };
        let decoder = receiver.decoder();
        if decoder.idle() > LONG {
            decoder.tidy();
        }
        self.memory.update(decoder.capacity(), 0);
        taken
    }

    /// Reads once. Returns 0 at the end of the stream. Memory is reserved only after bytes have arrived.
    async fn read_on<R: AsyncRead + Unpin>(
        &self,
        receiver: &mut Receiver<R, P>,
    ) -> Result<usize, StreamError> {
        let decoder = receiver.decoder();
        if decoder.is_bare() {
            return Ok(receiver.begin().await?);
        }
        let bytes = decoder.growth();
        if bytes > 0 {
            poll_fn(|cx| self.memory.poll_grow(cx, bytes)).await;
        }
        receiver.fill().await
    }

    /// Passes a frame to the receiver of streams, and waits while it is busy. The app is not read meanwhile.
    async fn hand_on(&self, frame: StreamFrame) {
        self.counters.stream_frames_in.increment();
        let inbox = lock(&self.inbox).clone();
        let mut charge = self.memory.queue_existing(frame.data.memory());
        if let Some(inbox) = inbox
            && let Ok(place) = inbox.reserve().await
        {
            poll_fn(|cx| charge.poll_hand_over(cx)).await;
            place.send(AppStream {
                connection: self.id,
                peer: self.address,
                frame,
                charge: MemoryGuard(Some(charge)),
            });
        } else {
            self.counters.stream_frames_dropped.increment();
        }
    }

    /// Responds to an unusable frame. The response is dropped if there is no room for it.
    fn refuse(&self, frame: FrameId) {
        if !P::Response::HAS_RESULT {
            return;
        }
        let result = P::RESULTS.protocol;
        let envelope = P::Response::at(clock::unix_ms(), result.code, result.text);
        let body = self
            .settings
            .encoder::<P>()
            .prepare(|out| write_enveloped(&envelope, &Empty, out));
        if let (Ok(body), Some(answers)) = (body, self.answers.upgrade())
            && let Some(charge) = self.memory.try_queue(body.len())
        {
            let id = frame.answer();
            let _ = answers.try_send(Outgoing { id, body, charge });
        }
    }

    async fn write<S: Transport>(
        &self,
        mut sender: Sender<WriteHalf<S>>,
        mut outbox: mpsc::Receiver<Outgoing>,
        mut read_over: oneshot::Receiver<Infallible>,
    ) -> Result<(), StreamError> {
        loop {
            let next = tokio::select! {
                next = outbox.recv() => next,
                _ = &mut read_over, if !outbox.is_closed() => {
                    outbox.close();
                    continue;
                }
            };
            let Some(Outgoing { id, body, charge }) = next else {
                break;
            };
            let sent = sender.send_prepared::<P>(id, &body).await?;
            drop(charge);
            self.counters.bytes_out.add(sent);
            if !id.response {
                self.counters.stream_frames_out.increment();
            }
        }
        sender.close().await
    }
}
