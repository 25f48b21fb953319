//! The session: matches responses to requests, tracks deadlines and detects repetitions.
//!
//! **Architecture invariant:** no sockets and no clocks. The caller passes events and the time, and moves the bytes.
//! App and robot use the same session: an app opens commands and receives reports, a robot does the reverse.

mod deadline;
mod outgoing;
mod seen;

#[cfg(feature = "net")]
pub(crate) use deadline::after;
pub use outgoing::{Busy, Due};

use crate::frame::FrameId;
use crate::operation::AckPolicy;
use crate::protocol::Protocol;
use crate::wire::{Header, Limits};
use outgoing::Outgoing;
use seen::Seen;
use std::time::Instant;

/// The numbers of a protocol that its sessions need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SessionRules {
    /// Largest message id; all of its bits are set.
    pub id_max: u32,
    /// Default number of requests in flight, which a peer may use.
    pub in_flight: usize,
    /// Kind of a report and of its acknowledgement.
    pub report: u8,
    /// Kind of a frame of raw bytes.
    pub stream: u8,
}

impl SessionRules {
    /// Returns the rules of a protocol.
    #[must_use]
    pub const fn of<P: Protocol>() -> Self {
        Self {
            id_max: P::Header::ID_MAX,
            in_flight: P::DEFAULTS.limits.in_flight,
            report: P::REPORT,
            stream: P::STREAM,
        }
    }
}

/// The meaning of a received frame.
#[derive(Debug, PartialEq, Eq)]
pub enum Incoming<T> {
    /// The response to a request in flight, which ends here.
    Answer(T),
    /// A response to no request in flight. Drop it.
    Late,
    /// A command. Handle it and respond.
    Command,
    /// A new report. Deliver it, call [`Session::handed_on`], and acknowledge it.
    Report,
    /// A report that was delivered before. Only acknowledge it again.
    Repeated,
    /// Raw bytes.
    Stream,
}

/// The state of a conversation between two peers.
///
/// `T` is the caller's token for a request in flight. Every token passed to [`open`](Self::open) is returned exactly
/// once: with the response, as expired, as cancelled, or by [`end_if`](Self::end_if).
#[derive(Debug)]
pub struct Session<T> {
    rules: SessionRules,
    outgoing: Outgoing<T>,
    seen: Seen,
}

impl<T> Session<T> {
    /// Creates a session. Its ids count up from `first_id`, and continue from 0 after the largest id of the header.
    ///
    /// At most `limits.in_flight` requests are in flight, and at most half of all ids, so that a recent id is not
    /// reused at once. Delivered reports are remembered for twice the time in which `ack` allows repetitions, counted
    /// from their last arrival. The session remembers as many reports as a peer may have in flight or queued.
    #[must_use]
    pub fn new(rules: SessionRules, limits: &Limits, ack: AckPolicy, first_id: u32) -> Self {
        let repeated_for = ack.timeout.saturating_mul(ack.retries.saturating_add(1));
        let half_of_ids = usize::try_from(rules.id_max / 2 + 1).unwrap_or(usize::MAX);
        Self {
            rules,
            outgoing: Outgoing::new(limits.in_flight.min(half_of_ids), first_id, rules.id_max),
            // A peer may repeat all its reports in flight, up to its own limit.
            seen: Seen::new(
                limits
                    .queued_reports
                    .max(limits.in_flight)
                    .max(rules.in_flight)
                    .min(half_of_ids),
                repeated_for.saturating_mul(2),
            ),
        }
    }

    /// Adds a request in flight and returns its id.
    ///
    /// # Errors
    ///
    /// [`Busy`] if too many requests are in flight.
    pub fn open(
        &mut self,
        kind: u8,
        code: u16,
        policy: AckPolicy,
        now: Instant,
        token: T,
    ) -> Result<FrameId, Busy> {
        self.outgoing.open(kind, code, policy, now, token)
    }

    /// Returns the meaning of a received frame.
    pub fn receive(&mut self, frame: FrameId, now: Instant) -> Incoming<T> {
        self.receive_digested(frame, None, now)
    }

    /// Returns the meaning of a received frame. The digest of its data distinguishes reports of different connections,
    /// because a restarted peer may reuse an id.
    pub fn receive_digested(
        &mut self,
        frame: FrameId,
        digest: Option<[u8; 16]>,
        now: Instant,
    ) -> Incoming<T> {
        if frame.response {
            return match self.outgoing.end(frame) {
                Some(token) => Incoming::Answer(token),
                None => Incoming::Late,
            };
        }
        if frame.kind == self.rules.report {
            if self.seen.contains(frame, digest, now) {
                Incoming::Repeated
            } else {
                Incoming::Report
            }
        } else if frame.kind == self.rules.stream {
            Incoming::Stream
        } else {
            Incoming::Command
        }
    }

    /// Remembers a report as delivered.
    pub fn handed_on(&mut self, report: FrameId, now: Instant) {
        self.seen.insert(report, None, now);
    }

    /// Remembers a report with this digest as delivered.
    pub fn handed_on_digested(&mut self, report: FrameId, digest: [u8; 16], now: Instant) {
        self.seen.insert(report, Some(digest), now);
    }

    /// Notes that all further frames come over another connection.
    pub fn reconnected(&mut self) {
        self.seen.reconnected();
    }

    /// Ends a request whose caller has stopped waiting. A later response is [`Incoming::Late`].
    pub fn cancel(&mut self, request: FrameId) -> Option<T> {
        self.outgoing.end(request)
    }

    /// Returns a request that is due. Call it until it returns `None`.
    pub fn due(&mut self, now: Instant) -> Option<Due<'_, T>> {
        self.outgoing.due(now)
    }

    /// Returns a time before which no request is due. It may be earlier than the first deadline, but never later.
    #[must_use]
    pub fn next_due(&self) -> Option<Instant> {
        self.outgoing.earliest()
    }

    /// Ends every request in flight for which `ends` returns `true`, such as after a loss of the connection.
    pub fn end_if(&mut self, ends: impl FnMut(FrameId, &mut T) -> bool) -> Vec<(FrameId, T)> {
        self.outgoing.end_if(ends)
    }

    /// Returns the number of requests in flight.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.outgoing.len()
    }
}
