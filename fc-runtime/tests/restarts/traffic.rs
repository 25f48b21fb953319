//! The traffic between app and robot, and its history.

use super::common::{Moved, Toy};
use fc_derive::{Command, Message};
use fc_runtime::{
    AckOutcome, Audience, CallError, Command, Connection, ConnectionState, Handling, Request,
    ServerHandle, Service,
};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::task::JoinSet;
use tokio::time::{Instant, interval, sleep};

pub const SECOND: Duration = Duration::from_secs(1);
/// Maximum number of calls or reports in an hour.
const MOST: usize = 5000;
/// Duration of a motion.
const MOVING: Duration = Duration::from_millis(400);

/// Asks for something.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0201, name = "look", effect = "read", response = Seen)]
pub struct Look {
    pub number: u32,
}

/// Moves, for a while.
#[derive(Clone, Debug, PartialEq, Message, Command)]
#[fc(code = 0x0203, name = "drive", effect = "motion", response = Seen)]
pub struct Drive {
    pub number: u32,
}

#[derive(Clone, Debug, PartialEq, Message)]
pub struct Seen {
    pub number: u32,
}

/// The history of calls and reports by number. Reserves all its memory at once.
pub struct Known {
    pub carried_out: Vec<u8>,
    pub handed_on: Vec<u8>,
    pub calls: u32,
    pub reports: i32,
    /// The robot is at work on a motion.
    pub is_moving: bool,
    /// Time of the last response.
    pub answered: Option<Instant>,
    pub ends: BTreeMap<&'static str, u32>,
    pub outcomes: BTreeMap<&'static str, u32>,
    pub states: Vec<String>,
}

impl Known {
    pub fn new() -> Self {
        Self {
            carried_out: vec![0; MOST],
            handed_on: vec![0; MOST],
            calls: 0,
            reports: 0,
            is_moving: false,
            answered: None,
            ends: BTreeMap::new(),
            outcomes: BTreeMap::new(),
            states: Vec::new(),
        }
    }

    /// The number of the next call.
    pub fn next_call(&mut self) -> u32 {
        self.calls += 1;
        self.calls
    }

    pub fn next_report(&mut self) -> i32 {
        self.reports += 1;
        self.reports
    }
}

pub type Shared = Arc<Mutex<Known>>;

/// A robot's handlers.
pub fn service(known: &Shared) -> impl Service<Toy> + use<> {
    let known = Arc::clone(known);
    move |request: Request<'_, Toy>| -> Handling {
        let known = Arc::clone(&known);
        let carry_out = move |number: u32, moves: bool| async move {
            known.lock().unwrap().carried_out[number as usize] += 1;
            if moves {
                known.lock().unwrap().is_moving = true;
                sleep(MOVING).await;
                known.lock().unwrap().is_moving = false;
            }
            Ok(Seen { number })
        };
        match request.code() {
            Look::CODE => request.handle(move |_, Look { number }| carry_out(number, false)),
            Drive::CODE => request.handle(move |_, Drive { number }| carry_out(number, true)),
            _ => request.unknown(),
        }
    }
}

pub async fn push_on(handle: ServerHandle<Toy>, known: Shared) {
    let mut turn = interval(SECOND);
    let mut open = JoinSet::new();
    loop {
        turn.tick().await;
        while open.try_join_next().is_some() {}
        let (handle, known) = (handle.clone(), Arc::clone(&known));
        open.spawn(async move {
            let metres = known.lock().unwrap().next_report();
            let pushed = handle.push(Audience::All, &Moved { metres }).await;
            for one in pushed.unwrap_or_default() {
                let outcome = match one.outcome {
                    AckOutcome::Acknowledged => "acknowledged",
                    AckOutcome::TimedOut => "not acknowledged",
                    AckOutcome::Dropped => "dropped",
                    AckOutcome::Closed => "cut off",
                    other => panic!("{other:?}"),
                };
                *known.lock().unwrap().outcomes.entry(outcome).or_default() += 1;
            }
        });
    }
}

pub async fn call_on(app: Connection<Toy>, known: Shared) {
    let mut turn = interval(SECOND);
    turn.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Skip);
    loop {
        turn.tick().await;
        let number = known.lock().unwrap().next_call();
        let end = if number.is_multiple_of(2) {
            app.call(&Look { number }).await
        } else {
            app.call(&Drive { number }).await
        };
        let mut known = known.lock().unwrap();
        let end = match end {
            Ok(seen) => {
                assert_eq!(seen.number, number, "the answer of another call");
                known.answered = Some(Instant::now());
                "answered"
            }
            Err(CallError::Frame(_)) => "unusable",
            Err(error) => error.name(),
        };
        *known.ends.entry(end).or_default() += 1;
    }
}

pub async fn take_on(app: Connection<Toy>, known: Shared, slow: Arc<AtomicBool>) {
    let mut reports = app.reports();
    drop(app);
    while let Some(report) = reports.recv().await {
        let Moved { metres } = report.read::<Toy, _>().expect("a report");
        let number = usize::try_from(metres).unwrap();
        known.lock().unwrap().handed_on[number] += 1;
        while slow.load(Ordering::Relaxed) {
            sleep(SECOND / 10).await;
        }
    }
}

pub async fn note_states(app: Connection<Toy>, known: Shared) {
    let mut states = app.states();
    drop(app);
    while let Some(state) = states.recv().await {
        let text = match state {
            ConnectionState::Connected { connects } => format!("connected {connects}"),
            ConnectionState::Connecting { why, .. } => format!("connecting {}", why.name()),
            ConnectionState::Closed { why, .. } => format!("closed {}", why.name()),
        };
        known.lock().unwrap().states.push(text);
    }
}
