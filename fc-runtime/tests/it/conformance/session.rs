//! Scripts against the bare session.

use super::script::{
    Action, Event, Failure, Frame, Given, Got, IdBits, Kind, NextDue, Open, Place, Script, Sent,
    Step, Then, defaults,
};
use crate::common::short::Short;
use crate::common::{LIMITS, Toy};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{AckPolicy, Due, FrameId, Incoming, Limits, Protocol, Session, SessionRules};
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// A request that the session under test has opened.
struct Request {
    name: String,
    frame: FrameId,
    open: bool,
}

/// A frame that has arrived.
#[derive(Clone, Copy)]
struct Arrived {
    frame: FrameId,
    digest: Option<[u8; 16]>,
}

struct Run {
    session: Session<usize>,
    start: Instant,
    now: Instant,
    ack: AckPolicy,
    call_timeout: Duration,
    /// By the session's tokens.
    requests: Vec<Request>,
    /// The tokens of those in flight, by their ids.
    in_flight: HashMap<u32, usize>,
    arrived: HashMap<String, Arrived>,
    got: Got,
}

/// Runs a script. Returns the first step with another result than expected.
pub fn run(script: &Script) -> Result<(), Failure> {
    let rules = match script.given.id_bits {
        IdBits::Sixteen => SessionRules::of::<Short>(),
        IdBits::ThirtyTwo => SessionRules::of::<Toy>(),
    };
    Run::new(rules, &script.given)?.steps(&script.steps)
}

fn milliseconds(count: u64) -> Duration {
    Duration::from_millis(count)
}

/// Returns the kind of a frame, which both protocols share.
fn code_of(kind: Kind) -> u8 {
    match kind {
        Kind::Command => Toy::COMMAND,
        Kind::Report => Toy::REPORT,
        Kind::Stream => Toy::STREAM,
    }
}

impl Run {
    fn new(rules: SessionRules, given: &Given) -> Result<Self, Failure> {
        let limits = Limits {
            in_flight: given.in_flight.unwrap_or(defaults::IN_FLIGHT),
            queued_reports: given.queued_reports.unwrap_or(defaults::QUEUED_REPORTS),
            ..LIMITS
        };
        let remembers = limits
            .in_flight
            .max(limits.queued_reports)
            .max(rules.in_flight);
        if given.remembers.is_some_and(|said| said != remembers) {
            return Err(format!("such a peer remembers {remembers} reports"));
        }
        let ack = given.ack.unwrap_or(defaults::ACK);
        let ack = AckPolicy {
            timeout: milliseconds(ack.timeout),
            retries: ack.retries,
        };
        let now = Instant::now();
        Ok(Self {
            session: Session::new(rules, &limits, ack, given.first_id),
            start: now,
            now,
            ack,
            call_timeout: milliseconds(given.call_timeout.unwrap_or(defaults::CALL_TIMEOUT)),
            requests: Vec::new(),
            in_flight: HashMap::new(),
            arrived: HashMap::new(),
            got: Got::default(),
        })
    }

    fn steps(&mut self, steps: &[Step]) -> Result<(), Failure> {
        self.round(steps, 0, &Place::default())
    }

    fn round(&mut self, steps: &[Step], round: u32, place: &Place) -> Result<(), Failure> {
        for (index, step) in steps.iter().enumerate() {
            let place = place.step(index);
            self.step(step, round, &place)
                .and_then(|()| std::mem::take(&mut self.got).check(&step.expect))
                .and_then(|()| self.then(step.then.as_ref()))
                .map_err(|why| {
                    // Steps inside a repeated step have their position already.
                    if why.starts_with("step ") {
                        return why;
                    }
                    let at = self.now.duration_since(self.start).as_millis();
                    format!("{place}, at {at} ms: {why}")
                })?;
        }
        Ok(())
    }

    fn step(&mut self, step: &Step, round: u32, place: &Place) -> Result<(), Failure> {
        match step.action()? {
            Action::Call(open) => {
                let policy = AckPolicy {
                    timeout: self.call_timeout,
                    retries: 0,
                };
                self.open(open, Toy::COMMAND, policy)?;
            }
            Action::Report(open) => self.open(open, Toy::REPORT, self.ack)?,
            Action::Receive(frame) => self.receive(frame, round)?,
            Action::Advance(time) => {
                self.now += milliseconds(time);
                self.due()?;
            }
            Action::Lose(lose) => {
                let kept = lose.keeps.iter().map(|name| self.request(name));
                let kept = kept.collect::<Result<Vec<_>, _>>()?;
                for (frame, token) in self.session.end_if(|_, token| !kept.contains(token)) {
                    let name = self.end(token, frame)?;
                    self.got.push(Event::Ended(name));
                }
            }
            Action::Reconnect => self.session.reconnected(),
            Action::HandedOn(name) => {
                let Arrived { frame, digest } = self.arrived(name)?;
                match digest {
                    Some(digest) => self.session.handed_on_digested(frame, digest, self.now),
                    None => self.session.handed_on(frame, self.now),
                }
            }
            Action::Cancel(name) => {
                let token = self.request(name)?;
                let frame = self.requests[token].frame;
                if let Some(ended) = self.session.cancel(frame) {
                    let name = self.end(ended, frame)?;
                    self.got.push(Event::Ended(name));
                }
            }
            Action::Repeat(repeat) => {
                for round in 0..repeat.times {
                    self.round(&repeat.steps, round, &place.round(round))?;
                }
            }
            other @ (Action::Take | Action::Finish(_) | Action::Close | Action::Shutdown(_)) => {
                return Err(format!("a session cannot do that: {other:?}"));
            }
        }
        Ok(())
    }

    fn open(&mut self, open: &Open, kind: u8, policy: AckPolicy) -> Result<(), Failure> {
        let policy = AckPolicy {
            timeout: open.timeout.map_or(policy.timeout, milliseconds),
            retries: open.retries.unwrap_or(policy.retries),
        };
        let name = open.name.clone();
        let token = self.requests.len();
        let opened = self.session.open(kind, open.code, policy, self.now, token);
        let Ok(frame) = opened else {
            self.got.push(Event::Busy(name));
            return Ok(());
        };
        let wanted = FrameId {
            response: false,
            kind,
            code: open.code,
            id: frame.id,
        };
        if frame != wanted {
            return Err(format!("{name} is sent as {frame}"));
        }
        if let Some(other) = self.in_flight.insert(frame.id, token) {
            let other = &self.requests[other].name;
            return Err(format!("{name} has the id of {other}, which is in flight"));
        }
        let id = Some(frame.id);
        self.requests.push(Request {
            name: name.clone(),
            frame,
            open: true,
        });
        self.got.push(Event::Sends(Sent { name, id }));
        Ok(())
    }

    fn receive(&mut self, arriving: &Frame, round: u32) -> Result<(), Failure> {
        let answered = match &arriving.answer_to {
            Some(name) => Some(self.requests[self.request(name)?].frame.answer()),
            None => None,
        };
        let missing = "a frame that answers nothing has kind, code and id";
        let id = arriving.id.map(|id| id.wrapping_add(round));
        let frame = FrameId {
            response: answered.is_some(),
            kind: (arriving.kind.map(code_of))
                .or(answered.map(|frame| frame.kind))
                .ok_or(missing)?,
            code: (arriving.code.or(answered.map(|frame| frame.code))).ok_or(missing)?,
            id: id.or(answered.map(|frame| frame.id)).ok_or(missing)?,
        };
        let digest = arriving
            .data
            .as_ref()
            .map(|data| Md5::digest(data.as_bytes()));
        if let Some(name) = &arriving.name {
            self.arrived.insert(name.clone(), Arrived { frame, digest });
        }
        let incoming = match digest {
            Some(_) => self.session.receive_digested(frame, digest, self.now),
            None => self.session.receive(frame, self.now),
        };
        let event = match incoming {
            Incoming::Answer(token) => Event::Answer(self.end(token, frame)?),
            Incoming::Late => Event::Late,
            Incoming::Command => Event::Command,
            Incoming::Report => Event::Report,
            Incoming::Repeated => Event::Repeated,
            Incoming::Stream => Event::Stream,
        };
        self.got.push(event);
        Ok(())
    }

    fn due(&mut self) -> Result<(), Failure> {
        // No more can be due at once. A session that returns more is aborted.
        let most = self.requests.len() * 2 + 1;
        for _ in 0..most {
            let (frame, token, again) = match self.session.due(self.now) {
                None => return Ok(()),
                Some(Due::Again(frame, token)) => (frame, *token, true),
                Some(Due::Expired(frame, token)) => (frame, token, false),
            };
            if !again {
                let name = self.end(token, frame)?;
                self.got.push(Event::Expired(name));
                continue;
            }
            let request = self
                .requests
                .get(token)
                .ok_or("an unknown request is due")?;
            if request.frame != frame || !request.open {
                return Err(format!("{} is sent again as {frame}", request.name));
            }
            self.got.push(Event::Again(Sent {
                name: request.name.clone(),
                id: Some(frame.id),
            }));
        }
        Err("what is due does not come to an end".to_owned())
    }

    /// Notes that a request has ended: each does so once, and with its own frame.
    fn end(&mut self, token: usize, frame: FrameId) -> Result<String, Failure> {
        let request = self
            .requests
            .get_mut(token)
            .ok_or("an unknown request has ended")?;
        let same = FrameId {
            response: false,
            ..frame
        };
        if request.frame != same {
            return Err(format!("{} has ended with the {frame}", request.name));
        }
        if !std::mem::take(&mut request.open) {
            return Err(format!("{} has ended twice", request.name));
        }
        self.in_flight.remove(&frame.id);
        Ok(request.name.clone())
    }

    fn then(&self, then: Option<&Then>) -> Result<(), Failure> {
        let Some(then) = then else { return Ok(()) };
        let open = self.in_flight.len();
        let in_flight = self.session.in_flight();
        if then.in_flight.is_some_and(|expected| expected != in_flight) || in_flight != open {
            return Err(format!(
                "{in_flight} requests are in flight, and {open} have not ended"
            ));
        }
        let due = self.session.next_due();
        let due = due.map(|at| at.saturating_duration_since(self.now).as_millis());
        let next = NextDue::new(due);
        if let Some(expected) = then.next_due
            && expected != next
        {
            return Err(format!("the next is due {next:?} and not {expected:?}"));
        }
        if let Some(latest) = then.next_due_by
            && due.is_none_or(|due| due > u128::from(latest))
        {
            return Err(format!("the next is due in {due:?} ms and not by {latest}"));
        }
        Ok(())
    }

    /// The last request of this name.
    fn request(&self, name: &str) -> Result<usize, Failure> {
        let found = self
            .requests
            .iter()
            .rposition(|request| request.name == name);
        found.ok_or_else(|| format!("there is no request {name}"))
    }

    fn arrived(&self, name: &str) -> Result<Arrived, Failure> {
        let found = self.arrived.get(name).copied();
        found.ok_or_else(|| format!("no frame {name} has arrived"))
    }
}
