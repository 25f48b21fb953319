//! The handle of a server, for the robot's own code.

use super::connection_id::ConnectionId;
use super::counters::ServerCounters;
use super::data::{AppStreams, QUEUE};
use super::push::{Acknowledgement, Audience, Outcome, PushError, Queued};
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

/// A handle of a server for reports, counters and shutdown. Cheap to clone.
#[derive(Clone)]
pub struct ServerHandle<P: Protocol> {
    shared: Arc<Shared<P>>,
}

impl<P: Protocol> ServerHandle<P> {
    pub(super) fn new(shared: Arc<Shared<P>>) -> Self {
        Self { shared }
    }

    /// Sends a report to one app or to all connected apps, and waits for the outcomes.
    ///
    /// The report is encoded once. Each app has a queue, limited by `queued_reports` and `queued_bytes`. If it is full,
    /// the oldest report is dropped and ends as [`AckOutcome::Dropped`](super::AckOutcome::Dropped), so a slow app does
    /// not affect others. A report without acknowledgement is sent again with the same id, as its
    /// [`AckPolicy`](crate::AckPolicy) specifies.
    ///
    /// Cancellation: the report is queued before the future waits. Dropping the future loses only the outcomes.
    ///
    /// # Errors
    ///
    /// [`PushError`] if the report was not queued.
    pub async fn push<R: Report>(
        &self,
        audience: Audience,
        report: &R,
    ) -> Result<Vec<Acknowledgement>, PushError> {
        let outcomes = self.queue(audience, report)?.into_iter();
        let ended: FuturesUnordered<_> = outcomes.map(Outcome::ended).collect();
        Ok(ended.collect().await)
    }

    /// Queues a report for each app.
    fn queue<R: Report>(&self, audience: Audience, report: &R) -> Result<Vec<Outcome>, PushError> {
        report.check().map_err(PushError::Invalid)?;
        let peers = self.shared.audience(audience)?;
        let envelope = P::Request::at(clock::unix_ms());
        let mut encoder = self.shared.settings.encoder::<P>();
        let body = encoder.prepare(|out| write_enveloped(&envelope, report, out))?;
        let policy = R::ACK.unwrap_or(P::DEFAULTS.ack);
        let outcomes = peers.into_iter().map(|peer| {
            let (queued, outcome) = Queued::new(R::CODE, policy, body.clone(), peer.id);
            peer.push(queued);
            outcome
        });
        Ok(outcomes.collect())
    }

    /// Sends a frame of raw bytes to the data connections of one app or of all apps. `code` is the stream, `id` the
    /// request that it answers. An app is identified by a data connection or by its command connection.
    ///
    /// In the protocol, only the address links the two. A data connection belongs to an app if the app's command
    /// connection was the only one at that address since the data connection opened. With several, as behind a router,
    /// on one computer or after a reconnection, nothing is sent, and the error is [`PushError::Ambiguous`]. Then the
    /// app must make its data connection again while it is alone at its address, or send a frame over it:
    /// [`AppStream::connection`](super::AppStream::connection) is the connection to send to.
    ///
    /// The bytes are digested once. Each data connection has a short queue. The future waits for room in all of them,
    /// but in each no longer than the stall timeout. Returns the number of connections that took the frame.
    ///
    /// Cancellation: connections with room in their queue have got the frame.
    ///
    /// # Errors
    ///
    /// [`PushError`] if there is no connection to send to, or if it is ambiguous.
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

    /// Sends a frame with a JSON object, without an envelope, like [`send_stream`](Self::send_stream).
    ///
    /// # Errors
    ///
    /// [`PushError::Invalid`] if it violates a constraint, and the errors of [`send_stream`](Self::send_stream).
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

    /// Returns a receiver of frames of raw bytes from apps. Without a receiver, frames are dropped and counted. While
    /// the receiver is busy, apps are not read. A later call replaces the receiver.
    #[must_use]
    pub fn streams(&self) -> AppStreams {
        let (sender, receiver) = mpsc::channel(QUEUE);
        *lock(&self.shared.inbox) = Some(sender);
        AppStreams(receiver)
    }

    /// Serves a data connection that was accepted elsewhere, like one of the data port. Returns `None` if there are too
    /// many connections, or the address may not connect.
    pub fn serve_data<S: Transport>(&self, stream: S, address: SocketAddr) -> Option<ConnectionId> {
        self.shared.serve_data(ready(Ok(stream)), address)
    }

    /// Serves a connection that was accepted elsewhere, such as TLS or a pipe in a test, like one of the command port.
    /// Returns `None` if there are too many connections, or the address may not connect.
    pub fn serve<S: Transport>(&self, stream: S, address: SocketAddr) -> Option<ConnectionId> {
        self.shared.serve(ready(Ok(stream)), address)
    }

    /// Serves a connection after its `handshake`, such as that of TLS. It counts for all limits from now on. Returns
    /// `None` without a handshake if there are too many connections, or the address may not connect. During the
    /// handshake it counts as a connection without received data. The handshake may take the
    /// [`header_timeout`](super::ServerConfig::header_timeout). A failed or late handshake closes the connection, and
    /// is counted and logged.
    pub fn serve_after<S, F>(&self, handshake: F, address: SocketAddr) -> Option<ConnectionId>
    where
        S: Transport,
        F: Future<Output = io::Result<S>> + Send + 'static,
    {
        self.shared.serve(handshake, address)
    }

    /// Serves a data connection after its handshake, like [`serve_after`](Self::serve_after).
    pub fn serve_data_after<S, F>(&self, handshake: F, address: SocketAddr) -> Option<ConnectionId>
    where
        S: Transport,
        F: Future<Output = io::Result<S>> + Send + 'static,
    {
        self.shared.serve_data(handshake, address)
    }

    /// Returns the connected apps.
    #[must_use]
    pub fn connections(&self) -> Vec<(ConnectionId, SocketAddr)> {
        let peers = lock(&self.shared.peers);
        let mut connections: Vec<_> = peers.values().map(|peer| (peer.id, peer.address)).collect();
        connections.sort_unstable();
        connections
    }

    /// Returns the memory held for apps, in bytes; see [`ServerConfig::memory`](super::ServerConfig::memory).
    #[must_use]
    pub fn memory(&self) -> usize {
        self.shared.budget.held()
    }

    /// Returns the counters of the server.
    #[must_use]
    pub fn counters(&self) -> ServerCounters {
        self.shared.counters.read()
    }

    /// Ends the server: accepts no connections, reads no requests, answers running requests, waits for detached
    /// handlers, and aborts everything after `grace`. Resolves at the end.
    ///
    /// Takes no longer than `grace`, whatever apps and handlers do, as long as handlers do not block their threads. It
    /// also ends if the server is not run. Of several calls, the earliest end applies.
    ///
    /// Cancellation: the server ends nevertheless, if it is [run](super::Server::run).
    pub async fn shutdown(&self, grace: Duration) {
        self.shared.stop(after(clock::now(), grace));
        self.shared.over(pending()).await;
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
