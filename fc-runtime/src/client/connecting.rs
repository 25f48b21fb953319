//! Connecting and reconnecting.

use super::config::{Backoff, ClientConfig};
use super::error::ConnectError;
use crate::link::{Transport, prepare};
use std::io;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::time::timeout;

/// Longest wait between two attempts, whatever the configuration.
const LONGEST_WAIT: Duration = Duration::from_secs(24 * 60 * 60);

/// Creates connections.
pub(super) trait Dial: Send + 'static {
    /// Transport of the connection.
    type Transport: Transport;

    /// Returns the address of the robot, for logs.
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

/// Connects with a function of the user.
pub(super) struct CustomDial<D> {
    pub(super) dial: D,
    /// Address for errors.
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

/// Limits the time of one attempt. Its error contains the `address`.
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

/// The state of reconnecting: past attempts and the next wait.
pub(super) struct Reconnect {
    /// `None` for a single attempt.
    backoff: Option<Backoff>,
    /// `true` before the first attempt, which needs no wait.
    first: bool,
    /// Consecutive attempts that did not connect.
    failed: u32,
    /// Waits since the last received frame.
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

    /// Notes a failed attempt.
    pub(super) fn failed(&mut self) {
        self.failed = self.failed.saturating_add(1);
    }

    /// Notes the end of a connection. If a frame was `heard` on it, the next attempt follows soon. A robot that accepts
    /// and closes connections is tried at growing intervals.
    pub(super) fn connected(&mut self, heard: bool) {
        self.first = false;
        self.failed = 0;
        if heard {
            self.waits = 0;
        }
    }

    /// Returns the wait before the next attempt, or `None` to give up.
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

/// Returns a random number from 0 to 1, good enough to spread the attempts of many apps.
fn chance() -> f64 {
    use std::hash::{BuildHasher, RandomState};
    let bits = RandomState::new().hash_one(0_u8) >> 32;
    f64::from(u32::try_from(bits).unwrap_or(0)) / f64::from(u32::MAX)
}
