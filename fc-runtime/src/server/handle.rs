//! The handle of a server: what the robot's own code does with it.

use super::connection_id::ConnectionId;
use super::counters::ServerCounters;
use super::data::{AppStreams, QUEUE};
use super::push::{Acknowledgement, Audience, Push, PushError, Queued};
use super::shared::Shared;
use crate::clock;
use crate::frame::FrameId;
use crate::json::to_vec;
use crate::link::Transport;
use crate::message::{Message, write_enveloped};
use crate::operation::Report;
use crate::protocol::{Protocol, RequestEnvelope};
use crate::session::after;
use crate::stream::prepare;
use crate::sync::lock;
use futures_util::stream::{FuturesUnordered, StreamExt};
use std::fmt;
use std::future::{pending, ready};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::timeout;

/// A handle of a server, for reports, counters and the end. Cheap to clone.
pub struct ServerHandle<P: Protocol> {
    shared: Arc<Shared<P>>,
}

impl<P: Protocol> ServerHandle<P> {
    pub(super) fn new(shared: Arc<Shared<P>>) -> Self {
        Self { shared }
    }

    /// Sends a report to one app or to all that are connected, and waits for what becomes of it.
    ///
    /// The report is encoded once. Each app has a queue of `queued_reports` and `queued_bytes`; when it
    /// is full, the oldest report in it gives way and ends as [`AckOutcome::Dropped`](super::AckOutcome::Dropped),
    /// so that a slow app costs nobody else anything. A report that is not acknowledged in time is
    /// sent again with the same id, as often as its [`AckPolicy`](crate::AckPolicy) says.
    ///
    /// Cancellation: the report is queued before the future first waits; dropping the future then
    /// only means not to hear of the acknowledgements.
    ///
    /// # Errors
    ///
    /// [`PushError`] if it was not even queued.
    pub async fn push<R: Report>(
        &self,
        audience: Audience,
        report: &R,
    ) -> Result<Vec<Acknowledgement>, PushError> {
        let push = self.queue(audience, report)?;
        Ok(std::future::poll_fn(|cx| push.poll(cx)).await)
    }

    fn queue<R: Report>(&self, audience: Audience, report: &R) -> Result<Arc<Push>, PushError> {
        report.check().map_err(PushError::Invalid)?;
        let peers = self.shared.audience(audience)?;
        let envelope = P::Request::at(clock::unix_ms());
        let mut encoder = self.shared.settings.encoder::<P>();
        let body = encoder.prepare(|out| write_enveloped(&envelope, report, out))?;
        let policy = R::ACK.unwrap_or(P::DEFAULTS.ack);
        let push = Arc::new(Push::default());
        for peer in peers {
            let ticket = push.ticket(peer.id);
            peer.push(Queued::new(R::CODE, policy, body.clone(), ticket));
        }
        Ok(push)
    }

    /// Sends a frame of raw bytes to the data connections of one app or of all: `code` says what
    /// they belong to, `id` which request they answer. An app is named by a data connection or by
    /// its command connection.
    ///
    /// The protocol has nothing that ties the two but the address. So a data connection is that of an
    /// app if the app's command connection is the only one that has been open at the same address
    /// while the data connection was. Where there have been several, as behind a router, on one
    /// computer or when the command connection was lost and made again, nothing is sent, and the
    /// error is [`PushError::Ambiguous`]. Then the app has to connect to the data port again while it
    /// is alone at its address, or to send a frame over its data connection:
    /// [`AppStream::connection`](super::AppStream::connection) names the one to send to.
    ///
    /// The bytes are digested once. Each data connection has a short queue; the future waits for
    /// room in all of them, but in none longer than the stall timeout. Gives the number of
    /// connections that took the frame.
    ///
    /// Cancellation: connections whose queue had room have got the frame.
    ///
    /// # Errors
    ///
    /// [`PushError`] if there is no connection to send to, or if it cannot be told which.
    pub async fn send_stream(
        &self,
        audience: Audience,
        code: u16,
        id: u32,
        data: &[u8],
    ) -> Result<usize, PushError> {
        let outboxes = self.shared.data_audience(audience)?;
        let settings = &self.shared.settings;
        let body = prepare(&mut settings.encoder::<P>(), data).await?;
        let frame = FrameId {
            response: false,
            kind: P::STREAM,
            code,
            id,
        };
        let sending: FuturesUnordered<_> = outboxes
            .iter()
            .map(|outbox| timeout(settings.stall.within, outbox.send(frame, body.clone())))
            .collect();
        let sent: Vec<_> = sending.collect().await;
        Ok(sent.into_iter().filter(|sent| *sent == Ok(true)).count())
    }

    /// Sends a frame with a JSON object, without an envelope; all else is as with [`send_stream`](Self::send_stream).
    ///
    /// # Errors
    ///
    /// [`PushError::Invalid`] if it breaks one of its own constraints, and those of [`send_stream`](Self::send_stream).
    pub async fn send_stream_json<M: Message>(
        &self,
        audience: Audience,
        code: u16,
        id: u32,
        content: &M,
    ) -> Result<usize, PushError> {
        content.check().map_err(PushError::Invalid)?;
        self.send_stream(audience, code, id, &to_vec(content)).await
    }

    /// The frames of raw bytes that apps send from now on. While nobody takes them, they are
    /// dropped and counted; while the receiver is busy, apps are not read. A later call takes over.
    #[must_use]
    pub fn streams(&self) -> AppStreams {
        let (sender, receiver) = mpsc::channel(QUEUE);
        *lock(&self.shared.inbox) = Some(sender);
        AppStreams(receiver)
    }

    /// Serves a data connection that was accepted elsewhere, beside those of the data port. `None`
    /// if there are too many connections, or none may come from the address.
    pub fn serve_data<S: Transport>(&self, stream: S, address: SocketAddr) -> Option<ConnectionId> {
        self.shared.serve_data(ready(Ok(stream)), address)
    }

    /// Serves a connection that was accepted elsewhere, such as TLS or a pipe in a test, beside
    /// those of the command port. `None` if there are too many connections, or none may come from the
    /// address.
    pub fn serve<S: Transport>(&self, stream: S, address: SocketAddr) -> Option<ConnectionId> {
        self.shared.serve(ready(Ok(stream)), address)
    }

    /// Serves a connection once its `handshake` has made it, such as that of TLS. It has its place from
    /// now on, with all that limits connections: `None` if there are too many, or none may come from
    /// the address, and the handshake is then not begun; while it lasts, it is a connection over which
    /// nothing has come yet. It may take the
    /// [`header_timeout`](super::ServerConfig::header_timeout). One that fails or comes too late closes the
    /// connection, is counted and logged.
    pub fn serve_after<S, F>(&self, handshake: F, address: SocketAddr) -> Option<ConnectionId>
    where
        S: Transport,
        F: Future<Output = io::Result<S>> + Send + 'static,
    {
        self.shared.serve(handshake, address)
    }

    /// [`serve_after`](Self::serve_after) for a data connection.
    pub fn serve_data_after<S, F>(&self, handshake: F, address: SocketAddr) -> Option<ConnectionId>
    where
        S: Transport,
        F: Future<Output = io::Result<S>> + Send + 'static,
    {
        self.shared.serve_data(handshake, address)
    }

    /// The apps connected at this moment.
    #[must_use]
    pub fn connections(&self) -> Vec<(ConnectionId, SocketAddr)> {
        let peers = lock(&self.shared.peers);
        let mut connections: Vec<_> = peers.values().map(|peer| (peer.id, peer.address)).collect();
        connections.sort_unstable();
        connections
    }

    /// How much memory is held for apps at this moment, in bytes: see
    /// [`ServerConfig::memory`](super::ServerConfig::memory) for what that is.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.shared.budget.held()
    }

    /// What the server has seen so far.
    #[must_use]
    pub fn counters(&self) -> ServerCounters {
        self.shared.counters.read()
    }

    /// Ends the server: accepts nothing more, reads no more requests, answers those that are being
    /// handled, waits for handlers that run on though nobody waits for their answer, and cuts off
    /// after `grace` what is not done by then. Resolves when all is over.
    ///
    /// Never takes longer than `grace`, whatever apps and handlers do, as long as handlers do not
    /// block their threads; also if nobody runs the server, which then ends with the grace. Of several
    /// calls, the earliest end counts.
    ///
    /// Cancellation: the server ends all the same, if it is [run](super::Server::run).
    pub async fn shutdown(&self, grace: Duration) {
        self.shared.stop(after(clock::now(), grace));
        self.shared.over(pending()).await;
    }
}

impl<P: Protocol> Clone for ServerHandle<P> {
    fn clone(&self) -> Self {
        Self::new(Arc::clone(&self.shared))
    }
}

impl<P: Protocol> fmt::Debug for ServerHandle<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ServerHandle")
            .field("protocol", &P::NAME)
            .field("connections", &lock(&self.shared.peers).len())
            .finish_non_exhaustive()
    }
}
