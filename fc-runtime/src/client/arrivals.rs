//! What each frame from the robot means.

use super::error::CallError;
use super::reports::Admission;
use super::state::State;
use crate::clock;
use crate::frame::{Body, FrameError, FrameId};
use crate::message::Empty;
use crate::protocol::{Protocol, ResponseEnvelope, ResultText};
use crate::raw::RawReport;
use crate::session::Incoming;
use std::task::Waker;
use std::time::Instant;

/// Beyond this much unsent, reports are not acknowledged: a robot that does not read must not make
/// the app collect acknowledgements for it.
const ACKNOWLEDGE_UP_TO: usize = 256 * 1024;

/// Deals with one frame.
pub(super) fn arrive<P: Protocol>(
    state: &mut State<P>,
    id: FrameId,
    body: Result<Body, FrameError>,
    now: Instant,
    wakers: &mut Vec<Waker>,
) {
    if let Err(error) = &body {
        state.counters.bad_frames += 1;
        tracing::warn!(protocol = P::NAME, error = error.name(), "{error}");
        if !id.response {
            return answer(state, id, P::RESULTS.protocol);
        }
    }
    match (state.session.receive(id, now), body) {
        (Incoming::Answer(slot), body) => {
            state.counters.answers += 1;
            let body = body.map_err(CallError::Frame);
            wakers.extend(state.slots.finish(slot, body));
        }
        (Incoming::Late, _) => {
            state.counters.late_answers += 1;
            tracing::debug!(
                protocol = P::NAME,
                code = id.code,
                msg_id = id.id,
                "late answer"
            );
        }
        (Incoming::Report, Ok(body)) => report(state, id, body, now, wakers),
        (Incoming::Repeated, _) => {
            state.counters.repeated_reports += 1;
            answer(state, id, P::RESULTS.success);
        }
        // Apps serve no commands, and streams have a port of their own.
        (Incoming::Command | Incoming::Stream | Incoming::Report, _) => {
            answer(state, id, P::RESULTS.protocol);
        }
    }
}

fn report<P: Protocol>(
    state: &mut State<P>,
    id: FrameId,
    body: Body,
    now: Instant,
    wakers: &mut Vec<Waker>,
) {
    let report = RawReport {
        code: id.code,
        id: id.id,
        text: body.into_vec(),
    };
    let room = state.out.len() < ACKNOWLEDGE_UP_TO;
    if room && state.reports.push(report, wakers) == Admission::Taken {
        state.counters.reports += 1;
        state.session.handed_on(id, now);
        answer(state, id, P::RESULTS.success);
    } else {
        state.counters.reports_refused += 1;
        tracing::debug!(
            protocol = P::NAME,
            code = id.code,
            msg_id = id.id,
            "no room for report"
        );
    }
}

/// Answers a request of the robot with nothing but a result.
fn answer<P: Protocol>(state: &mut State<P>, id: FrameId, result: ResultText) {
    if state.out.len() >= ACKNOWLEDGE_UP_TO {
        return;
    }
    let envelope = P::Response::at(clock::unix_ms(), result.code, result.text);
    let before = state.out.len();
    // An envelope alone fits into any frame limit worth its name; if not, the robot repeats itself.
    let _ = state
        .encoder
        .message(&mut state.out, id.answer(), &envelope, &Empty);
    state.counters.bytes_out += (state.out.len() - before) as u64;
}
