//! The session without sockets and clocks.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    clippy::items_after_statements,
    clippy::large_stack_arrays,
    reason = "a test may"
)]

mod common;

use common::{LIMITS, Toy, answer_to, command, report};
use fc_runtime::{AckPolicy, Busy, Due, FrameId, Incoming, Limits, Protocol, Session};
use proptest::collection::vec;
use proptest::prelude::{Strategy, any, prop_oneof, proptest};
use std::collections::{HashMap, HashSet};
use std::time::{Duration, Instant};

const ACK: AckPolicy = AckPolicy {
    timeout: Duration::from_millis(100),
    retries: 2,
};
const ONCE: AckPolicy = AckPolicy {
    timeout: Duration::from_millis(100),
    retries: 0,
};

fn session(in_flight: usize, first_id: u32) -> Session<Toy, u32> {
    let limits = Limits {
        in_flight,
        queued_reports: 4,
        ..LIMITS
    };
    Session::new(&limits, ACK, first_id)
}

fn later(start: Instant, milliseconds: u64) -> Instant {
    start + Duration::from_millis(milliseconds)
}

#[fc_test::test]
fn ids_count_on_and_answers_find_their_request() {
    let now = Instant::now();
    let mut session = session(10, 92_345_678);
    let a = session.open(Toy::COMMAND, 1, ONCE, now, 10).unwrap();
    let b = session.open(Toy::COMMAND, 2, ONCE, now, 20).unwrap();
    assert_eq!((a.id, b.id), (92_345_678, 92_345_679));
    assert_eq!(session.receive(answer_to(b), now), Incoming::Answer(20));
    assert_eq!(session.receive(answer_to(b), now), Incoming::Late);
    assert_eq!(session.receive(answer_to(a), now), Incoming::Answer(10));
    assert_eq!(session.in_flight(), 0);
}

#[fc_test::test]
fn an_answer_must_echo_kind_code_and_id() {
    let now = Instant::now();
    let mut session = session(10, 0);
    let request = session.open(Toy::COMMAND, 1, ONCE, now, 10).unwrap();
    let answer = answer_to(request);
    for wrong in [
        FrameId {
            kind: Toy::REPORT,
            ..answer
        },
        FrameId { code: 2, ..answer },
        FrameId { id: 1, ..answer },
    ] {
        assert_eq!(session.receive(wrong, now), Incoming::Late, "{wrong}");
    }
    assert_eq!(session.receive(answer, now), Incoming::Answer(10));
}

#[fc_test::test]
fn what_is_not_answered_is_repeated_and_expires() {
    let start = Instant::now();
    let mut session = session(10, 5);
    let id = session.open(Toy::REPORT, 1, ACK, start, 10).unwrap();
    assert_eq!(session.due(later(start, 99)), None);
    for attempt in 1..=2 {
        let at = later(start, 100 * attempt);
        assert_eq!(session.next_due(), Some(at));
        assert_eq!(session.due(at), Some(Due::Again(id, &mut 10)));
        assert_eq!(session.due(at), None);
    }
    assert_eq!(session.due(later(start, 300)), Some(Due::Expired(id, 10)));
    assert_eq!(session.due(later(start, 300)), None);
    assert_eq!(session.next_due(), None);
    assert_eq!(session.receive(answer_to(id), start), Incoming::Late);
}

#[fc_test::test]
fn the_limit_of_requests_in_flight() {
    let now = Instant::now();
    let mut session = session(2, 5);
    let first = session.open(Toy::COMMAND, 1, ONCE, now, 1).unwrap();
    session.open(Toy::COMMAND, 1, ONCE, now, 2).unwrap();
    assert_eq!(
        session.open(Toy::COMMAND, 1, ONCE, now, 3),
        Err(Busy { limit: 2 })
    );
    assert_eq!(session.cancel(first), Some(1));
    assert_eq!(session.cancel(first), None);
    assert!(session.open(Toy::COMMAND, 1, ONCE, now, 3).is_ok());
}

#[fc_test::test]
fn ids_wrap_around_past_those_in_flight() {
    let now = Instant::now();
    let mut session = session(10, u32::MAX - 1);
    let frames: Vec<_> = (0..4)
        .map(|token| session.open(Toy::COMMAND, 1, ONCE, now, token).unwrap())
        .collect();
    let ids: Vec<_> = frames.iter().map(|frame| frame.id).collect();
    assert_eq!(ids, [u32::MAX - 1, u32::MAX, 0, 1]);
    // However many come and go meanwhile, theirs are not given away.
    for token in 4..100 {
        let frame = session.open(Toy::COMMAND, 1, ONCE, now, token).unwrap();
        assert_eq!(session.cancel(frame), Some(token));
    }
    for (token, frame) in (0..).zip(frames) {
        assert_eq!(
            session.receive(answer_to(frame), now),
            Incoming::Answer(token)
        );
    }
}

#[fc_test::test]
fn a_report_is_handed_on_once() {
    let start = Instant::now();
    let mut session = session(10, 0);
    let moved = report(1, 7);
    assert_eq!(session.receive(moved, start), Incoming::Report);
    // There was no room for it: it may come again.
    assert_eq!(session.receive(moved, start), Incoming::Report);
    session.handed_on(moved, start);
    assert_eq!(
        session.receive(moved, later(start, 300)),
        Incoming::Repeated
    );
    assert_eq!(session.receive(report(2, 7), start), Incoming::Report);
    // Repetitions end; the same id much later is another report.
    assert_eq!(session.receive(moved, later(start, 901)), Incoming::Report);
}

/// A robot that restarts may use an id again for another report. On one connection it does not.
#[fc_test::test]
fn over_another_connection_the_content_tells_reports_apart() {
    let start = Instant::now();
    let mut session = session(10, 0);
    let (moved, before, after) = (report(1, 7), [1; 16], [2; 16]);
    session.handed_on_digested(moved, before, start);
    let receive = |session: &mut Session<Toy, u32>, digest| {
        session.receive_digested(moved, Some(digest), start)
    };
    assert_eq!(receive(&mut session, after), Incoming::Repeated);
    session.reconnected();
    assert_eq!(receive(&mut session, after), Incoming::Report);
    assert_eq!(receive(&mut session, before), Incoming::Repeated);
    // Its repetition has come over the new connection, where the id is now its own.
    assert_eq!(receive(&mut session, after), Incoming::Repeated);
    // What has the same content is the same, however late.
    let late = later(start, 1_000_000);
    let again = session.receive_digested(moved, Some(before), late);
    assert_eq!(again, Incoming::Repeated);
}

#[fc_test::test]
fn the_window_of_reports_is_bounded() {
    let start = Instant::now();
    let mut session = session(10, 0);
    for id in 0..65 {
        session.handed_on(report(1, id), start);
    }
    assert_eq!(session.receive(report(1, 0), start), Incoming::Report);
    for id in 1..65 {
        assert_eq!(session.receive(report(1, id), start), Incoming::Repeated);
    }
    // What has come again is remembered for longer than what has not.
    assert_eq!(session.receive(report(1, 1), start), Incoming::Repeated);
    for id in 65..128 {
        session.handed_on(report(1, id), start);
    }
    assert_eq!(session.receive(report(1, 1), start), Incoming::Repeated);
    assert_eq!(session.receive(report(1, 2), start), Incoming::Report);
}

#[fc_test::test]
fn other_requests_are_told_by_kind() {
    let now = Instant::now();
    let mut session = session(10, 0);
    assert_eq!(session.receive(command(1, 1), now), Incoming::Command);
    let stream = FrameId {
        kind: Toy::STREAM,
        ..command(1, 1)
    };
    assert_eq!(session.receive(stream, now), Incoming::Stream);
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Open {
        retries: u32,
        timeout: u64,
    },
    /// Answer the request opened as the given one, in flight or not.
    Answer(usize),
    Cancel(usize),
    Wait(u64),
    Lose {
        every: usize,
    },
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        5 => (0_u32..3, 1_u64..50).prop_map(|(retries, timeout)| Step::Open { retries, timeout }),
        3 => any::<usize>().prop_map(Step::Answer),
        1 => any::<usize>().prop_map(Step::Cancel),
        2 => (0_u64..40).prop_map(Step::Wait),
        1 => (1_usize..4).prop_map(|every| Step::Lose { every }),
    ];
    vec(step, 0..400)
}

/// What is known of every request ever opened.
struct Model {
    opened: Vec<FrameId>,
    open: HashMap<u32, (FrameId, Instant, u32, Duration)>,
    ended: HashSet<u32>,
}

impl Model {
    fn end(&mut self, token: u32) -> FrameId {
        assert!(self.ended.insert(token), "{token} has ended twice");
        self.open.remove(&token).expect("was open").0
    }

    fn pick(&self, index: usize) -> Option<(u32, FrameId)> {
        let token = index.checked_rem(self.opened.len())?;
        Some((u32::try_from(token).unwrap(), self.opened[token]))
    }
}

proptest! {
    #[fc_test::test]
    fn every_request_ends_exactly_once(steps in steps(), first_id in any::<u32>(), limit in 1_usize..40) {
        let mut now = Instant::now();
        let mut session = session(limit, first_id);
        let mut model = Model { opened: Vec::new(), open: HashMap::new(), ended: HashSet::new() };
        for step in steps.into_iter().chain([Step::Lose { every: 1 }]) {
            match step {
                Step::Open { retries, timeout } => {
                    let token = u32::try_from(model.opened.len()).unwrap();
                    let timeout = Duration::from_millis(timeout);
                    let policy = AckPolicy { timeout, retries };
                    match session.open(Toy::COMMAND, 3, policy, now, token) {
                        Ok(id) => {
                            let twice = model.open.values().any(|(open, ..)| open.id == id.id);
                            assert!(!twice, "{id} is in flight already");
                            model.opened.push(id);
                            model.open.insert(token, (id, now + timeout, retries, timeout));
                        }
                        Err(Busy { .. }) => assert_eq!(model.open.len(), limit),
                    }
                }
                Step::Answer(index) => {
                    if let Some((token, id)) = model.pick(index) {
                        match session.receive(answer_to(id), now) {
                            // Ids may have wrapped around to a later request; never here.
                            Incoming::Answer(answered) => {
                                assert_eq!(answered, token);
                                assert_eq!(model.end(token), id);
                            }
                            Incoming::Late => assert!(!model.open.contains_key(&token)),
                            other => panic!("{other:?}"),
                        }
                    }
                }
                Step::Cancel(index) => {
                    if let Some((token, id)) = model.pick(index) {
                        match session.cancel(id) {
                            Some(cancelled) => {
                                assert_eq!(cancelled, token);
                                model.end(token);
                            }
                            None => assert!(!model.open.contains_key(&token)),
                        }
                    }
                }
                Step::Wait(milliseconds) => now += Duration::from_millis(milliseconds),
                Step::Lose { every } => {
                    let mut count = 0;
                    let ended = session.end_if(|_, _| {
                        count += 1;
                        count % every == 0
                    });
                    for (id, token) in ended {
                        assert_eq!(model.end(token), id);
                    }
                }
            }
            while let Some(due) = session.due(now) {
                match due {
                    Due::Again(id, token) => {
                        let entry = model.open.get_mut(token).expect("open");
                        assert_eq!(entry.0, id);
                        assert!(entry.1 <= now && entry.2 > 0);
                        entry.1 = now + entry.3;
                        entry.2 -= 1;
                    }
                    Due::Expired(id, token) => {
                        let (_, due, left, _) = model.open[&token];
                        assert!(due <= now && left == 0);
                        assert_eq!(model.end(token), id);
                    }
                }
            }
            assert!(model.open.values().all(|(_, due, ..)| *due > now), "something due was missed");
            let first = model.open.values().map(|(_, due, ..)| *due).min();
            assert!(session.next_due() <= first || first.is_none());
            if first.is_some() {
                assert!(session.next_due().is_some());
            }
            assert_eq!(session.in_flight(), model.open.len());
        }
        assert_eq!(model.open.len(), 0);
        assert_eq!(model.ended.len(), model.opened.len());
    }
}
