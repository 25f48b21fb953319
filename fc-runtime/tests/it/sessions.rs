//! Random events for requests in flight. `conformance/sessions` defines the required behaviour in each situation.

use crate::common::{LIMITS, Toy, answer_to};
use fc_runtime::{
    AckPolicy, Busy, Due, FrameId, Incoming, Limits, Protocol, Session, SessionRules,
};
use proptest::collection::vec;
use proptest::prelude::{Strategy, any, prop_oneof, proptest};
use std::collections::{HashMap, HashSet};
use std::time::{Duration, Instant};

fn session(in_flight: usize, first_id: u32) -> Session<u32> {
    let limits = Limits {
        in_flight,
        ..LIMITS
    };
    Session::new(
        SessionRules::of::<Toy>(),
        &limits,
        Toy::DEFAULTS.ack,
        first_id,
    )
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

/// The history of every request.
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
