//! Scenarios from recorded traffic: the robot answers as recorded, and the app asks as recorded.

use crate::arguments::json;
use crate::decode::Record;
use crate::facts;
use crate::scenario::{Action, Expected, Rule, Scenario, ScriptedReport};
use fc_reflect::FrameId;
use fc_reflect::sample::Samples;
use fc_spec::model::{Direction, KindRole, Model, ResultRole, Value};
use std::collections::{HashMap, HashSet};
use std::time::Duration;

/// The most requests, reports and acknowledgements of a scenario.
const MOST: usize = 100_000;

/// The most bytes in their bodies.
const MOST_BYTES: usize = 64 << 20;

/// The longest wait of a replay. The times of a damaged recording may be too far apart for the clock.
const LONGEST: Duration = Duration::from_secs(365 * 24 * 60 * 60);

/// The time that a replay may take longer than its recording.
const MORE: Duration = Duration::from_secs(30);

/// A scenario that grows with a recording.
pub struct Recorded<'m> {
    model: &'m Model,
    scenario: Scenario,
    /// The rules of requests whose response has not come.
    open: HashMap<FrameId, usize>,
    /// The reports that have come, to pass over repetitions.
    reports: HashSet<FrameId>,
    /// The time of the first frame.
    first: Option<Duration>,
    /// The time of the last response or report.
    last: Option<Duration>,
    /// The number of bytes in the bodies of all frames.
    bytes: usize,
    is_full: bool,
}

impl<'m> Recorded<'m> {
    /// Creates an empty scenario.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        Self {
            model,
            scenario: Scenario {
                rules: Vec::new(),
                expect: Vec::new(),
                never: Vec::new(),
                within: MORE,
            },
            open: HashMap::new(),
            reports: HashSet::new(),
            first: None,
            last: None,
            bytes: 0,
            is_full: false,
        }
    }

    /// Adds a frame. Frames with errors, of unknown codes and of streams are passed over.
    pub fn add(&mut self, record: &Record<'m>) {
        let (Some(operation), Some(id), Some(frame)) = (record.operation, record.id, &record.frame)
        else {
            return;
        };
        let Some(message) = std::str::from_utf8(&frame.data).ok().and_then(json) else {
            return;
        };
        self.bytes = self.bytes.saturating_add(frame.data.len());
        let count = self.scenario.expect.len() + self.reports.len();
        self.is_full |= count >= MOST || self.bytes > MOST_BYTES;
        if self.is_full {
            return;
        }
        self.first = self.first.or(record.time);
        if let Some((first, time)) = self.first.zip(record.time) {
            self.scenario.within = MORE + possible(time.saturating_sub(first));
        }
        let name = operation.name.clone();
        match (frame.kind.role, id.direction) {
            (KindRole::Command, Direction::Request) => self.request(id, name, &message),
            (KindRole::Command, Direction::Response) => {
                self.response(id, record, &message);
                self.last = record.time;
            }
            (KindRole::Report, Direction::Request) => {
                if self.reports.insert(id) {
                    self.report(name, record.time, &message);
                    self.last = record.time;
                }
            }
            (KindRole::Report, Direction::Response) => {
                self.scenario.expect.push(Expected::Acknowledgement(name));
            }
            (KindRole::Stream | KindRole::Reserved, _) => {}
        }
    }

    fn request(&mut self, id: FrameId, name: String, message: &Value) {
        let with = self.body(message, Direction::Request);
        self.open.insert(id, self.scenario.rules.len());
        self.scenario.rules.push(Rule {
            request: name.clone(),
            with: with.clone(),
            times: Some(1),
            action: Action {
                // Until its response comes.
                silent: true,
                reports: Some(Vec::new()),
                ..Action::default()
            },
        });
        self.scenario.expect.push(Expected::Request(name, with));
    }

    fn response(&mut self, id: FrameId, record: &Record<'_>, message: &Value) {
        let request = FrameId {
            direction: Direction::Request,
            ..id
        };
        let answer = self.body(message, Direction::Response);
        let success = facts::result(self.model, ResultRole::Success);
        let success = success.map(|success| success.code);
        let rule = self.open.remove(&request);
        let Some(rule) = rule.and_then(|rule| self.scenario.rules.get_mut(rule)) else {
            return;
        };
        let action = &mut rule.action;
        action.silent = false;
        let elapsed = record.request.and_then(|request| request.elapsed);
        action.delay = possible(elapsed.unwrap_or_default());
        match record.result() {
            Some(code) if Some(code) != success => action.refuse = Some(code),
            _ => action.answer = Some(answer),
        }
    }

    /// Adds a report behind the last request. Reports before the first one come without a cause.
    fn report(&mut self, report: String, time: Option<Duration>, message: &Value) {
        let body = self.body(message, Direction::Request);
        let after = time.zip(self.last);
        let after = after.and_then(|(time, last)| time.checked_sub(last));
        let rule = self.scenario.rules.last_mut();
        if let Some(reports) = rule.and_then(|rule| rule.action.reports.as_mut()) {
            reports.push(ScriptedReport {
                report,
                body,
                after: possible(after.unwrap_or_default()),
            });
        }
    }

    /// Returns a message without its envelope, such as the time and the result.
    fn body(&self, message: &Value, direction: Direction) -> Value {
        let envelope = Samples::new(self.model).envelope(direction);
        let mut body = message.clone();
        if let Value::Object(entries) = &mut body {
            entries.retain(|(key, _)| envelope.iter().all(|field| field.wire != *key));
        }
        body
    }

    /// Returns the scenario, or `None` if the recording is too long for one.
    #[must_use]
    pub fn finish(self) -> Option<Scenario> {
        (!self.is_full).then_some(self.scenario)
    }
}

/// Cuts a wait to [`LONGEST`].
fn possible(wait: Duration) -> Duration {
    wait.min(LONGEST)
}
