//! Handling of frames from the robot.

use super::error::CallError;
use super::state::State;
use crate::clock;
use crate::digest::{Compute as _, Sum};
use crate::frame::{Body, Frame, FrameError, FrameId};
use crate::json::{Allowance, BodyError};
use crate::message::{Empty, read_enveloped};
use crate::operation::{OperationKind, ResultText};
use crate::protocol::{DigestOf, Protocol, ResponseEnvelope};
use crate::raw::RawReport;
use crate::refusal::Refusal;
use crate::session::Incoming;
use crate::wire::Header;
use std::task::Waker;
use std::time::Instant;

/// Unsent bytes beyond which reports are not acknowledged. A robot that does not read must not make the app collect
/// acknowledgements.
const ACKNOWLEDGE_UP_TO: usize = 256 * 1024;

/// A received frame, taken out of the decoder.
#[derive(Debug)]
pub(super) struct Arrival {
    pub(super) id: FrameId,
    /// Digest in the header; zeros if the frame could not be read.
    pub(super) digest: Sum,
    pub(super) body: Result<Body, ArrivalError>,
}

/// The reason why a frame cannot be delivered.
#[derive(Debug)]
pub(super) enum ArrivalError {
    /// The frame could not be read.
    Frame(FrameError),
    /// The report cannot be read as the type of its code, or has no valid envelope.
    Report(BodyError),
}

/// Checks of reports by code. Reports with other codes may be any JSON object.
#[derive(Debug)]
pub(super) struct ReportChecks(Vec<(u16, Check)>);

type Check = fn(&[u8], Allowance) -> Result<(), BodyError>;

impl ReportChecks {
    pub(super) fn of<P: Protocol>() -> Self {
        let reports = P::operations()
            .iter()
            .filter(|operation| operation.kind == OperationKind::Report);
        Self(
            reports
                .filter_map(|report| Some((report.code?, report.request.check)))
                .collect(),
        )
    }

    fn check<P: Protocol>(
        &self,
        code: u16,
        text: &[u8],
        allowance: Allowance,
    ) -> Result<(), BodyError> {
        // At most the limits within which the app reads the report later.
        let most = RawReport::allowance::<P>();
        let allowance = Allowance {
            depth: allowance.depth,
            values: allowance.values.min(most.values),
            list_bytes: allowance.list_bytes.min(most.list_bytes),
        };
        read_enveloped::<P::Request, Empty>(text, allowance)?;
        let known = self.0.iter().find(|(known, _)| *known == code);
        known.map_or(Ok(()), |(_, check)| check(text, allowance))
    }
}

impl Arrival {
    /// Takes a frame out of the decoder and checks reports. A report that the app cannot read is refused here instead
    /// of acknowledged.
    pub(super) fn of<P: Protocol>(
        frame: Frame<'_, P>,
        spare: &mut Vec<u8>,
        report_checks: &ReportChecks,
        allowance: Allowance,
    ) -> Self {
        let id = frame.id();
        let is_report = !id.response && id.kind == P::REPORT;
        let sum = frame.header.digest();
        let digest = if is_report {
            DigestOf::<P>::fingerprint(sum, frame.body())
        } else {
            sum
        };
        let checked = if is_report {
            report_checks.check::<P>(id.code, frame.body(), allowance)
        } else {
            Ok(())
        };
        let body = match checked {
            Ok(()) => Ok(frame.into_body_for(spare)),
            Err(error) => Err(ArrivalError::Report(error)),
        };
        Self { id, digest, body }
    }
}

/// Handles one frame.
pub(super) fn arrive<P: Protocol>(
    state: &mut State<P>,
    Arrival { id, digest, body }: Arrival,
    now: Instant,
    wakers: &mut Vec<Waker>,
) {
    let body = match body {
        Ok(body) => Ok(body),
        Err(ArrivalError::Report(error)) => {
            state.counters.reports_invalid += 1;
            let (code, msg_id, name) = (id.code, id.id, error.name());
            if let Some(held) = state.limiters.invalid.admit(now) {
                let (protocol, held) = (P::NAME, held.shown());
                tracing::warn!(protocol, code, msg_id, error = name, held, "report refused");
            }
            let refusal = Refusal::invalid::<P>(error);
            return answer_with(state, id, refusal.code, &refusal.text);
        }
        Err(ArrivalError::Frame(error)) => {
            state.counters.bad_frames += 1;
            if let Some(held) = state.limiters.bad_frame.admit(now) {
                let (protocol, held) = (P::NAME, held.shown());
                tracing::warn!(protocol, error = error.name(), held, "{error}");
            }
            if !id.response {
                return answer(state, id, P::RESULTS.protocol);
            }
            Err(CallError::Frame(error))
        }
    };
    match (state.session.receive_digested(id, Some(digest), now), body) {
        (Incoming::Answer(slot), body) => {
            state.counters.answers += 1;
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
        (Incoming::Report, Ok(body)) => report(state, id, digest, body, now, wakers),
        (Incoming::Repeated, _) => {
            state.counters.repeated_reports += 1;
            answer(state, id, P::RESULTS.success);
        }
        // Apps serve no commands, and streams have their own port.
        (Incoming::Command | Incoming::Stream | Incoming::Report, _) => {
            answer(state, id, P::RESULTS.protocol);
        }
    }
}

fn report<P: Protocol>(
    state: &mut State<P>,
    id: FrameId,
    digest: Sum,
    body: Body,
    now: Instant,
    wakers: &mut Vec<Waker>,
) {
    if let Some(since) = state.report_watchdog.received(id.code, now) {
        state.counters.reports_late += 1;
        if let Some(held) = state.limiters.late.admit(now) {
            tracing::warn!(
                protocol = P::NAME,
                code = id.code,
                msg_id = id.id,
                since_ms = u64::try_from(since.as_millis()).unwrap_or(u64::MAX),
                held = held.shown(),
                "report late"
            );
        }
    }
    let report = RawReport {
        code: id.code,
        id: id.id,
        text: body.into_vec(),
    };
    // Receivers may already have seen the end of the connection.
    let room = !state.connection.now().is_closed() && state.out.len() < ACKNOWLEDGE_UP_TO;
    let missed = if room {
        state.reports.push(report, wakers)
    } else {
        None
    };
    if let Some(missed) = missed {
        state.counters.reports += 1;
        state.counters.reports_missed += missed;
        state.session.handed_on_digested(id, digest, now);
        answer(state, id, P::RESULTS.success);
    } else {
        state.counters.reports_refused += 1;
        if let Some(held) = state.limiters.untaken.admit(now) {
            tracing::warn!(
                protocol = P::NAME,
                code = id.code,
                msg_id = id.id,
                held = held.shown(),
                "report not taken: there is no receiver, or no room"
            );
        }
    }
}

/// Responds to a request of the robot with only a result, or not at all if responses have no result.
fn answer<P: Protocol>(state: &mut State<P>, id: FrameId, result: ResultText) {
    answer_with(state, id, result.code, result.text);
}

fn answer_with<P: Protocol>(state: &mut State<P>, id: FrameId, code: i64, text: &str) {
    let can_say = code == P::RESULTS.success.code || P::Response::HAS_RESULT;
    if !can_say || state.out.len() >= ACKNOWLEDGE_UP_TO {
        return;
    }
    let envelope = P::Response::at(clock::unix_ms(), code, text);
    let before = state.out.len();
    // An envelope alone fits into any sensible frame limit. Otherwise the robot repeats its report.
    let _ = state
        .encoder
        .message(&mut state.out, id.answer(), &envelope, &Empty);
    state.counters.bytes_out += (state.out.len() - before) as u64;
}
