//! The history of every call and report, and the properties that must hold.

use super::wire::Wire;
use super::world::Course;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;
use tokio::time::Instant;

/// A call and its end.
#[derive(Debug, Default)]
pub struct Call {
    pub effect: &'static str,
    pub repeat: Option<bool>,
    /// Number of times the robot started it.
    pub carried_out: u32,
    pub ends: Vec<&'static str>,
}

/// The history of a run.
#[derive(Default)]
pub struct Model {
    pub calls: HashMap<u32, Call>,
    /// Number of deliveries of each report.
    pub handed_on: HashMap<u32, u32>,
    pub outcomes: HashMap<u32, &'static str>,
    pub wires: Vec<Wire>,
    pub connects: u64,
    /// Injected faults.
    pub events: BTreeMap<&'static str, u64>,
    /// Reasons of losses.
    pub losses: BTreeMap<&'static str, u64>,
    /// Waiting times of apps after the last fault.
    pub waits: Vec<Option<Duration>>,
    /// Violations.
    pub faults: Vec<String>,
    /// All that happened, in order.
    pub log: Vec<String>,
}

pub type Shared = Arc<Mutex<Model>>;

pub fn lock(model: &Shared) -> MutexGuard<'_, Model> {
    model.lock().unwrap()
}

/// Longest wait of an app after the last fault. TCP needs a minute to detect a swallowing wire. A robot waits half a
/// minute for a stalled frame, and reads nothing else meanwhile.
const PATIENCE: Duration = Duration::from_secs(75);

/// Statistics of a run.
pub type Tally = BTreeMap<&'static str, u64>;

impl Model {
    /// Address of the app of the next wire, by which a handler knows its wire.
    pub fn address_of_next(&self) -> SocketAddr {
        let port = u16::try_from(self.wires.len()).expect("not so many wires");
        SocketAddr::from((Ipv4Addr::LOCALHOST, port))
    }

    /// A handler begins to carry out a call.
    pub fn begins(&mut self, number: u32, app: SocketAddr, id: u32) {
        let call = self.calls.get_mut(&number).expect("a call");
        call.carried_out += 1;
        // There are none over real sockets.
        if let Some(wire) = self.wires.get(usize::from(app.port())) {
            wire.ledger().begins(id, number);
        }
    }

    /// The robot will be cut off from its apps.
    pub fn cut_off(&mut self, at: Instant) {
        for wire in &self.wires {
            let mut ledger = wire.ledger();
            ledger.cut_off = Some(ledger.cut_off.map_or(at, |before| before.min(at)));
        }
    }

    /// Notes an injected fault.
    pub fn event(&mut self, what: &'static str) {
        *self.events.entry(what).or_default() += 1;
        self.log.push(what.into());
    }

    /// Checks all promises at the end of a run.
    pub fn check(&self, tally: &mut Tally) {
        assert!(self.faults.is_empty(), "{:#?}", self.faults);
        self.check_calls(tally);
        self.check_reports(tally);
        self.check_wires(tally);
        for (what, count) in &self.events {
            *tally.entry(what).or_default() += count;
        }
        for (why, count) in &self.losses {
            *tally.entry(lost(why)).or_default() += count;
        }
        let longest = tally
            .entry("ms that an app waited in the calm at most")
            .or_default();
        for wait in &self.waits {
            let wait = wait.expect("an app has an answer again");
            assert!(wait <= PATIENCE, "an app had no answer for {wait:?}");
            *longest = (*longest).max(u64::try_from(wait.as_millis()).unwrap());
        }
        *tally.entry("connections").or_default() += self.connects;
    }

    fn check_wires(&self, tally: &mut Tally) {
        let mut arrived = HashSet::new();
        for wire in &self.wires {
            let ledger = wire.ledger();
            assert!(ledger.faults.is_empty(), "{:#?}", ledger.faults);
            arrived.extend(ledger.arrived());
            if let Some(what) = ledger.deafened {
                *tally.entry(what).or_default() += ledger.answered_deaf;
            }
        }
        for number in arrived {
            let ends = &self.calls[&number].ends;
            assert_ne!(ends, &["lost"], "the answer to call {number} had come");
        }
        *tally
            .entry("frames said twice, swapped, replayed or forged")
            .or_default() += self.wires.iter().map(Wire::odd).sum::<u64>();
    }

    fn check_calls(&self, tally: &mut Tally) {
        for (number, call) in &self.calls {
            assert_eq!(
                call.ends.len(),
                1,
                "call {number} has ended {:?}",
                call.ends
            );
            let end = call.ends[0];
            *tally
                .entry(match end {
                    "answered" => "calls answered",
                    "refused" => "calls refused",
                    "handler timeout" => "calls ended by the handler timeout",
                    "panicked" => "calls ended by a panic",
                    "timeout" => "calls timed out",
                    "lost" => "calls lost",
                    "busy" => "calls refused as too many",
                    "closed" | "not_connected" => "calls not sent",
                    "given up" => "calls given up by the caller",
                    other => panic!("call {number}: {other}"),
                })
                .or_default() += 1;
            let course = Course::of(*number);
            let panics = matches!(course, Course::Panics | Course::PanicsLater);
            match end {
                "panicked" => assert!(panics, "call {number}"),
                "answered" => assert!(!panics, "call {number}"),
                _ => {}
            }
            let once =
                call.effect != "read" && call.repeat != Some(true) || call.repeat == Some(false);
            if once {
                assert!(
                    call.carried_out <= 1,
                    "{} {number} was carried out {} times",
                    call.effect,
                    call.carried_out
                );
            } else if call.carried_out > 1 {
                *tally.entry("calls repeated after a loss").or_default() += 1;
            }
            match end {
                "answered" | "refused" | "handler timeout" | "panicked" => {
                    assert!(call.carried_out >= 1, "call {number}");
                }
                "busy" | "closed" | "not_connected" => {
                    assert_eq!(call.carried_out, 0, "call {number} was sent");
                }
                _ => {}
            }
        }
    }

    fn check_reports(&self, tally: &mut Tally) {
        for (number, outcome) in &self.outcomes {
            let handed_on = self.handed_on.get(number).copied().unwrap_or(0);
            assert!(
                handed_on <= 1,
                "report {number} was handed on {handed_on} times"
            );
            *tally
                .entry(match *outcome {
                    "acknowledged" => {
                        assert_eq!(
                            handed_on, 1,
                            "report {number} was acknowledged and not handed on"
                        );
                        "reports acknowledged"
                    }
                    "dropped" => {
                        assert_eq!(handed_on, 0, "report {number} was dropped and handed on");
                        "reports dropped by a full queue"
                    }
                    "timed out" => "reports not acknowledged in time",
                    "closed" => "reports cut off by a loss",
                    "no_connection" => "reports to nobody",
                    other => panic!("report {number}: {other}"),
                })
                .or_default() += 1;
        }
        assert!(
            self.handed_on
                .keys()
                .all(|number| self.outcomes.contains_key(number))
        );
    }
}

/// Returns the name of a loss in the statistics.
fn lost(why: &'static str) -> &'static str {
    match why {
        "closed_by_robot" | "closed_unheard" => "connections lost: closed by the robot",
        "broken" => "connections lost: broken",
        "stalled" => "connections lost: a frame stalled",
        "unread" => "connections lost: the robot does not read",
        "bad_head" | "short_frame" | "frame_too_long" => "connections lost: no frame",
        "truncated" => "connections lost: ended inside a frame",
        "unreachable" => "connections not made: the robot is not there",
        other => panic!("{other}"),
    }
}
