//! Counters of a server.

use super::connection_id::ConnectionId;
use crate::clock;
use crate::log_limiter::{LogLimiter, Suppressed};
use crate::metrics::{Counter, Gauge, Operations, SERVER, Since};
use crate::protocol::Protocol;
use crate::sync::lock;
use std::fmt::Display;
use std::net::SocketAddr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// The metric of a counter. The counters `by` operation share one metric, which [`Counters::call`] counts.
macro_rules! metric {
    ($name:ident) => {
        Some(concat!("fc_server_", stringify!($name), "_total"))
    };
    ($name:ident by operation) => {
        None
    };
}

macro_rules! counters {
    ($($(#[doc = $doc:literal])* $name:ident $(by $operation:ident)?,)*) => {
        /// Counters of a server since it was bound.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub struct ServerCounters {
            $($(#[doc = $doc])* pub $name: u64,)*
        }

        /// The counters while the server runs.
        #[derive(Debug)]
        pub(super) struct Counters {
            $(pub(super) $name: Count,)*
            pub(super) limiters: LogLimiters,
            pub(super) gauges: Gauges,
            operations: Operations,
        }

        impl Counters {
            pub(super) fn of<P: Protocol>() -> Self {
                Self {
                    $($name: Count::new(metric!($name $(by $operation)?), concat!($($doc),*)),)*
                    limiters: LogLimiters::default(),
                    gauges: Gauges::new(),
                    operations: Operations::of::<P>(&SERVER),
                }
            }

            pub(super) fn read(&self) -> ServerCounters {
                ServerCounters {
                    $($name: self.$name.0.load(Ordering::Relaxed),)*
                }
            }
        }
    };
}

counters! {
    /// Connections accepted at the command port.
    connections,
    /// Connections accepted at the data port.
    data_connections,
    /// Connections closed at once because the limit was reached, in total or for their address.
    connections_refused,
    /// Connections closed at once because their address is not allowed.
    connections_forbidden,
    /// Silent connections closed to make room for another.
    connections_displaced,
    /// Connections closed because memory was short and they held most of it.
    connections_evicted,
    /// Connections closed by a timeout: of a header, of a stalled frame or reader, or of silence.
    connections_timed_out,
    /// Connections closed because their handshake failed or was late, such as TLS without a certificate.
    handshakes_failed,
    /// Requests with the result of success.
    calls_succeeded by operation,
    /// Requests with the result of a protocol error.
    calls_protocol by operation,
    /// Requests with the result of a timeout.
    calls_timed_out by operation,
    /// Requests with the result of an invalid parameter.
    calls_invalid by operation,
    /// Requests with the result of an expired message.
    calls_expired by operation,
    /// Requests with another result of their handler.
    calls_refused by operation,
    /// Requests refused because their address does not allow them; included in `calls_protocol`.
    calls_forbidden,
    /// Requests refused because the robot does not implement their command; included in `calls_protocol`.
    calls_not_implemented,
    /// Handlers that panicked. Their requests are included in `calls_protocol`.
    handlers_panicked,
    /// Handlers that ran on after their timeout or the end of their connection.
    handlers_abandoned,
    /// Requests refused because `abandoned_handlers` of these were running; included in `calls_protocol`.
    abandoned_reached,
    /// Frames that could not be read.
    bad_frames,
    /// Reports sent for the first time, counted per app.
    reports_sent,
    /// Reports sent again.
    reports_repeated,
    /// Reports acknowledged with success.
    reports_acknowledged,
    /// Reports acknowledged with another result.
    reports_refused,
    /// Reports given up after the last repetition.
    reports_timed_out,
    /// Reports dropped because an app's queue was full.
    reports_dropped,
    /// Times a connection was not read because `in_flight` of its handlers were running.
    in_flight_reached,
    /// Times a connection was not read for a while because of useless frames.
    connections_paced,
    /// Stream frames received.
    stream_frames_in,
    /// Stream frames of apps dropped without a receiver.
    stream_frames_dropped,
    /// Stream frames sent.
    stream_frames_out,
    /// Bytes received at both ports.
    bytes_in,
    /// Bytes sent at both ports.
    bytes_out,
}

/// The kind of answer to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answered {
    Success,
    Protocol,
    TimedOut,
    Invalid,
    Expired,
    Refused,
}

impl Counters {
    /// Counts a request with this command code.
    pub(super) fn call(&self, code: u16, answered: Answered) {
        let (count, result) = match answered {
            Answered::Success => (&self.calls_succeeded, "success"),
            Answered::Protocol => (&self.calls_protocol, "protocol"),
            Answered::TimedOut => (&self.calls_timed_out, "timeout"),
            Answered::Invalid => (&self.calls_invalid, "invalid"),
            Answered::Expired => (&self.calls_expired, "expired"),
            Answered::Refused => (&self.calls_refused, "refused"),
        };
        count.increment();
        self.operations.called(code, result);
    }

    /// Counts and logs an unreadable frame.
    pub(super) fn bad_frame<P: Protocol>(
        &self,
        limiters: &mut LogLimiter,
        (connection, peer): (ConnectionId, SocketAddr),
        name: &'static str,
        error: &dyn Display,
    ) {
        self.bad_frames.increment();
        if let Some(held) = limiters.admit(clock::now()) {
            let (protocol, connection, held) = (P::NAME, connection.0, held.shown());
            tracing::warn!(protocol, connection, %peer, error = name, held, "{error}");
        }
    }

    /// Counts and logs a connection that is closed because memory is short, with its memory.
    pub(super) fn evicted<P: Protocol>(
        &self,
        connection: ConnectionId,
        peer: SocketAddr,
        port: &'static str,
        held: usize,
    ) {
        self.connections_evicted.increment();
        if let Some(held_back) = self.limiters.evicted.admit() {
            let (protocol, connection, bytes) = (P::NAME, connection.0, held);
            let held = held_back.shown();
            tracing::warn!(protocol, connection, %peer, port, bytes, held, "closed: memory is short");
        }
    }

    /// Logs a new connection at a port.
    pub(super) fn connected<P: Protocol>(
        &self,
        connection: ConnectionId,
        peer: SocketAddr,
        port: &'static str,
    ) {
        if let Some(held) = self.limiters.connected.admit() {
            let (protocol, connection, held) = (P::NAME, connection.0, held.shown());
            tracing::info!(protocol, connection, %peer, port, held, "connected");
        }
    }

    /// Logs the end of a connection.
    pub(super) fn ended<P: Protocol>(
        &self,
        connection: ConnectionId,
        peer: SocketAddr,
        port: &'static str,
        reason: &'static str,
    ) {
        if let Some(held) = self.limiters.ended.admit() {
            let (protocol, connection, held) = (P::NAME, connection.0, held.shown());
            tracing::info!(protocol, connection, %peer, port, reason, held, "ended");
        }
    }

    /// Records the time of a handler.
    pub(super) fn handled(&self, code: u16, since: Since) {
        self.operations.took(code, since.elapsed());
    }
}

/// Current numbers. Only metrics contain them.
#[derive(Debug)]
pub(super) struct Gauges {
    pub(super) connections: Gauge,
    pub(super) data_connections: Gauge,
    pub(super) handlers: Gauge,
}

impl Gauges {
    fn new() -> Self {
        let connections = |port| {
            Gauge::new(
                "fc_server_open_connections",
                "Open connections, by port.",
                Some(port),
            )
        };
        Self {
            connections: connections("command"),
            data_connections: connections("data"),
            handlers: Gauge::new(
                "fc_server_handlers_waiting",
                "Running handlers that wait for something, including detached ones.",
                None,
            ),
        }
    }
}

/// Limits of log lines about all connections of a server together. There may be thousands of connections.
#[derive(Debug)]
pub(super) struct LogLimiters {
    pub(super) connected: SharedLogLimiter,
    pub(super) ended: SharedLogLimiter,
    pub(super) refused: SharedLogLimiter,
    pub(super) forbidden: SharedLogLimiter,
    pub(super) handshakes: SharedLogLimiter,
    pub(super) forbidden_calls: SharedLogLimiter,
    pub(super) evicted: SharedLogLimiter,
    pub(super) dropped: SharedLogLimiter,
}

impl Default for LogLimiters {
    fn default() -> Self {
        let each = || SharedLogLimiter(Mutex::new(LogLimiter::per_second()));
        Self {
            connected: each(),
            ended: each(),
            refused: SharedLogLimiter::default(),
            forbidden: SharedLogLimiter::default(),
            handshakes: SharedLogLimiter::default(),
            forbidden_calls: SharedLogLimiter::default(),
            evicted: SharedLogLimiter::default(),
            dropped: SharedLogLimiter::default(),
        }
    }
}

/// Limits lines of one cause that several connections write.
#[derive(Debug, Default)]
pub(super) struct SharedLogLimiter(Mutex<LogLimiter>);

impl SharedLogLimiter {
    /// Calls [`LogLimiter::admit`].
    pub(super) fn admit(&self) -> Option<Suppressed> {
        lock(&self.0).admit(clock::now())
    }
}

/// A counter and its metric.
#[derive(Debug)]
pub(super) struct Count(AtomicU64, Option<Counter>);

impl Count {
    fn new(metric: Option<&'static str>, help: &'static str) -> Self {
        let metric = metric.map(|name| Counter::new(name, help));
        Self(AtomicU64::new(0), metric)
    }

    pub(super) fn increment(&self) {
        self.add(1);
    }

    /// Counts one. Returns `true` if it should be logged: only powers of two are, so that the log stays short.
    pub(super) fn increment_sampled(&self) -> bool {
        self.count(1).wrapping_add(1).is_power_of_two()
    }

    pub(super) fn add(&self, n: usize) {
        self.count(n as u64);
    }

    /// Counts, and returns the number before.
    fn count(&self, n: u64) -> u64 {
        if let Some(metric) = &self.1 {
            metric.add(n);
        }
        self.0.fetch_add(n, Ordering::Relaxed)
    }
}
