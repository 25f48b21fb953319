//! The handshake before the first frame, such as that of TLS.

use super::connection_id::ConnectionId;
use super::counters::Counters;
use crate::protocol::Protocol;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::time::timeout;

/// Waits for a handshake, for up to `limit` or until `gone`. A failed handshake is counted and logged, and returns
/// `None`.
pub(super) async fn shake<P: Protocol, S>(
    handshake: impl Future<Output = io::Result<S>>,
    gone: impl Future<Output = ()>,
    limit: Duration,
    counters: &Counters,
    (connection, peer): (ConnectionId, SocketAddr),
) -> Option<S> {
    let shaken = tokio::select! {
        biased;
        shaken = timeout(limit, handshake) => shaken,
        // The connection was replaced, or the server ends.
        () = gone => return None,
    };
    let why = match shaken {
        Ok(Ok(stream)) => return Some(stream),
        Ok(Err(error)) => error.to_string(),
        Err(_) => "it did not come in time".to_owned(),
    };
    counters.handshakes_failed.increment();
    if let Some(held) = counters.limiters.handshakes.admit() {
        let (protocol, connection, held) = (P::NAME, connection.0, held.shown());
        tracing::warn!(protocol, connection, %peer, held, "the handshake failed: {why}");
    }
    None
}
