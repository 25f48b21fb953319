//! What a client can be told beforehand.

use crate::clock;
use crate::frame::{Decoder, Encoder, Gzip};
use crate::link::KEEPALIVE;
use crate::protocol::Protocol;
use crate::wire::Limits;
use std::time::Duration;

/// How to come back after a connection has been lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backoff {
    /// Wait before the first attempt.
    pub first: Duration,
    /// Longest wait; each one is twice the one before, and up to a quarter shorter by chance, so
    /// that many apps do not come back at once.
    pub longest: Duration,
    /// Failed attempts in a row before the connection is given up; `None` to go on for ever. An
    /// attempt that connects is none of them, however soon the connection is lost again.
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

/// What a client can be told beforehand. Whatever is not set is the protocol's default.
#[derive(Clone, Debug, PartialEq)]
pub struct ClientConfig {
    host: Option<String>,
    command_port: Option<u16>,
    data_port: Option<u16>,
    connect_timeout: Duration,
    call_timeout: Option<Duration>,
    reconnect: Option<Backoff>,
    keepalive: Option<Duration>,
    stall_timeout: Duration,
    limits: Option<Limits>,
    queued_bytes: Option<usize>,
    first_id: Option<u32>,
    gzip: Option<Gzip>,
    verify_digest: bool,
    resync: bool,
}

impl Default for ClientConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl ClientConfig {
    /// The protocol's defaults; three seconds to connect, ten for a frame that does not go on;
    /// reconnecting, nothing compressed.
    #[must_use]
    pub fn new() -> Self {
        Self {
            host: None,
            command_port: None,
            data_port: None,
            connect_timeout: Duration::from_secs(3),
            call_timeout: None,
            reconnect: Some(Backoff::default()),
            keepalive: Some(KEEPALIVE),
            stall_timeout: Duration::from_secs(10),
            limits: None,
            queued_bytes: None,
            first_id: None,
            gzip: None,
            verify_digest: true,
            resync: false,
        }
    }

    /// Name or address of the robot.
    #[must_use]
    pub fn host(mut self, host: impl Into<String>) -> Self {
        self.host = Some(host.into());
        self
    }

    /// Port of commands and reports.
    #[must_use]
    pub fn command_port(mut self, port: u16) -> Self {
        self.command_port = Some(port);
        self
    }

    /// Port of streams.
    #[must_use]
    pub fn data_port(mut self, port: u16) -> Self {
        self.data_port = Some(port);
        self
    }

    /// How long one attempt to connect may take.
    #[must_use]
    pub fn connect_timeout(mut self, timeout: Duration) -> Self {
        self.connect_timeout = timeout;
        self
    }

    /// How long a call waits for its response, reconnecting included.
    #[must_use]
    pub fn call_timeout(mut self, timeout: Duration) -> Self {
        self.call_timeout = Some(timeout);
        self
    }

    /// How to reconnect, or `None` to give up with the first loss.
    #[must_use]
    pub fn reconnect(mut self, backoff: impl Into<Option<Backoff>>) -> Self {
        self.reconnect = backoff.into();
        self
    }

    /// After how much silence TCP asks whether the robot is still there (thirty seconds by default),
    /// or `None` not to ask. Where the system allows it (Linux, Android), a connection whose robot is
    /// gone without a word ends after twice that time, otherwise somewhat later.
    #[must_use]
    pub fn keepalive(mut self, silence: Option<Duration>) -> Self {
        self.keepalive = silence;
        self
    }

    /// How long a connection may make no progress, in the middle of a frame or while the robot has
    /// something to read, before it is given up and, as configured, made again; ten seconds by
    /// default. On the command port a frame may take that long in all, and a second more for each
    /// 16 KiB of it that have come: answers that a wrong length swallows are no progress.
    #[must_use]
    pub fn stall_timeout(mut self, timeout: Duration) -> Self {
        self.stall_timeout = timeout;
        self
    }

    /// Bounds of everything that grows with what the robot sends. To change one of them:
    /// `Limits { in_flight: 8, ..P::DEFAULTS.limits }`.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Self {
        self.limits = Some(limits);
        self
    }

    /// Most bytes of reports that wait for the app; as many as the longest body may have, unless
    /// set. A report beyond it is left unacknowledged, like one beyond `queued_reports`.
    #[must_use]
    pub fn queued_bytes(mut self, limit: usize) -> Self {
        self.queued_bytes = Some(limit);
        self
    }

    /// Message id of the first call; the local time of day unless set, so that an app that
    /// restarts does not use its ids again. Set it where runs have to be the same each time.
    #[must_use]
    pub fn first_id(mut self, id: u32) -> Self {
        self.first_id = Some(id);
        self
    }

    /// Compresses requests, for robots known to take it.
    #[must_use]
    pub fn gzip(mut self, gzip: impl Into<Option<Gzip>>) -> Self {
        self.gzip = gzip.into();
        self
    }

    /// Whether to verify the digests of what is received (the default).
    #[must_use]
    pub fn verify_digest(mut self, verify: bool) -> Self {
        self.verify_digest = verify;
        self
    }

    /// Whether to search for the next frame where one should begin and does not, instead of
    /// closing the connection (the default).
    #[must_use]
    pub fn resync(mut self, resync: bool) -> Self {
        self.resync = resync;
        self
    }

    pub(super) fn host_or<P: Protocol>(&self) -> &str {
        self.host.as_deref().unwrap_or(P::HOST)
    }

    pub(crate) fn command_address<P: Protocol>(&self) -> (&str, u16) {
        (
            self.host_or::<P>(),
            self.command_port.unwrap_or(P::COMMAND_PORT),
        )
    }

    pub(super) fn data_address<P: Protocol>(&self) -> (&str, u16) {
        (self.host_or::<P>(), self.data_port.unwrap_or(P::DATA_PORT))
    }

    pub(super) fn connect_timeout_value(&self) -> Duration {
        self.connect_timeout
    }

    pub(super) fn keepalive_value(&self) -> Option<Duration> {
        self.keepalive
    }

    pub(super) fn stall_timeout_value(&self) -> Duration {
        self.stall_timeout
    }

    pub(super) fn call_timeout_or<P: Protocol>(&self) -> Duration {
        self.call_timeout.unwrap_or(P::DEFAULTS.call_timeout)
    }

    pub(super) fn backoff(&self) -> Option<Backoff> {
        self.reconnect
    }

    pub(super) fn limits_or<P: Protocol>(&self) -> Limits {
        self.limits.unwrap_or(P::DEFAULTS.limits)
    }

    pub(super) fn queued_bytes_or<P: Protocol>(&self) -> usize {
        let longest = self.limits_or::<P>().inflated_bytes;
        self.queued_bytes
            .unwrap_or(usize::try_from(longest).unwrap_or(usize::MAX))
    }

    pub(super) fn first_id_or_now(&self) -> u32 {
        self.first_id.unwrap_or_else(clock::first_id)
    }

    pub(super) fn decoder<P: Protocol>(&self) -> Decoder<P> {
        Decoder::new()
            .limits(&self.limits_or::<P>())
            .verify_digest(self.verify_digest)
            .resync(self.resync)
    }

    pub(super) fn encoder<P: Protocol>(&self) -> Encoder<P> {
        Encoder::new()
            .gzip(self.gzip)
            .frame_bytes(self.limits_or::<P>().frame_bytes)
    }
}
