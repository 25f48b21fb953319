//! Settings that clients and servers have in common.

use crate::clock;
use crate::frame::{Decoder, Encoder, Gzip};
use crate::protocol::Protocol;
use crate::wire::Limits;
use std::time::Duration;

/// Settings of a connection. A value of `None` means the protocol's default.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ConnectionSettings {
    pub(crate) command_port: Option<u16>,
    pub(crate) data_port: Option<u16>,
    pub(crate) limits: Option<Limits>,
    pub(crate) queued_bytes: Option<usize>,
    pub(crate) first_id: Option<u32>,
    pub(crate) gzip: Option<Gzip>,
    pub(crate) verify_digest: bool,
    pub(crate) resync: bool,
    pub(crate) stall_timeout: Duration,
    /// Silence before TCP probes the peer; `None` to send no probes.
    pub(crate) keepalive: Option<Duration>,
}

impl ConnectionSettings {
    pub(crate) fn new(stall_timeout: Duration) -> Self {
        Self {
            command_port: None,
            data_port: None,
            limits: None,
            queued_bytes: None,
            first_id: None,
            gzip: None,
            verify_digest: true,
            resync: false,
            stall_timeout,
            keepalive: Some(Duration::from_secs(30)),
        }
    }

    pub(crate) fn command_port<P: Protocol>(&self) -> u16 {
        self.command_port.unwrap_or(P::COMMAND_PORT)
    }

    pub(crate) fn data_port<P: Protocol>(&self) -> u16 {
        self.data_port.unwrap_or(P::DATA_PORT)
    }

    pub(crate) fn limits<P: Protocol>(&self) -> Limits {
        self.limits.unwrap_or(P::DEFAULTS.limits)
    }

    /// Returns the limit of queued report bytes. The default is the length of the longest body.
    pub(crate) fn queued_bytes<P: Protocol>(&self) -> usize {
        let longest = self.limits::<P>().inflated_bytes;
        self.queued_bytes
            .unwrap_or(usize::try_from(longest).unwrap_or(usize::MAX))
    }

    pub(crate) fn first_id(&self) -> u32 {
        self.first_id.unwrap_or_else(clock::first_id)
    }

    pub(crate) fn decoder<P: Protocol>(&self, limits: &Limits) -> Decoder<P> {
        Decoder::new()
            .limits(limits)
            .verify_digest(self.verify_digest)
            .resync(self.resync)
    }

    pub(crate) fn encoder<P: Protocol>(&self, limits: &Limits) -> Encoder<P> {
        Encoder::new()
            .gzip(self.gzip)
            .frame_bytes(limits.frame_bytes)
    }
}

/// Writes the setters that clients and servers have in common, for a configuration with a field `connection`.
macro_rules! connection_setters {
    () => {
        /// Sets the port of commands and reports. A server listens at any free port if this is 0.
        #[must_use]
        pub fn command_port(mut self, port: u16) -> Self {
            self.connection.command_port = Some(port);
            self
        }

        /// Sets the port of streams. A server listens at any free port if this is 0.
        #[must_use]
        pub fn data_port(mut self, port: u16) -> Self {
            self.connection.data_port = Some(port);
            self
        }

        /// Sets the limits of everything that grows with the data of a peer. To change one of them:
        /// `Limits { in_flight: 8, ..P::DEFAULTS.limits }`.
        #[must_use]
        pub fn limits(mut self, limits: Limits) -> Self {
            self.connection.limits = Some(limits);
            self
        }

        /// Sets the message id of the first request of a connection: a call of an app, or a report of a robot.
        ///
        /// By default it is the local time of day, so that a restarted program does not reuse its ids. Set it if all
        /// runs must be identical.
        #[must_use]
        pub fn first_id(mut self, id: u32) -> Self {
            self.connection.first_id = Some(id);
            self
        }

        /// Compresses all messages that are sent. The peer must support compression.
        #[must_use]
        pub fn gzip(mut self, gzip: impl Into<Option<Gzip>>) -> Self {
            self.connection.gzip = gzip.into();
            self
        }

        /// Sets whether the digests of received frames are verified; `true` by default.
        #[must_use]
        pub fn verify_digest(mut self, verify: bool) -> Self {
            self.connection.verify_digest = verify;
            self
        }

        /// Sets whether to search for the next frame after bytes that are not a frame; `false` by default. Without the
        /// search, the connection is closed.
        #[must_use]
        pub fn resync(mut self, resync: bool) -> Self {
            self.connection.resync = resync;
            self
        }

        /// Sets the silence before TCP checks that the peer is still there; `None` for no checks, 30 seconds by default.
        ///
        /// On Linux and Android, a connection to a vanished peer ends after twice that time. On other systems it ends
        /// somewhat later.
        #[must_use]
        pub fn keepalive(mut self, silence: Option<Duration>) -> Self {
            self.connection.keepalive = silence;
            self
        }
    };
}

pub(crate) use connection_setters;
