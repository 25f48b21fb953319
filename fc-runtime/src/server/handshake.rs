//! The handshake before the first frame, such as that of TLS.

use super::connection_id::ConnectionId;
use super::counters::Counters;
use crate::protocol::Protocol;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::time::timeout;

/// The reason for the end of a handshake.
enum Failed {
    Late,
    Broken(io::Error),
    /// The connection was replaced, or the server ends.
    Gone,
}

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
        shaken = timeout(limit, handshake) => match shaken {
            Ok(done) => done.map_err(Failed::Broken),
            Err(_) => Err(Failed::Late),
        },
        () = gone => Err(Failed::Gone),
    };
    let why = match shaken {
        Ok(stream) => return Some(stream),
        Err(Failed::Gone) => return None,
        Err(Failed::Late) => "it did not come in time".to_owned(),
        Err(Failed::Broken(error)) => error.to_string(),
    };
    counters.handshakes_failed.increment();
    if let Some(held) = counters.limiters.handshakes.admit() {
        let (protocol, connection, held) = (P::NAME, connection.0, held.shown());
        tracing::warn!(protocol, connection, %peer, held, "the handshake failed: {why}");
    }
    None
}
