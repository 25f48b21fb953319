//! What a server can be told beforehand.

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

/// Connections from one address at each port, unless told otherwise.
const PER_ADDRESS: usize = 8;

/// Handlers that may run on though nobody waits for their answer, unless told otherwise.
const ABANDONED: usize = 64;

/// What apps may make a server hold in memory, in bytes, unless told otherwise.
const MEMORY: usize = 256 << 20;

/// What a server can be told beforehand. Whatever is not set is the protocol's default.
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
    /// All addresses of the machine and the protocol's ports and limits; nothing compressed; five
    /// seconds for a header, thirty for a peer that has stopped in the middle or is slower than a
    /// kibibyte per second there, any time in between frames.
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

    /// Address to listen at.
    #[must_use]
    pub fn address(mut self, address: impl Into<IpAddr>) -> Self {
        self.address = address.into();
        self
    }

    /// How long a handler may take before the app is answered with the result of a timeout. What
    /// becomes of the handler then, [`Request::handle`](super::Request::handle) says.
    #[must_use]
    pub fn handler_timeout(mut self, timeout: Duration) -> Self {
        self.handler_timeout = Some(timeout);
        self
    }

    /// Oldest request that is still served, by the time in its envelope; `None` for any.
    #[must_use]
    pub fn max_age(mut self, age: Option<Duration>) -> Self {
        self.max_age = MaxAge::Set(age);
        self
    }

    /// Most bytes of reports that wait for one app or for its acknowledgement; as many as the longest
    /// body may have, unless set. Where a new report does not fit, the oldest that have not been sent
    /// give way, and if that is not enough the report itself is dropped.
    #[must_use]
    pub fn queued_bytes(mut self, limit: usize) -> Self {
        self.connection.queued_bytes = Some(limit);
        self
    }

    /// Most connections from one address, at each port; 8 unless set. Apps behind one router share
    /// an address: raise it where more of them come from there.
    ///
    /// One more, of an address or in total, takes the place of a connection over which nothing has
    /// come yet, if there is one: of the address that most connections come from, the one that has
    /// been there for longest. A data connection stays if a command connection of its address has
    /// sent something, because an app that only receives streams has nothing to send there.
    #[must_use]
    pub fn connections_per_address(mut self, limit: usize) -> Self {
        self.connections_per_address = limit;
        self
    }

    /// Lets apps of this network connect, at both ports, and call commands with these effects;
    /// nobody else, once it is called. Unless it is, everybody may do everything.
    ///
    /// Of several networks that an address is in, the smallest counts. Who connects from
    /// elsewhere is closed at once. A command with another effect is refused with the protocol's
    /// error result, and its handler is not run; what the spec does not know has the effect
    /// [`Effect::Unknown`]. Reports go to all who are connected, and what is sent at the data port has
    /// no effect that could be refused.
    ///
    /// An address is no proof of who sends: in a network that others are in too, use TLS.
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

    /// How many handlers may run on though nobody waits for their answer any more, at the whole
    /// server; 64 unless set. While there are as many, commands that set something in motion, or of
    /// which nobody knows what they do, are refused with the protocol's error result before they
    /// begin, so that none that has begun is dropped: when their connections break, as many more as
    /// `in_flight` on each may still run on. With 0, none runs on: all are dropped with their
    /// connection or at their timeout.
    #[must_use]
    pub fn abandoned_handlers(mut self, limit: usize) -> Self {
        self.abandoned_handlers = limit;
        self
    }

    /// How long a header may take from its first byte to its last before the connection is closed; and
    /// a handshake that [`ServerHandle::serve_after`](super::ServerHandle::serve_after) waits for.
    #[must_use]
    pub fn header_timeout(mut self, timeout: Duration) -> Self {
        self.header_timeout = timeout;
        self
    }

    /// How long a connection may make no progress, in the middle of a frame or while it has
    /// something to read, before it is closed. What is slower than [`least_rate`](Self::least_rate)
    /// is no progress.
    #[must_use]
    pub fn stall_timeout(mut self, timeout: Duration) -> Self {
        self.connection.stall_timeout = timeout;
        self
    }

    /// How fast a frame has to come, and what is sent has to be read, in bytes per second, averaged
    /// over the stall timeout: a connection that stays below it for so long is closed. With 0, a byte
    /// is progress enough, and somebody who sends one now and then holds the memory of a frame for as
    /// long as he likes.
    #[must_use]
    pub fn least_rate(mut self, bytes_per_second: u32) -> Self {
        self.least_rate = bytes_per_second;
        self
    }

    /// How long a connection may be silent in between frames before it is closed; `None` for any
    /// time.
    #[must_use]
    pub fn idle_timeout(mut self, timeout: Option<Duration>) -> Self {
        self.idle_timeout = timeout;
        self
    }

    /// How much memory apps may make the server hold, those of both ports together, in bytes: what has come
    /// of frames and what that is decompressed to, requests in handlers' hands, streams that nobody has
    /// taken yet, answers, reports and streams not sent yet. 256 MiB by default.
    ///
    /// An eighth of it is kept for what is read and answered at a moment. When the rest is used up,
    /// the connection that holds most is closed, and others are not read until its memory is there; a
    /// report that finds no room drops older ones of its app. Whatever a robot's own handlers keep is
    /// not counted.
    ///
    /// A frame that could not be dealt with even if it were alone is refused: beside itself it may
    /// take up to four times its JSON text. With 256 MiB these are texts of more than 38 MiB.
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

/// What a text that is read takes at most beside itself and the items of lists, in times its length:
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
    /// What may be held, in bytes, but for a reserve.
    pub(super) memory: usize,
    pub(super) handler_timeout: Duration,
    pub(super) max_age: Option<Duration>,
    pub(super) header_timeout: Duration,
    /// What is progress in the middle of a frame, either way.
    pub(super) stall: MinimumRate,
    pub(super) idle_timeout: Option<Duration>,
}

impl Settings {
    /// A decoder for requests, which are read as JSON.
    pub(super) fn decoder<P: Protocol>(&self) -> Decoder<P> {
        let frame = usize::try_from(self.limits.frame_bytes).unwrap_or(usize::MAX);
        self.decoder_up_to((self.memory / 4 * 3).saturating_sub(frame) / (1 + TEXT))
    }

    /// A decoder for streams, which nobody reads.
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

    /// What it may take to decompress and read a request, in bytes.
    pub(super) fn reading(&self, work: Work) -> usize {
        let text = work.data.max(work.inflated);
        // A list that grows is in memory twice for a moment: the old half beside the new whole.
        let lists = self.limits.json_list_bytes / 2 * 3;
        work.inflated + text.saturating_mul(TEXT) + lists
    }

    pub(super) fn encoder<P: Protocol>(&self) -> Encoder<P> {
        self.connection.encoder(&self.limits)
    }
}
