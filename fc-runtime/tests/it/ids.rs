//! Message ids of a header that has sixteen bits for them.

use crate::common::short::Short;
use fc_runtime::{AckPolicy, Busy, Incoming, Limits, Protocol, Session, SessionRules};
use std::collections::HashSet;
use std::time::{Duration, Instant};

const POLICY: AckPolicy = AckPolicy {
    timeout: Duration::from_secs(1),
    retries: 0,
};
const HALF: usize = 1 << 15;

fn session(in_flight: usize, first_id: u32) -> Session<u32> {
    let limits = Limits {
        in_flight,
        ..Short::DEFAULTS.limits
    };
    Session::new(SessionRules::of::<Short>(), &limits, POLICY, first_id)
}

#[fc_test::test]
fn ids_begin_again_behind_the_largest_of_the_header() {
    let now = Instant::now();
    // Only the low bits of a larger first id count.
    let mut session = session(4, 0x0001_FFFE);
    let ids = [0xFFFE, 0xFFFF, 0, 1];
    for (token, id) in (0..).zip(ids) {
        let request = session.open(Short::COMMAND, 7, POLICY, now, token).unwrap();
        assert_eq!(request.id, id);
        let answer = session.receive(request.answer(), now);
        assert_eq!(answer, Incoming::Answer(token));
    }
}

#[fc_test::test]
fn at_most_half_of_all_ids_are_in_flight() {
    let now = Instant::now();
    let mut session = session(usize::MAX, 60_000);
    let mut open = || session.open(Short::COMMAND, 7, POLICY, now, 0);
    let ids: Vec<_> = (0..HALF).map(|_| open().unwrap()).collect();
    assert_eq!(open(), Err(Busy { limit: HALF }));
    let distinct: HashSet<_> = ids.iter().map(|request| request.id).collect();
    assert_eq!(distinct.len(), HALF);
    assert!(distinct.iter().all(|id| *id <= 0xFFFF));

    // One that has become free comes again after all others that are.
    let first = *ids.first().unwrap();
    session.cancel(first).unwrap();
    for _ in 0..HALF {
        let request = session.open(Short::COMMAND, 7, POLICY, now, 0).unwrap();
        assert!(!distinct.contains(&request.id), "{}", request.id);
        session.cancel(request).unwrap();
    }
    let request = session.open(Short::COMMAND, 7, POLICY, now, 0).unwrap();
    assert_eq!(request.id, first.id);
}
