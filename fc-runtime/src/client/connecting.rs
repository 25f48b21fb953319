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

/// Connects over TCP.
pub(super) fn tcp(
    (host, port): (&str, u16),
    config: &ClientConfig,
) -> impl Dial<Transport = TcpStream> + use<> {
    let target = host.to_owned();
    let keepalive = config.connection.keepalive;
    let dial = move || {
        let target = target.clone();
        async move {
            let stream = TcpStream::connect((target, port)).await?;
            prepare(&stream, keepalive)?;
            Ok(stream)
        }
    };
    Dialer::new(dial, (host, port), config)
}

/// Connects with a function, within the connect timeout.
pub(super) struct Dialer<D> {
    dial: D,
    /// Address for errors and logs.
    address: String,
    limit: Duration,
}

impl<D> Dialer<D> {
    pub(super) fn new(dial: D, (host, port): (&str, u16), config: &ClientConfig) -> Self {
        Self {
            dial,
            address: format!("{host}:{port}"),
            limit: config.connect_timeout,
        }
    }
}

impl<D, F, S> Dial for Dialer<D>
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
        match timeout(self.limit, (self.dial)()).await {
            Err(_) => Err(ConnectError::Timeout {
                address: self.address.clone(),
            }),
            Ok(connected) => connected.map_err(|source| ConnectError::Io {
                address: self.address.clone(),
                source,
            }),
        }
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
