//! The configuration of a server.

use super::allow::Allowed;
use super::network::Network;
use crate::connection_settings::{ConnectionSettings, connection_setters};
use crate::frame::{Decoder, Encoder, Gzip, Work};
use crate::operation::Effect;
use crate::protocol::Protocol;
use crate::rate::MinimumRate;
use crate::wire::Limits;
use std::net::{IpAddr, Ipv4Addr};
use std::time::Duration;

/// Default limit of connections from one address at each port.
const PER_ADDRESS: usize = 8;

/// Default limit of handlers that run on without a waiting app.
const ABANDONED: usize = 64;

/// Default limit of the memory held for apps, in bytes.
const MEMORY: usize = 256 << 20;

/// Settings of a server. Unset values are the protocol's defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct ServerConfig {
    pub(super) address: IpAddr,
    pub(super) connection: ConnectionSettings,
    handler_timeout: Option<Duration>,
    max_age: MaxAge,
    connections_per_address: usize,
    allowed: Allowed,
    abandoned_handlers: usize,
    memory: usize,
    header_timeout: Duration,
    least_rate: u32,
    idle_timeout: Option<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum MaxAge {
    Default,
    Set(Option<Duration>),
}

impl Default for ServerConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl ServerConfig {
    /// Creates the default settings: all addresses of the machine, no compression, five seconds for a header, thirty
    /// seconds for a stalled peer. A frame must transfer at least one KiB per second. There is no limit between frames.
    #[must_use]
    pub fn new() -> Self {
        Self {
            address: IpAddr::V4(Ipv4Addr::UNSPECIFIED),
            connection: ConnectionSettings::new(Duration::from_secs(30)),
            handler_timeout: None,
            max_age: MaxAge::Default,
            connections_per_address: PER_ADDRESS,
            allowed: Allowed::default(),
            abandoned_handlers: ABANDONED,
            memory: MEMORY,
            header_timeout: Duration::from_secs(5),
            least_rate: 1024,
            idle_timeout: None,
        }
    }

    connection_setters!();

    /// Sets the address to listen at.
    #[must_use]
    pub fn address(mut self, address: impl Into<IpAddr>) -> Self {
        self.address = address.into();
        self
    }

    /// Sets the longest time of a handler before the app is answered with the timeout result.
    /// [`Request::handle`](super::Request::handle) describes the further fate of the handler.
    #[must_use]
    pub fn handler_timeout(mut self, timeout: Duration) -> Self {
        self.handler_timeout = Some(timeout);
        self
    }

    /// Sets the largest age of a request, by the time in its envelope; `None` for any age.
    #[must_use]
    pub fn max_age(mut self, age: Option<Duration>) -> Self {
        self.max_age = MaxAge::Set(age);
        self
    }

    /// Sets the limit of report bytes that wait for one app or its acknowledgement. By default it is the length of the
    /// longest body. If a new report does not fit, the oldest unsent reports are dropped, and if that is not enough,
    /// the new one.
    #[must_use]
    pub fn queued_bytes(mut self, limit: usize) -> Self {
        self.connection.queued_bytes = Some(limit);
        self
    }

    /// Sets the limit of connections from one address at each port; 8 by default. Apps behind one router share an
    /// address, so raise it for them.
    ///
    /// A further connection, from an address or in total, replaces a connection over which no data has been received,
    /// if there is one. The server chooses the oldest one of the address with the most connections. It never replaces a
    /// data connection whose address has an active command connection, because an app may only receive streams.
    #[must_use]
    pub fn connections_per_address(mut self, limit: usize) -> Self {
        self.connections_per_address = limit;
        self
    }

    /// Allows apps of this network to connect at both ports and to call commands with these effects. After the first
    /// call, all other networks are forbidden. Without a call, everything is allowed.
    ///
    /// The smallest network that contains the address applies. A connection from a forbidden address is closed at once.
    /// A command with another effect is refused with the protocol's error result, and its handler is not run. A command
    /// unknown to the spec has the effect [`Effect::Unknown`]. Reports are sent to all connected apps, and frames at
    /// the data port are not checked for effects.
    ///
    /// An address does not prove the identity of the sender. Use TLS in a shared network.
    ///
    /// ```
    /// use fc_runtime::{Effect, ServerConfig};
    ///
    /// # fn config() -> Result<ServerConfig, fc_runtime::NetworkError> {
    /// let config = ServerConfig::new()
    ///     .allow("10.0.0.0/24".parse()?, Effect::ALL)
    ///     .allow("10.0.7.0/24".parse()?, [Effect::Read]);
    /// # Ok(config) }
    /// ```
    #[must_use]
    pub fn allow(mut self, network: Network, effects: impl IntoIterator<Item = Effect>) -> Self {
        self.allowed.add(network, effects.into_iter().collect());
        self
    }

    /// Sets the limit of handlers that run on without a waiting app, for the whole server; 64 by default.
    ///
    /// At the limit, commands with [`Effect::Motion`] or [`Effect::Unknown`] are refused with the protocol's error
    /// result before they start, so that no started handler is dropped. If connections break, up to `in_flight` more
    /// handlers per connection may run on. With 0, no handler runs on: all are dropped with their connection or at
    /// their timeout.
    #[must_use]
    pub fn abandoned_handlers(mut self, limit: usize) -> Self {
        self.abandoned_handlers = limit;
        self
    }

    /// Sets the longest time of a header from its first to its last byte, and of a handshake in
    /// [`ServerHandle::serve_after`](super::ServerHandle::serve_after). After it, the connection is closed.
    #[must_use]
    pub fn header_timeout(mut self, timeout: Duration) -> Self {
        self.header_timeout = timeout;
        self
    }

    /// Sets how long a connection may make no progress, in the middle of a frame or while the app does not read, before
    /// it is closed. A transfer below [`least_rate`](Self::least_rate) is not progress.
    #[must_use]
    pub fn stall_timeout(mut self, timeout: Duration) -> Self {
        self.connection.stall_timeout = timeout;
        self
    }

    /// Sets the minimum rate of frames, in both directions, in bytes per second. The average over the stall timeout
    /// counts, and a slower connection is closed. With 0, any byte is progress, and a peer that sends one now and then
    /// holds the memory of a frame for ever.
    #[must_use]
    pub fn least_rate(mut self, bytes_per_second: u32) -> Self {
        self.least_rate = bytes_per_second;
        self
    }

    /// Sets how long a connection may be silent between frames before it is closed; `None` for any time.
    #[must_use]
    pub fn idle_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.idle_timeout = timeout;
        self
    }

    /// Sets the memory that apps may make the server hold, for both ports together, in bytes; 256 MiB by default. It
    /// covers received and inflated frames, requests in handlers, streams that no receiver has taken, and unsent
    /// responses, reports and streams.
    ///
    /// An eighth of it is reserved for the requests being read and answered. When the rest is used up, the connection
    /// with the most memory is closed, and others are not read until memory is free. A report without room drops older
    /// reports of its app. Memory of the robot's handlers is not counted.
    ///
    /// A frame that would need too much memory even alone is refused. Besides the frame, reading may take up to four
    /// times its JSON text. With 256 MiB, texts of more than 38 MiB are refused.
    #[must_use]
    pub fn memory(mut self, bytes: usize) -> Self {
        self.memory = bytes;
        self
    }

    pub(super) fn settings<P: Protocol>(&self) -> Settings {
        let memory = self.memory - self.memory / 8;
        let limits = self.connection.limits::<P>();
        let limits = Limits {
            frame_bytes: limits.frame_bytes.min(at_most(memory / 16 * 3)),
            json_list_bytes: limits.json_list_bytes.min(memory / 6),
            ..limits
        };
        Settings {
            connection: self.connection.clone(),
            limits,
            queued_bytes: self.connection.queued_bytes::<P>(),
            connections_per_address: self.connections_per_address,
            allowed: self.allowed.clone(),
            abandoned_handlers: self.abandoned_handlers,
            memory,
            handler_timeout: self.handler_timeout.unwrap_or(P::DEFAULTS.handler_timeout),
            max_age: match self.max_age {
                MaxAge::Default => P::DEFAULTS.max_age,
                MaxAge::Set(age) => age,
            },
            header_timeout: self.header_timeout,
            stall: MinimumRate::new(self.least_rate, self.connection.stall_timeout),
            idle_timeout: self.idle_timeout,
        }
    }
}

/// Largest memory of a text that is read, in multiples of its length, besides the text and list items.
/// `tests/memory.rs` measures it.
const TEXT: usize = 3;

fn at_most(bytes: usize) -> u32 {
    u32::try_from(bytes).unwrap_or(u32::MAX)
}

/// A configuration with all defaults filled in.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    pub(super) connection: ConnectionSettings,
    /// Limits that fit into the memory. They are used in place of those of the connection.
    pub(super) limits: Limits,
    pub(super) queued_bytes: usize,
    pub(super) connections_per_address: usize,
    pub(super) allowed: Allowed,
    pub(super) abandoned_handlers: usize,
    /// Limit of the memory without the reserve, in bytes.
    pub(super) memory: usize,
    pub(super) handler_timeout: Duration,
    pub(super) max_age: Option<Duration>,
    pub(super) header_timeout: Duration,
    /// Minimum rate in the middle of a frame, in both directions.
    pub(super) stall: MinimumRate,
    pub(super) idle_timeout: Option<Duration>,
}

impl Settings {
    /// Returns a decoder for requests, which are read as JSON.
    pub(super) fn decoder<P: Protocol>(&self) -> Decoder<P> {
        let frame = usize::try_from(self.limits.frame_bytes).unwrap_or(usize::MAX);
        self.decoder_up_to((self.memory / 4 * 3).saturating_sub(frame) / (1 + TEXT))
    }

    /// Returns a decoder for streams, which are not read.
    pub(super) fn stream_decoder<P: Protocol>(&self) -> Decoder<P> {
        self.decoder_up_to(self.memory / 2)
    }

    fn decoder_up_to<P: Protocol>(&self, inflated: usize) -> Decoder<P> {
        let limits = Limits {
            inflated_bytes: self.limits.inflated_bytes.min(at_most(inflated)),
            ..self.limits
        };
        self.connection.decoder(&limits)
    }

    /// Returns the memory for inflating and reading a request, in bytes.
    pub(super) fn reading(&self, work: Work) -> usize {
        let text = work.data.max(work.inflated);
        // A growing list is in memory twice for a moment: the old half and the new whole.
        let lists = self.limits.json_list_bytes / 2 * 3;
        work.inflated + text.saturating_mul(TEXT) + lists
    }

    pub(super) fn encoder<P: Protocol>(&self) -> Encoder<P> {
        self.connection.encoder(&self.limits)
    }
}
