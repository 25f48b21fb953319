//! The session: which answer belongs to which request, what is due, what has been seen before.
//!
//! **Architecture invariant:** no sockets and no clocks. The session is told what happened and what
//! time it is, and says what that means; moving bytes is the caller's business. App and robot use
//! the same machine: the one opens commands and receives reports, the other the reverse.

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
use std::marker::PhantomData;
use std::time::Instant;

/// What a frame that has arrived means.
#[derive(Debug, PartialEq, Eq)]
pub enum Incoming<T> {
    /// The answer to a request in flight, which has ended with it.
    Answer(T),
    /// An answer nobody waits for (any more): drop it.
    Late,
    /// A command: handle it and answer.
    Command,
    /// A report: hand it on, then say so with [`Session::handed_on`], and acknowledge it.
    Report,
    /// A report that has been handed on already: acknowledge it again, nothing else.
    Repeated,
    /// Raw bytes.
    Stream,
}

/// The state of one peer's conversation with another.
///
/// `T` is the caller's token for a request in flight. Every token given to [`open`](Self::open)
/// comes back exactly once: with the answer, as expired, as cancelled or by
/// [`end_if`](Self::end_if).
#[derive(Debug)]
pub struct Session<P, T> {
    outgoing: Outgoing<T>,
    seen: Seen,
    protocol: PhantomData<P>,
}

impl<P: Protocol, T> Session<P, T> {
    /// A session whose own ids count on from `first_id`, and from 0 behind the largest that the header has room for.
    ///
    /// At most `limits.in_flight` requests are in flight, and no more than half of all ids: one that was in use
    /// a moment ago is not the next. Reports handed on are remembered for twice
    /// as long as `ack` says that they may be repeated, counted from the last time they came; as many
    /// of them as a peer may have in flight or waiting.
    #[must_use]
    pub fn new(limits: &Limits, ack: AckPolicy, first_id: u32) -> Self {
        let repeated_for = ack.timeout.saturating_mul(ack.retries.saturating_add(1));
        let half_of_ids = usize::try_from(P::Header::ID_MAX / 2 + 1).unwrap_or(usize::MAX);
        Self {
            outgoing: Outgoing::new(
                limits.in_flight.min(half_of_ids),
                first_id,
                P::Header::ID_MAX,
            ),
            // A peer repeats what is in flight, and as much of it as its own limit allows.
            seen: Seen::new(
                limits
                    .queued_reports
                    .max(limits.in_flight)
                    .max(P::DEFAULTS.limits.in_flight)
                    .min(half_of_ids),
                repeated_for.saturating_mul(2),
            ),
            protocol: PhantomData,
        }
    }

    /// Puts a request in flight and gives the id to send it with.
    ///
    /// # Errors
    ///
    /// [`Busy`] if too many are in flight.
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

    /// Says what a frame that has arrived means.
    pub fn receive(&mut self, frame: FrameId, now: Instant) -> Incoming<T> {
        self.receive_digested(frame, None, now)
    }

    /// The same, with the digest of the frame's data. It tells reports apart that came over
    /// different connections: a peer that restarts may use an id again for something else.
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
        if frame.kind == P::REPORT {
            if self.seen.contains(frame, digest, now) {
                Incoming::Repeated
            } else {
                Incoming::Report
            }
        } else if frame.kind == P::STREAM {
            Incoming::Stream
        } else {
            Incoming::Command
        }
    }

    /// Remembers that a report has been handed on.
    pub fn handed_on(&mut self, report: FrameId, now: Instant) {
        self.seen.insert(report, None, now);
    }

    /// The same, with the digest of the report's data.
    pub fn handed_on_digested(&mut self, report: FrameId, digest: [u8; 16], now: Instant) {
        self.seen.insert(report, Some(digest), now);
    }

    /// Notes that what comes from now on comes over another connection.
    pub fn reconnected(&mut self) {
        self.seen.reconnected();
    }

    /// Ends a request because nobody waits for its answer any more. A late answer will miss.
    pub fn cancel(&mut self, request: FrameId) -> Option<T> {
        self.outgoing.end(request)
    }

    /// What is due; call it until it gives `None`.
    pub fn due(&mut self, now: Instant) -> Option<Due<'_, T>> {
        self.outgoing.due(now)
    }

    /// Before this, nothing is due. May be earlier than the first deadline, never later.
    #[must_use]
    pub fn next_due(&self) -> Option<Instant> {
        self.outgoing.earliest()
    }

    /// Ends every request in flight that `ends` says so of, as when the connection is lost.
    pub fn end_if(&mut self, ends: impl FnMut(FrameId, &mut T) -> bool) -> Vec<(FrameId, T)> {
        self.outgoing.end_if(ends)
    }

    /// How many requests are in flight.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.outgoing.len()
    }
}
