//! What a handler is told beside the request.

use std::fmt;
use std::marker::PhantomData;
use std::net::SocketAddr;

/// Which of a server's connections. Never used twice by one server.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ConnectionId(pub(crate) u64);

impl fmt::Display for ConnectionId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// What a handler is told beside the request.
#[derive(Debug)]
pub struct Context<P> {
    /// Address of the app.
    pub peer: SocketAddr,
    /// Connection of the app, as the audience of a report.
    pub connection: ConnectionId,
    /// Message id of the request.
    pub id: u32,
    /// Command code of the request.
    pub code: u16,
    /// When the request was made, in milliseconds since 1970-01-01T00:00:00Z, if it says so.
    pub time_ms: Option<i64>,
    pub(crate) protocol: PhantomData<P>,
}

impl<P> Clone for Context<P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Context<P> {}
