//! A connection of an app to the data port.
//!
//! One task connects, reads and writes. There is room for one frame in each direction between the task and the app, so
//! a slow side slows the other one down and memory does not grow. A subscription holds a few frames and drops the
//! oldest.

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

/// A connection to a robot's data port, for frames of raw bytes in both directions.
///
/// It is made in the background when the command connection is up, and again after a loss, as
/// [`ClientConfig::reconnect`](super::ClientConfig::reconnect) specifies. In the protocol, only the address links it to
/// the command connection. A robot can assign it to an app only while one command connection comes from that address.
/// So it is also made again after each new command connection ([`Loss::Renewed`]), and ends with the command
/// connection.
///
/// The protocol does not acknowledge these frames. A frame in flight at a loss may have arrived. [`DataError::Lost`]
/// reports the loss to the receiver, and to the sender if anything was sent. Then both continue over the next
/// connection. No frame is sent twice.
///
/// One frame is buffered in each direction, unless the app has a [subscription](Self::subscribe). Sending waits until
/// the socket has taken the frame. While the app does not receive, the robot is not read, and a loss may be noticed
/// late. A stalled frame, or a robot that does not read, loses the connection after
/// [`ClientConfig::stall_timeout`](super::ClientConfig::stall_timeout).
///
/// Closed when dropped. Keeps the command connection open.
pub struct DataConnection<P: Protocol> {
    shared: Arc<Shared>,
    /// Locked while a frame is sent, so that frames are sent one at a time.
    encoder: Mutex<Encoder<P>>,
    /// Longest wait for a connection.
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

    /// Waits until there is a connection, for up to the call timeout. A robot sends streams only to existing data
    /// connections, so wait here before you request a stream.
    ///
    /// Cancellation safe.
    ///
    /// # Errors
    ///
    /// [`DataError::NotConnected`] or [`DataError::Closed`].
    pub async fn connected(&self) -> Result<(), DataError> {
        let mut states = self.shared.lock().connection.subscribe();
        let settled = |state: &ConnectionState| state.is_connected() || state.is_closed();
        // An error means a timeout, or the end of the connection.
        let _ = timeout(self.patience, states.wait_for(settled)).await;
        match self.state() {
            ConnectionState::Connected { .. } => Ok(()),
            ConnectionState::Connecting { why, .. } => Err(DataError::NotConnected(why)),
            ConnectionState::Closed { why, .. } => Err(DataError::Closed(why)),
        }
    }

    /// Returns the next frame.
    ///
    /// Cancellation safe.
    ///
    /// # Errors
    ///
    /// [`DataError`]. After any error except [`DataError::Closed`], the next call continues with the next frame.
    pub async fn recv(&self) -> Result<StreamFrame, DataError> {
        loop {
            let came = self.shared.inbox_changed.notified();
            if let Some(taken) = self.shared.take() {
                return taken;
            }
            came.await;
        }
    }

    /// Subscribes to one stream: returns a receiver with its own queue. The frames no longer come to
    /// [`recv`](Self::recv).
    ///
    /// While there are subscriptions, the robot is always read. A frame of another stream is dropped if the frame
    /// before it has not been received, and [`missed`](Self::missed) counts it.
    #[must_use]
    pub fn subscribe<T: StreamContent>(&self, code: u16) -> Subscription<T> {
        let allowance = P::DEFAULTS.limits.json();
        Subscription::new(Arc::clone(&self.shared), code, allowance)
    }

    /// Returns the number of dropped frames without a subscription since the last call.
    #[must_use]
    pub fn missed(&self) -> u64 {
        std::mem::take(&mut self.shared.lock().subscriptions.skipped)
    }

    /// Sends a frame with a JSON object, without an envelope, like [`send`](Self::send).
    ///
    /// # Errors
    ///
    /// [`DataError::Invalid`] if it violates a constraint, and the errors of [`send`](Self::send).
    pub async fn send_json<M: Message>(
        &self,
        code: u16,
        id: u32,
        content: &M,
    ) -> Result<(), DataError> {
        content.check().map_err(DataError::Invalid)?;
        self.send(code, id, &to_vec(content)).await
    }

    /// Sends a frame of raw bytes. `code` is the stream, `id` the request that it belongs to. Resolves when the socket
    /// has taken the frame. Waits for a connection for up to the call timeout.
    ///
    /// Cancellation: a frame is either not sent or sent completely.
    ///
    /// # Errors
    ///
    /// [`DataError::Lost`] if the connection was lost meanwhile, or earlier after something was sent: send again from a
    /// position at which the robot can continue. [`DataError::NotConnected`], [`DataError::Closed`] and
    /// [`DataError::Frame`] if nothing was sent.
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
            let went = self.shared.outbox_changed.notified();
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

    /// Returns the state of the connection, with the reason if there is none.
    #[must_use]
    pub fn state(&self) -> ConnectionState {
        self.shared.lock().connection.now()
    }

    /// Returns the states of the connection: the present one, then each new one.
    #[must_use]
    pub fn states(&self) -> ConnectionStates {
        ConnectionStates::new(self.shared.lock().connection.subscribe())
    }

    /// Waits until the connection has ended for good, and returns the reason.
    ///
    /// Cancellation safe.
    pub async fn closed(&self) -> Loss {
        let states = self.shared.lock().connection.subscribe();
        closed(states).await
    }

    /// Closes the connection. A frame that is being sent is completed if the robot takes it within a second. Frames
    /// that have arrived can still be received.
    pub fn close(&self) {
        self.shared.lock().connection.close(Loss::Here);
        self.shared.notify_all();
        self.shared.closing.notify_one();
    }
}

/// A frame that waits to be sent.
struct PendingFrame<'a> {
    shared: &'a Shared,
    /// Set until the frame is in the outbox.
    bytes: Option<Vec<u8>>,
}

impl PendingFrame<'_> {
    /// Continues. Returns the result for the frame, or the state in which it waits.
    fn look(&mut self) -> Result<Result<(), DataError>, ConnectionState> {
        let mut state = self.shared.lock();
        let now = state.connection.now();
        if self.bytes.is_some() {
            if let ConnectionState::Closed { why, .. } = now {
                return Ok(Err(DataError::Closed(why)));
            }
            if let Some(loss) = state.sender_loss.take() {
                return Ok(Err(DataError::Lost(loss)));
            }
            // The outbox may still hold a frame whose caller has given up.
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

    /// Takes the frame back if sending has not started.
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

/// The caller has given up.
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
                // The next sender gets the loss.
                let loss = *loss;
                state.outbox = Outbox::Empty;
                state.sender_loss = Some(loss);
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
