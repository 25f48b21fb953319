//! Feeds arbitrary events to the session state machine and compares it with a model.
//!
//! Input: limits, the first id, then events.

use crate::input::Input;
use fc_generated::Fc;
use fc_runtime::{AckPolicy, Due, FrameId, Incoming, Limits, Protocol, Session, SessionRules};
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Replaces a timeout that the clock cannot represent.
const NEVER: Duration = Duration::from_secs(60 * 60 * 24 * 365);

struct Open {
    frame: FrameId,
    due: Instant,
    policy: AckPolicy,
    left: u32,
}

/// The expected state of the session, and all requests and reports so far.
struct Model {
    open: HashMap<u32, Open>,
    opened: Vec<FrameId>,
    ended: Vec<bool>,
    handed_on: Vec<(FrameId, Instant)>,
}

impl Model {
    fn end(&mut self, token: u32) -> Open {
        let ended = &mut self.ended[token as usize];
        assert!(
            !std::mem::replace(ended, true),
            "request {token} has ended twice"
        );
        self.open.remove(&token).expect("what ends was open")
    }
}

/// Checks the promises of a session.
///
/// Every request ends exactly once: with its own response, or not before its deadline. No id is in flight twice. A
/// delivered report is not delivered again while the peer may repeat it.
pub fn session(data: &[u8]) {
    let mut input = Input::new(data);
    let in_flight = usize::from(input.byte() % 20);
    let limits = Limits {
        in_flight,
        queued_reports: usize::from(input.byte() % 8),
        ..Fc::DEFAULTS.limits
    };
    let ack = AckPolicy {
        timeout: Duration::from_millis(u64::from(input.byte())),
        retries: u32::from(input.byte() % 4),
    };
    let first_id = match input.byte() {
        0 => u32::MAX - u32::from(input.byte()),
        _ => input.u32(),
    };
    let mut session: Session<u32> = Session::new(SessionRules::of::<Fc>(), &limits, ack, first_id);
    let start = Instant::now();
    let mut now = start;
    let mut model = Model {
        open: HashMap::new(),
        opened: Vec::new(),
        ended: Vec::new(),
        handed_on: Vec::new(),
    };
    while !input.is_empty() {
        match input.byte() % 8 {
            0 | 1 => open(&mut input, &mut session, &mut model, now, in_flight),
            2 => answer(&mut input, &mut session, &mut model, now),
            3 => cancel(&mut input, &mut session, &mut model),
            4 => now += Duration::from_millis(u64::from(input.byte())),
            5 => report(&mut input, &mut session, &mut model, now, ack),
            6 => lose(&mut input, &mut session, &mut model),
            _ => anything(&mut input, &mut session, &mut model, now),
        }
        due(&mut session, &mut model, now);
        assert_eq!(session.in_flight(), model.open.len());
        let first = model.open.values().map(|open| open.due).min();
        if let Some(first) = first {
            let next = session.next_due().expect("something will be due");
            assert!(next <= first, "the session would wake up too late");
        }
    }
    for (frame, token) in session.end_if(|_, _| true) {
        assert_eq!(model.end(token).frame, frame);
    }
    assert!(model.open.is_empty() && model.ended.iter().all(|ended| *ended));
    assert_eq!(session.in_flight(), 0);
}

fn open(
    input: &mut Input<'_>,
    session: &mut Session<u32>,
    model: &mut Model,
    now: Instant,
    limit: usize,
) {
    let kind = if input.byte().is_multiple_of(2) {
        Fc::COMMAND
    } else {
        Fc::REPORT
    };
    let policy = AckPolicy {
        timeout: match input.byte() {
            255 => Duration::MAX,
            n => Duration::from_millis(u64::from(n)),
        },
        retries: u32::from(input.byte() % 4),
    };
    let token = u32::try_from(model.opened.len()).expect("few requests");
    match session.open(kind, input.u16() % 4, policy, now, token) {
        Ok(frame) => {
            assert!(
                model.open.values().all(|open| open.frame.id != frame.id),
                "id in flight twice"
            );
            let due = now.checked_add(policy.timeout).unwrap_or(now + NEVER);
            model.open.insert(
                token,
                Open {
                    frame,
                    due,
                    policy,
                    left: policy.retries,
                },
            );
            model.opened.push(frame);
            model.ended.push(false);
        }
        Err(busy) => assert_eq!((busy.limit, model.open.len()), (limit, limit)),
    }
}

fn pick(input: &mut Input<'_>, model: &Model) -> Option<(u32, FrameId)> {
    let index = usize::from(input.u16()).checked_rem(model.opened.len())?;
    Some((u32::try_from(index).ok()?, model.opened[index]))
}

fn answer(input: &mut Input<'_>, session: &mut Session<u32>, model: &mut Model, now: Instant) {
    let Some((token, frame)) = pick(input, model) else {
        return;
    };
    match session.receive(
        FrameId {
            response: true,
            ..frame
        },
        now,
    ) {
        Incoming::Answer(answered) => {
            assert_eq!(answered, token, "the answer has reached another request");
            model.end(token);
        }
        Incoming::Late => assert!(!model.open.contains_key(&token), "an answer was missed"),
        other => panic!("{other:?}"),
    }
}

fn cancel(input: &mut Input<'_>, session: &mut Session<u32>, model: &mut Model) {
    let Some((token, frame)) = pick(input, model) else {
        return;
    };
    match session.cancel(frame) {
        Some(cancelled) => {
            assert_eq!(cancelled, token);
            model.end(token);
        }
        None => assert!(!model.open.contains_key(&token)),
    }
}

fn report(
    input: &mut Input<'_>,
    session: &mut Session<u32>,
    model: &mut Model,
    now: Instant,
    ack: AckPolicy,
) {
    let frame = FrameId {
        response: false,
        kind: Fc::REPORT,
        code: input.u16() % 3,
        id: u32::from(input.byte() % 16),
    };
    let hand_on = input.byte().is_multiple_of(2);
    let known = model.handed_on.iter().rposition(|(seen, _)| *seen == frame);
    match session.receive(frame, now) {
        Incoming::Repeated => {
            let index = known.expect("what is repeated was handed on");
            // Each arrival restarts the time in which the peer may repeat the report.
            model.handed_on[index].1 = now;
        }
        Incoming::Report => {
            if let Some(index) = known {
                let since = now - model.handed_on[index].1;
                let later = model.handed_on.len() - index;
                let window = Fc::DEFAULTS.limits.in_flight;
                assert!(
                    since > ack.timeout || later > window,
                    "handed on again {since:?} and {later} reports later"
                );
            }
            if hand_on {
                session.handed_on(frame, now);
                model.handed_on.push((frame, now));
            }
        }
        other => panic!("{other:?}"),
    }
}

fn lose(input: &mut Input<'_>, session: &mut Session<u32>, model: &mut Model) {
    let every = usize::from(input.byte() % 4) + 1;
    let mut count = 0;
    let ended = session.end_if(|_, _| {
        count += 1;
        count % every == 0
    });
    for (frame, token) in ended {
        assert_eq!(model.end(token).frame, frame);
    }
}

/// Receives a frame with an arbitrary header.
fn anything(input: &mut Input<'_>, session: &mut Session<u32>, model: &mut Model, now: Instant) {
    let frame = FrameId {
        response: input.byte() % 2 == 1,
        kind: input.byte() % 5,
        code: input.u16() % 4,
        id: input.u32(),
    };
    if let Incoming::Answer(token) = session.receive(frame, now) {
        let asked = FrameId {
            response: false,
            ..frame
        };
        assert_eq!(
            model.end(token).frame,
            asked,
            "the answer to another request"
        );
    }
}

fn due(session: &mut Session<u32>, model: &mut Model, now: Instant) {
    while let Some(due) = session.due(now) {
        match due {
            Due::Again(frame, token) => {
                let open = model.open.get_mut(token).expect("what is repeated is open");
                assert_eq!(open.frame, frame);
                assert!(
                    open.due <= now && open.left > 0,
                    "repeated too early or too often"
                );
                open.left -= 1;
                open.due = now + open.policy.timeout;
            }
            Due::Expired(frame, token) => {
                let open = model.end(token);
                assert_eq!(open.frame, frame);
                assert!(open.due <= now && open.left == 0, "given up too early");
            }
        }
    }
    assert!(
        model.open.values().all(|open| open.due > now),
        "something due was missed"
    );
}
