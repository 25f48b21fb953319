//! An app's connection to the data port.
//!
//! One task connects, reads and writes. Between it and the app there is room for one frame either
//! way, so that a slow side slows the other one down, and nobody's memory grows. A subscription to one
//! stream has a few more, of which the oldest makes way.

mod driver;
mod error;
mod shared;
mod subscription;

pub use error::DataError;
pub use subscription::{StreamItem, Subscription};

use super::config::ClientConfig;
use super::connecting::Dial;
use super::connection_log::ConnectionLog;
use super::loss::Loss;
use super::state::Handle;
use super::state_watch::{ConnectionState, ConnectionStates, closed};
use crate::clock;
use crate::content::StreamContent;
use crate::frame::{Encoder, FrameId};
use crate::json::to_vec;
use crate::message::Message;
use crate::protocol::Protocol;
use crate::session::after;
use crate::stream::{StreamFrame, give_way};
use driver::Driver;
use shared::{Outbox, Shared};
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Mutex;
use tokio::time::{timeout, timeout_at};

/// A connection to a robot's data port: frames of raw bytes in both directions.
///
/// It is made in the background as soon as the command connection is there, and made again after a
/// loss, as [`ClientConfig::reconnect`](super::ClientConfig::reconnect) says. The protocol ties it to
/// the command connection by nothing but the address, and a robot knows whose it is only as long as one
/// command connection has come from there. So it is also made again whenever the command connection
/// was ([`Loss::Renewed`]), and ends with it.
///
/// The protocol has no acknowledgement for such frames. What was on its way when the connection was
/// lost may have arrived or not, and [`DataError::Lost`] says so: to the sender, if anything was
/// sent over the lost connection, and to the receiver. Then it goes on over the next one; nothing
/// is sent twice.
///
/// Nothing is queued but one frame either way, unless something is [subscribed](Self::subscribe) to. Sending
/// waits until the socket has taken the frame. As long as the app does not take what has arrived, the robot is
/// not read, and a loss may be seen late.
/// A frame that stalls while it arrives, and a robot that does not read, lose the connection after
/// [`ClientConfig::stall_timeout`](super::ClientConfig::stall_timeout).
///
/// Closed when dropped. Keeps the command connection open.
pub struct DataConnection<P: Protocol> {
    shared: Arc<Shared>,
    /// One frame is sent at a time.
    encoder: Mutex<Encoder<P>>,
    /// How long to wait for a connection.
    patience: Duration,
    _commands: Handle<P>,
}

impl<P: Protocol> DataConnection<P> {
    pub(super) fn new<D: Dial>(commands: Handle<P>, dial: D) -> Self {
        let config: &ClientConfig = &commands.config;
        let shared = Arc::new(Shared::new());
        let driver = Driver::<P, D> {
            shared: Arc::clone(&shared),
            commands: commands.lock().connection.subscribe(),
            config: config.clone(),
            log: ConnectionLog::new::<P>(dial.address(), "data"),
            dial,
            why: Loss::NotYet,
            protocol: PhantomData,
        };
        tokio::spawn(driver.run());
        Self {
            shared,
            encoder: Mutex::new(config.encoder()),
            patience: commands.call_timeout,
            _commands: commands,
        }
    }

    /// Waits until there is a connection, for no longer than the call timeout. A robot sends what it is
    /// asked for to the data connections that there are: wait for this one before asking.
    ///
    /// Cancellation safe.
    ///
    /// # Errors
    ///
    /// [`DataError::NotConnected`] or [`DataError::Closed`].
    pub async fn connected(&self) -> Result<(), DataError> {
        let mut states = self.shared.lock().connection.subscribe();
        let settled = |state: &ConnectionState| state.is_connected() || state.is_closed();
        // An error means that it was in no time, or that there is nobody left to say it.
        let _ = timeout(self.patience, states.wait_for(settled)).await;
        match self.state() {
            ConnectionState::Connected { .. } => Ok(()),
            ConnectionState::Connecting { why, .. } => Err(DataError::NotConnected(why)),
            ConnectionState::Closed { why, .. } => Err(DataError::Closed(why)),
        }
    }

    /// The next frame.
    ///
    /// Cancellation safe.
    ///
    /// # Errors
    ///
    /// [`DataError`]; unless it is [`DataError::Closed`], the next call goes on with the next frame.
    pub async fn recv(&self) -> Result<StreamFrame, DataError> {
        loop {
            let came = self.shared.came.notified();
            if let Some(taken) = self.shared.take() {
                return taken;
            }
            came.await;
        }
    }

    /// The frames of one stream from now on, in a queue of their own; they no longer come to [`recv`](Self::recv).
    ///
    /// As long as anybody has subscribed, the robot is read whatever the app takes: a frame of another stream that
    /// finds the one before it not yet received is dropped, and [`missed`](Self::missed) counts it.
    #[must_use]
    pub fn subscribe<T: StreamContent>(&self, code: u16) -> Subscription<T> {
        let allowance = P::DEFAULTS.limits.json();
        Subscription::new(Arc::clone(&self.shared), code, allowance)
    }

    /// How many frames to which nobody had subscribed have been dropped since this was last asked.
    #[must_use]
    pub fn missed(&self) -> u64 {
        std::mem::take(&mut self.shared.lock().takers.skipped)
    }

    /// Sends a frame with a JSON object, without an envelope; all else is as with [`send`](Self::send).
    ///
    /// # Errors
    ///
    /// [`DataError::Invalid`] if it breaks one of its own constraints, and those of [`send`](Self::send).
    pub async fn send_json<M: Message>(
        &self,
        code: u16,
        id: u32,
        content: &M,
    ) -> Result<(), DataError> {
        content.check().map_err(DataError::Invalid)?;
        self.send(code, id, &to_vec(content)).await
    }

    /// Sends a frame of raw bytes: `code` says what they belong to, `id` which request they answer
    /// or prepare. Resolves when the socket has taken it. Without a connection it waits for one, for no
    /// longer than the call timeout.
    ///
    /// Cancellation: a frame that has not been begun is not sent; one that has been begun is finished.
    ///
    /// # Errors
    ///
    /// [`DataError::Lost`] if the connection was lost meanwhile, or had been after something was sent
    /// over it: send again from where the robot can go on. [`DataError::NotConnected`],
    /// [`DataError::Closed`] and [`DataError::Frame`] if nothing was sent.
    pub async fn send(&self, code: u16, id: u32, data: &[u8]) -> Result<(), DataError> {
        let deadline = after(clock::now(), self.patience);
        let frame = FrameId {
            response: false,
            kind: P::STREAM,
            code,
            id,
        };
        let mut encoder = self.encoder.lock().await;
        let mut bytes = Vec::new();
        encoder.bytes(&mut bytes, frame, data)?;
        give_way(data.len()).await;
        let mut pending = PendingFrame {
            shared: &self.shared,
            bytes: Some(bytes),
        };
        loop {
            let went = self.shared.went.notified();
            let state = match pending.look() {
                Ok(result) => return result,
                Err(state) => state,
            };
            let ConnectionState::Connecting { why, .. } = state else {
                went.await;
                continue;
            };
            if timeout_at(deadline.into(), went).await.is_err() && pending.take_back() {
                return Err(DataError::NotConnected(why));
            }
        }
    }

    /// Whether there is a connection at this moment, and why not.
    #[must_use]
    pub fn state(&self) -> ConnectionState {
        self.shared.lock().connection.now()
    }

    /// The states of the connection: the present one first, and then each that it comes to.
    #[must_use]
    pub fn states(&self) -> ConnectionStates {
        ConnectionStates::new(self.shared.lock().connection.subscribe())
    }

    /// Waits until the connection has ended for good, and says why.
    ///
    /// Cancellation safe.
    pub async fn closed(&self) -> Loss {
        let states = self.shared.lock().connection.subscribe();
        closed(states).await
    }

    /// Closes the connection. A frame that is being sent is finished, if the robot takes it within a
    /// second. What has arrived can still be received.
    pub fn close(&self) {
        self.shared.lock().connection.close(Loss::Here);
        self.shared.tell();
        self.shared.end.notify_one();
    }
}

/// One frame's pending to be sent.
struct PendingFrame<'a> {
    shared: &'a Shared,
    /// Until it is in the outbox.
    bytes: Option<Vec<u8>>,
}

impl PendingFrame<'_> {
    /// Goes on. What has become of the frame, or else the state in which it waits.
    fn look(&mut self) -> Result<Result<(), DataError>, ConnectionState> {
        let mut state = self.shared.lock();
        let now = state.connection.now();
        if self.bytes.is_some() {
            if let ConnectionState::Closed { why, .. } = now {
                return Ok(Err(DataError::Closed(why)));
            }
            if let Some(loss) = state.unsure.take() {
                return Ok(Err(DataError::Lost(loss)));
            }
            // There may be one still that was given up on its way.
            if matches!(state.outbox, Outbox::Empty)
                && let Some(bytes) = self.bytes.take()
            {
                self.shared.begin(&mut state, bytes);
            }
            return Err(now);
        }
        match (&state.outbox, now) {
            (Outbox::Done(done), _) => {
                let done = *done;
                state.outbox = Outbox::Empty;
                Ok(done.map_err(DataError::Lost))
            }
            (Outbox::Waiting(_), ConnectionState::Closed { why, .. }) => {
                state.outbox = Outbox::Empty;
                Ok(Err(DataError::Closed(why)))
            }
            _ => Err(now),
        }
    }

    /// Takes the frame back, if it has not been begun.
    fn take_back(&mut self) -> bool {
        if self.bytes.is_some() {
            return true;
        }
        let mut state = self.shared.lock();
        let waiting = matches!(state.outbox, Outbox::Waiting(_));
        if waiting {
            state.outbox = Outbox::Empty;
        }
        waiting
    }
}

/// When nobody waits for it any more.
impl Drop for PendingFrame<'_> {
    fn drop(&mut self) {
        if self.bytes.is_some() {
            return;
        }
        let mut state = self.shared.lock();
        match &mut state.outbox {
            Outbox::Empty => {}
            Outbox::Sending { orphan } => *orphan = true,
            Outbox::Waiting(_) | Outbox::Done(Ok(())) => state.outbox = Outbox::Empty,
            Outbox::Done(Err(loss)) => {
                // The next one is told.
                let loss = *loss;
                state.outbox = Outbox::Empty;
                state.unsure = Some(loss);
            }
        }
    }
}

impl<P: Protocol> Drop for DataConnection<P> {
    fn drop(&mut self) {
        self.close();
    }
}

impl<P: Protocol> fmt::Debug for DataConnection<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DataConnection")
            .field("protocol", &P::NAME)
            .field("state", &self.state())
            .finish_non_exhaustive()
    }
}
