//! Receives and handles requests and the responses to reports.

use super::{Driver, FRAME};
use crate::json::Allowance;
use crate::link::Transport;
use crate::message::{Empty, read_enveloped};
use crate::protocol::Protocol;
use crate::refusal::Refusal;
use crate::server::gate::{LARGE, Pass, process_frame};
use crate::server::push::AckOutcome;
use crate::server::service::Request;
use crate::server::watch::Reason;
use crate::session::{Incoming, after};
use std::task::{Context, Poll};
use std::time::Instant;

/// Number of requests after which responses are sent although more requests are available. The app then works on these
/// while the robot works on the others.
const SLICE: usize = 32;

/// The reason why nothing more can be received.
pub(super) enum ReadEnd {
    /// Responses cannot be sent either.
    Broken,
    /// Responses can still be sent: the app has closed its sending side, or its bytes are not frames.
    HalfClosed(Reason),
}

impl<S: Transport, P: Protocol> Driver<S, P> {
    /// Handles requests and reads on, until no more are available, no more may be taken, or a slice is complete.
    /// Returns `true` if more may be available at once.
    pub(super) fn receive(&mut self, cx: &mut Context<'_>, now: Instant) -> Result<bool, ReadEnd> {
        let mut slice = SLICE;
        loop {
            while self.has_room() {
                if self.handlers.len() >= self.peer.settings.limits.in_flight {
                    self.peer.counters.in_flight_reached.increment();
                    self.log_in_flight_limit(now);
                    return Ok(false);
                }
                if self.turn == 0 || self.pause.until(now).is_some() {
                    return Ok(false);
                }
                let before = self.peer.unsent();
                let taken = if let Some(work) = self.link.decoder.work(LARGE) {
                    let Poll::Ready(pass) = self.gate.poll_pass(cx) else {
                        return Ok(false);
                    };
                    let bytes = self.peer.settings.reading(work);
                    let Poll::Ready(_read) = self.peer.memory.poll_lend(cx, bytes) else {
                        self.short = true;
                        return Ok(false);
                    };
                    self.handle_next(cx, now, Some(pass))?
                } else {
                    self.handle_next(cx, now, None)?
                };
                self.short = false;
                self.charge(before);
                let surplus = self.link.decoder.take_surplus();
                if surplus > 0 {
                    self.link.decoder.release();
                }
                self.pause_after_useless_work(surplus, now);
                if !taken {
                    break;
                }
                slice -= 1;
                if slice == 0 {
                    return Ok(true);
                }
            }
            if !self.has_room() {
                // The responses must be sent first.
                return Ok(true);
            }
            let begins = self.link.decoder.pending() == 0;
            let read = if self.link.decoder.is_bare() {
                self.short = false;
                self.link.poll_begin(cx)
            } else {
                let grows = self.link.decoder.growth();
                self.short = grows > 0 && self.peer.memory.poll_grow(cx, grows).is_pending();
                if self.short {
                    return Ok(false);
                }
                self.link.poll_read(cx)
            };
            match read {
                Poll::Pending => return Ok(false),
                Poll::Ready(Ok(0)) => {
                    let inside = self.link.decoder.finish().is_err();
                    return Err(ReadEnd::HalfClosed(if inside {
                        "closed inside a frame"
                    } else {
                        "closed by the app"
                    }));
                }
                Poll::Ready(Ok(n)) => {
                    self.peer.hear();
                    if begins {
                        self.watch.begins(now);
                    } else {
                        self.watch.received(n, &self.peer.settings, now);
                    }
                    self.peer.counters.bytes_in.add(n);
                }
                Poll::Ready(Err(_)) => return Err(ReadEnd::Broken),
            }
        }
    }

    /// Logs that the limit of running handlers is reached.
    fn log_in_flight_limit(&mut self, now: Instant) {
        if let Some(held) = self.in_flight.admit(now) {
            let (protocol, held) = (P::NAME, held.shown());
            let (connection, peer) = (self.peer.id.0, self.peer.address);
            let in_flight = self.peer.settings.limits.in_flight;
            tracing::info!(protocol, connection, %peer, in_flight, held, "not read: too many requests");
        }
    }

    /// Pauses the connection for the useless work of its last frame.
    fn pause_after_useless_work(&mut self, surplus: u64, now: Instant) {
        let unusable = self.peer.take_unusable();
        let Some((time, line)) = self.pause.add(surplus, unusable, now) else {
            return;
        };
        self.peer.counters.connections_paced.increment();
        if let Some(held) = line {
            let (protocol, held) = (P::NAME, held.shown());
            let (connection, peer) = (self.peer.id.0, self.peer.address);
            tracing::info!(protocol, connection, %peer, held, "not read for {time:?}: useless work");
        }
    }

    /// Handles the next frame. Returns `false` if it has not arrived yet.
    fn handle_next(
        &mut self,
        cx: &mut Context<'_>,
        now: Instant,
        pass: Option<Pass>,
    ) -> Result<bool, ReadEnd> {
        let peer = &self.peer;
        let decoder = &mut self.link.decoder;
        let frame = match process_frame(pass.as_ref(), || decoder.next()) {
            Ok(Some(frame)) => {
                self.turn = self.turn.saturating_sub(FRAME + frame.body().len());
                frame
            }
            Ok(None) => {
                self.watch.ends_inside_header(decoder.inside_header(), now);
                return Ok(false);
            }
            Err(error) => {
                self.turn = self.turn.saturating_sub(FRAME);
                let counters = &peer.counters;
                let whose = (peer.id, peer.address);
                counters.bad_frame::<P>(&mut self.bad_frames, whose, error.name(), &error);
                let id = error.frame().ok_or(ReadEnd::HalfClosed(error.name()))?;
                if id.response {
                    peer.unusable();
                } else {
                    peer.refuse_with(id, P::RESULTS.protocol);
                }
                return Ok(true);
            }
        };
        self.watch.frame(now);
        let id = frame.id();
        let incoming = if id.response || id.kind != P::COMMAND {
            peer.lock().session.receive(id, now)
        } else {
            Incoming::Command
        };
        match incoming {
            Incoming::Command if !peer.may_call(id.code) => peer.refuse_as_forbidden(id),
            Incoming::Command => {
                let request = Request {
                    frame: id,
                    body: frame.body(),
                    peer,
                    waker: cx.waker(),
                    pass,
                    at: now,
                };
                let service = &self.service;
                let Some(handling) = peer.guard(id, || service.call(request)) else {
                    peer.refuse_after_panic(id);
                    return Ok(true);
                };
                if let Some(started) = handling.0 {
                    let deadline = after(now, peer.settings.handler_timeout);
                    self.handlers.push(started, id, peer, deadline);
                }
            }
            Incoming::Answer(queued) => {
                let allowance = peer.settings.limits.json();
                let outcome = acknowledged::<P>(frame.body(), allowance);
                match outcome {
                    AckOutcome::Acknowledged => peer.counters.reports_acknowledged.increment(),
                    _ => peer.counters.reports_refused.increment(),
                }
                queued.end(outcome);
            }
            Incoming::Late => peer.unusable(),
            // Robots accept no reports, and streams have their own port.
            Incoming::Report | Incoming::Repeated | Incoming::Stream => {
                peer.refuse_with(id, P::RESULTS.protocol);
            }
        }
        Ok(true)
    }
}

/// Returns the outcome of an app's response to a report.
fn acknowledged<P: Protocol>(body: &[u8], allowance: Allowance) -> AckOutcome {
    match read_enveloped::<P::Response, Empty>(body, allowance) {
        Err(error) => AckOutcome::Invalid(error),
        Ok(read) => match Refusal::of::<P>(&read.envelope) {
            None => AckOutcome::Acknowledged,
            Some(refusal) => AckOutcome::Refused(refusal),
        },
    }
}
