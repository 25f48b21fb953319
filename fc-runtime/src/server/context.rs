//! The context of a request for its handler.

use super::connection_id::ConnectionId;
use super::peer::Peer;
use crate::clock;
use crate::protocol::Protocol;
use crate::refusal::Refusal;
use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Instant;
use tokio::time::sleep_until;

/// The context of a request for its handler.
#[derive(Clone)]
pub struct Context<P: Protocol> {
    /// Address of the app.
    pub peer: SocketAddr,
    /// Connection of the app, as the audience of a report.
    pub connection: ConnectionId,
    /// Message id of the request.
    pub id: u32,
    /// Command code of the request.
    pub code: u16,
    /// Time of the request in milliseconds since 1970-01-01T00:00:00Z, if the envelope contains it.
    pub time_ms: Option<i64>,
    pub(super) app: Arc<Peer<P>>,
    pub(super) deadline: Instant,
}

impl<P: Protocol> Context<P> {
    /// Returns the refusal of a command of the spec that this robot does not implement. It is counted in
    /// [`ServerCounters::calls_not_implemented`](super::ServerCounters::calls_not_implemented) and logged with the
    /// command's name.
    ///
    /// It has the protocol's error result, like an unknown code, because there is no separate result. Its text
    /// distinguishes it.
    #[must_use]
    pub fn not_implemented(&self) -> Refusal {
        self.app.note_not_implemented(self.code);
        Refusal::protocol::<P>("not implemented")
    }

    /// Returns `true` if the app no longer waits for the response: its connection has ended, or the handler timeout has
    /// passed and the app was told. An app that has closed only its sending side still waits.
    #[must_use]
    pub fn is_abandoned(&self) -> bool {
        self.app.is_gone() || clock::now() >= self.deadline
    }

    /// Resolves when [`is_abandoned`](Self::is_abandoned) becomes `true`. The handler of a motion then runs on. With
    /// this method it can stop instead:
    ///
    /// ```
    /// use fc_runtime::{Context, Protocol, Refusal};
    ///
    /// # async fn arrive() {}
    /// # async fn stop_motors() {}
    /// async fn drive<P: Protocol>(context: Context<P>) -> Result<(), Refusal> {
    ///     tokio::select! {
    ///         () = arrive() => Ok(()),
    ///         () = context.abandoned() => {
    ///             stop_motors().await;
    ///             // The caller is gone, so this result is dropped.
    ///             Err(Refusal::timeout::<P>())
    ///         }
    ///     }
    /// }
    /// ```
    ///
    /// Cancellation safe.
    pub async fn abandoned(&self) {
        tokio::select! {
            () = self.app.gone() => {}
            () = sleep_until(self.deadline.into()) => {}
        }
    }
}

impl<P: Protocol> fmt::Debug for Context<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Context")
            .field("peer", &self.peer)
            .field("connection", &self.connection)
            .field("id", &self.id)
            .field("code", &self.code)
            .field("time_ms", &self.time_ms)
            .finish_non_exhaustive()
    }
}
