//! Making connections, and making them again.

use super::config::{Backoff, ClientConfig};
use super::error::ConnectError;
use crate::link::{Transport, prepare};
use std::io;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::time::timeout;

/// No wait between two attempts to connect is longer, whatever is configured.
const LONGEST_WAIT: Duration = Duration::from_secs(24 * 60 * 60);

/// Makes a connection, each time it is asked to.
pub(super) trait Dial: Send + 'static {
    /// What the connection runs over.
    type Transport: Transport;

    /// Whom it connects to, for logs.
    fn address(&self) -> String;

    fn dial(&mut self) -> impl Future<Output = Result<Self::Transport, ConnectError>> + Send;
}

/// Connects with TCP.
pub(super) struct TcpDial {
    host: String,
    port: u16,
    limit: Duration,
    keepalive: Option<Duration>,
}

impl TcpDial {
    pub(super) fn new(host: &str, port: u16, config: &ClientConfig) -> Self {
        Self {
            host: host.to_owned(),
            port,
            limit: config.connect_timeout,
            keepalive: config.connection.keepalive,
        }
    }
}

impl Dial for TcpDial {
    type Transport = TcpStream;

    fn address(&self) -> String {
        format!("{}:{}", self.host, self.port)
    }

    async fn dial(&mut self) -> Result<TcpStream, ConnectError> {
        let connecting = async {
            let stream = TcpStream::connect((self.host.as_str(), self.port)).await?;
            prepare(&stream, self.keepalive)?;
            Ok(stream)
        };
        within(self.limit, connecting, || self.address()).await
    }
}

/// Connects by a function of the user.
pub(super) struct CustomDial<D> {
    pub(super) dial: D,
    /// What errors name.
    pub(super) address: String,
    pub(super) limit: Duration,
}

impl<D> CustomDial<D> {
    pub(super) fn new(dial: D, (host, port): (&str, u16), config: &ClientConfig) -> Self {
        Self {
            dial,
            address: format!("{host}:{port}"),
            limit: config.connect_timeout,
        }
    }
}

impl<D, F, S> Dial for CustomDial<D>
where
    D: FnMut() -> F + Send + 'static,
    F: Future<Output = io::Result<S>> + Send,
    S: Transport,
{
    type Transport = S;

    fn address(&self) -> String {
        self.address.clone()
    }

    async fn dial(&mut self) -> Result<S, ConnectError> {
        let dialling = (self.dial)();
        within(self.limit, dialling, || self.address.clone()).await
    }
}

/// One attempt, of which an error names the `address`.
async fn within<S>(
    limit: Duration,
    attempt: impl Future<Output = io::Result<S>>,
    address: impl Fn() -> String,
) -> Result<S, ConnectError> {
    match timeout(limit, attempt).await {
        Err(_) => Err(ConnectError::Timeout { address: address() }),
        Ok(connected) => connected.map_err(|source| ConnectError::Io {
            address: address(),
            source,
        }),
    }
}

/// How connecting has gone of late.
pub(super) struct Reconnect {
    /// `None` for the first attempt alone.
    backoff: Option<Backoff>,
    /// Nothing has been attempted yet: there is nothing to wait for.
    first: bool,
    /// Attempts in a row that did not connect.
    failed: u32,
    /// Waits since the robot was last heard.
    waits: u32,
}

impl Reconnect {
    pub(super) fn new(backoff: Option<Backoff>) -> Self {
        Self {
            backoff,
            first: true,
            failed: 0,
            waits: 0,
        }
    }

    /// An attempt has failed.
    pub(super) fn failed(&mut self) {
        self.failed = self.failed.saturating_add(1);
    }

    /// An attempt has connected, and the connection has ended. A robot that was `heard` on it is
    /// tried at once; one that only accepts and closes is waited for longer and longer.
    pub(super) fn connected(&mut self, heard: bool) {
        self.first = false;
        self.failed = 0;
        if heard {
            self.waits = 0;
        }
    }

    /// How long to wait before the next attempt; `None` to give up.
    pub(super) fn next(&mut self) -> Option<Duration> {
        if std::mem::take(&mut self.first) {
            return Some(Duration::ZERO);
        }
        let backoff = self.backoff?;
        if backoff
            .attempts
            .is_some_and(|attempts| self.failed >= attempts)
        {
            return None;
        }
        let doubled = backoff.first.saturating_mul(1 << self.waits.min(20));
        self.waits = self.waits.saturating_add(1);
        let wait = doubled.min(backoff.longest).min(LONGEST_WAIT);
        Some(wait.mul_f64(1.0 - 0.25 * chance()))
    }
}

/// A number from 0 to 1 by chance, good enough to keep apps apart.
fn chance() -> f64 {
    use std::hash::{BuildHasher, RandomState};
    let bits = RandomState::new().hash_one(0_u8) >> 32;
    f64::from(u32::try_from(bits).unwrap_or(0)) / f64::from(u32::MAX)
}
