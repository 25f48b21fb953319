//! The configuration of a client.

use crate::connection_settings::{ConnectionSettings, connection_setters};
use crate::frame::{Decoder, Encoder, Gzip};
use crate::protocol::Protocol;
use crate::wire::Limits;
use std::time::Duration;

/// How to reconnect after a loss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backoff {
    /// Wait before the first attempt.
    pub first: Duration,
    /// Longest wait. Each wait is twice the previous one, and randomly up to a quarter shorter, so that many apps do not
    /// reconnect at once.
    pub longest: Duration,
    /// Consecutive failed attempts before the client gives up; `None` for no limit. An attempt that connects is never a
    /// failed one, even if the connection is lost at once.
    pub attempts: Option<u32>,
}

impl Default for Backoff {
    fn default() -> Self {
        Self {
            first: Duration::from_millis(100),
            longest: Duration::from_secs(10),
            attempts: None,
        }
    }
}

/// Settings of a client. Unset values are the protocol's defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct ClientConfig {
    host: Option<String>,
    pub(super) connect_timeout: Duration,
    call_timeout: Option<Duration>,
    pub(super) reconnect: Option<Backoff>,
    pub(super) connection: ConnectionSettings,
}

impl Default for ClientConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl ClientConfig {
    /// Creates the default settings: three seconds to connect, ten seconds for a stalled frame, reconnection, no
    /// compression.
    #[must_use]
    pub fn new() -> Self {
        Self {
            host: None,
            connect_timeout: Duration::from_secs(3),
            call_timeout: None,
            reconnect: Some(Backoff::default()),
            connection: ConnectionSettings::new(Duration::from_secs(10)),
        }
    }

    connection_setters!();

    /// Sets the name or address of the robot.
    #[must_use]
    pub fn host(mut self, host: impl Into<String>) -> Self {
        self.host = Some(host.into());
        self
    }

    /// Sets the longest time of one attempt to connect.
    #[must_use]
    pub fn connect_timeout(mut self, timeout: Duration) -> Self {
        self.connect_timeout = timeout;
        self
    }

    /// Sets the longest wait of a call for its response. It includes the time to reconnect.
    #[must_use]
    pub fn call_timeout(mut self, timeout: Duration) -> Self {
        self.call_timeout = Some(timeout);
        self
    }

    /// Sets how to reconnect, or `None` to give up after the first loss.
    #[must_use]
    pub fn reconnect(mut self, backoff: impl Into<Option<Backoff>>) -> Self {
        self.reconnect = backoff.into();
        self
    }

    /// Sets how long a connection may make no progress in the middle of a frame, or while the robot does not read; ten
    /// seconds by default. After that time the connection is lost.
    ///
    /// A frame on the command port may take this time plus one second for each 16 KiB received. This ends a frame with
    /// a wrong length, which would swallow the following responses.
    #[must_use]
    pub fn stall_timeout(mut self, timeout: Duration) -> Self {
        self.connection.stall_timeout = timeout;
        self
    }

    /// Sets the limit of report bytes that wait for the app. By default it is the length of the longest body. A report
    /// beyond the limit is not acknowledged, like one beyond `queued_reports`.
    #[must_use]
    pub fn queued_bytes(mut self, limit: usize) -> Self {
        self.connection.queued_bytes = Some(limit);
        self
    }

    fn host_or_default<P: Protocol>(&self) -> &str {
        self.host.as_deref().unwrap_or(P::HOST)
    }

    pub(crate) fn command_address<P: Protocol>(&self) -> (&str, u16) {
        (
            self.host_or_default::<P>(),
            self.connection.command_port::<P>(),
        )
    }

    pub(super) fn data_address<P: Protocol>(&self) -> (&str, u16) {
        (
            self.host_or_default::<P>(),
            self.connection.data_port::<P>(),
        )
    }

    pub(super) fn call_timeout_or_default<P: Protocol>(&self) -> Duration {
        self.call_timeout.unwrap_or(P::DEFAULTS.call_timeout)
    }

    pub(super) fn decoder<P: Protocol>(&self) -> Decoder<P> {
        self.connection.decoder(&self.connection.limits::<P>())
    }

    pub(super) fn encoder<P: Protocol>(&self) -> Encoder<P> {
        self.connection.encoder(&self.connection.limits::<P>())
    }
}
