//! What a server has seen, in numbers.

use super::context::ConnectionId;
use crate::protocol::Protocol;
use std::fmt::Display;
use std::sync::atomic::{AtomicU64, Ordering};

macro_rules! counters {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// What a server has seen since it was bound.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub struct ServerCounters {
            $($(#[$doc])* pub $name: u64,)*
        }

        /// The same, being counted.
        #[derive(Debug, Default)]
        pub(super) struct Counting {
            $(pub(super) $name: Count,)*
        }

        impl Counting {
            /// Counts a frame that could not be read.
            pub(super) fn bad_frame<P: Protocol>(
                &self,
                connection: ConnectionId,
                name: &'static str,
                error: &dyn Display,
            ) {
                let (protocol, connection) = (P::NAME, connection.0);
                if self.bad_frames.one_to_log() {
                    tracing::warn!(protocol, connection, error = name, "{error}");
                } else {
                    tracing::debug!(protocol, connection, error = name, "{error}");
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
    /// Connections closed at once because there were as many as there may be already, in total or
    /// from their address.
    connections_refused,
    /// Connections closed to make room for another, because nothing had come over them yet.
    connections_displaced,
    /// Connections closed because a header did not come in time, a frame or a reader stalled, or
    /// nothing came for too long.
    connections_timed_out,
    /// Requests answered with success.
    calls_succeeded,
    /// Requests answered with the result of a protocol error.
    calls_protocol,
    /// Requests answered with the result of a timeout.
    calls_timed_out,
    /// Requests answered with the result of an invalid parameter.
    calls_invalid,
    /// Requests answered with the result of an expired message.
    calls_expired,
    /// Requests that a handler answered with another result.
    calls_refused,
    /// Handlers that panicked. Their requests are among `calls_protocol`.
    handlers_panicked,
    /// Handlers that ran on though nobody waited for their answer any more.
    handlers_abandoned,
    /// Requests refused because as many of these as `abandoned_handlers` were at work. They are
    /// among `calls_protocol`.
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
    /// Times a connection was not read because as many handlers as `in_flight` were at work.
    in_flight_reached,
    /// Times a connection was not read for a while because of useless work it had made.
    connections_paced,
    /// Stream frames received.
    stream_frames_in,
    /// Stream frames of apps dropped because nobody took them.
    stream_frames_dropped,
    /// Stream frames sent.
    stream_frames_out,
    /// Bytes received at both ports.
    bytes_in,
    /// Bytes sent at both ports.
    bytes_out,
}

#[derive(Debug, Default)]
pub(super) struct Count(AtomicU64);

impl Count {
    pub(super) fn one(&self) {
        self.add(1);
    }

    /// Counts one more, and says whether to log it: a flood must not become a flood in the log.
    pub(super) fn one_to_log(&self) -> bool {
        let before = self.0.fetch_add(1, Ordering::Relaxed);
        before.wrapping_add(1).is_power_of_two()
    }

    pub(super) fn add(&self, n: usize) {
        self.0.fetch_add(n as u64, Ordering::Relaxed);
    }
}
