//! The robot of a mock: its answers and its reports.

use super::Settings;
use super::apps::Report;
use super::memory::Memory;
use super::process;
use crate::arguments::json;
use crate::facts;
use crate::scenario::{Action, Play, Verdict, merge, omit};
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Frame, FrameError, FrameId, Packing, Reflector};
use fc_spec::model::{
    Cadence, EnvelopeRole, Exchange, HeaderRole, Kind, Operation, ResultRole, Side, Value,
};
use std::time::{Duration, Instant};

/// The largest number of planned reports.
const MOST_PLANNED: usize = 4096;

/// A robot without a connection.
pub(super) struct Robot<'m> {
    reflector: &'m Reflector<'m>,
    memory: Memory,
    /// Reports that are planned.
    plan: Vec<Planned<'m>>,
    /// The time between two reports of a process whose interval the spec does not specify.
    pace: Duration,
    /// `true` if commands are accepted although their preconditions are not met.
    ignores_preconditions: bool,
    scenario: Option<Play>,
}

/// A report that is planned.
struct Planned<'m> {
    due: Instant,
    report: &'m Operation,
    message: Value,
    /// The interval of a report that is sent again and again.
    interval: Option<Duration>,
}

/// The response to a request.
pub(super) struct Answer<'m> {
    /// The frame; empty if there is no response.
    pub(super) bytes: Vec<u8>,
    /// The command, if it was accepted.
    pub(super) accepted: Option<&'m Operation>,
    /// Time before the response.
    pub(super) delay: Duration,
    /// `true` if the connection ends after the response.
    pub(super) disconnect: bool,
}

impl<'m> Robot<'m> {
    pub(super) fn new(reflector: &'m Reflector<'m>, settings: &Settings) -> Self {
        let now = Instant::now();
        let model = reflector.model();
        let mut robot = Self {
            reflector,
            memory: Memory::new(model),
            plan: Vec::new(),
            pace: settings.pace,
            ignores_preconditions: settings.ignores_preconditions,
            scenario: settings.scenario.clone().map(Play::new),
        };
        for report in spontaneous(reflector) {
            if let Some(Cadence::EveryMs(interval)) = report.cadence() {
                let interval = Duration::from_millis(u64::from(*interval).max(1));
                robot.plan.push(Planned {
                    due: now + interval,
                    report,
                    message: robot.sample(report),
                    interval: Some(interval),
                });
            }
        }
        robot
    }

    fn sample(&self, report: &Operation) -> Value {
        let samples = self.reflector.samples();
        samples.message(report, Direction::Request, Profile::Example)
    }

    /// Returns the time of the next report.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.plan.iter().map(|planned| planned.due).min()
    }

    /// Returns the next report that is due.
    pub(super) fn due(&mut self, now: Instant) -> Option<Report> {
        let due = self.plan.iter().enumerate();
        let (first, planned) = due.min_by_key(|(_, planned)| planned.due)?;
        if planned.due > now {
            return None;
        }
        let (report, message) = (planned.report, planned.message.clone());
        if let Some(interval) = planned.interval {
            if let Some(planned) = self.plan.get_mut(first) {
                planned.due = now + interval;
            }
        } else {
            self.plan.remove(first);
            self.memory
                .observe(self.reflector.model(), report, &message);
        }
        self.report(report, message)
    }

    /// Returns one of each report that no command sets off and that has no interval.
    pub(super) fn greeting(&self) -> Vec<Report> {
        let reports = spontaneous(self.reflector);
        let reports = reports.filter(|it| !matches!(it.cadence(), Some(Cadence::EveryMs(_))));
        reports
            .filter_map(|report| self.report(report, self.sample(report)))
            .collect()
    }

    fn report(&self, operation: &Operation, mut message: Value) -> Option<Report> {
        let Exchange::Report { ack, .. } = &operation.exchange else {
            return None;
        };
        let model = self.reflector.model();
        let direction = Direction::Request;
        (self.memory).fill(model, operation, direction, &mut message);
        facts::stamp(model, direction, &mut message);
        Some(Report {
            code: operation.code.value?,
            data: message.to_string().into_bytes().into(),
            ack: facts::ack(*ack),
        })
    }

    /// Returns the answer to a request.
    pub(super) fn answer(&mut self, frame: &Frame<'m>) -> Option<Answer<'m>> {
        let is_mine = |operation: &&Operation| {
            operation.kind() == Kind::Command && operation.sender == Side::App
        };
        let Some(operation) = frame.operation.filter(is_mine) else {
            return self.refuse(frame.id, ResultRole::Protocol, "");
        };
        let direction = Direction::Request;
        let read = (self.reflector).message(Some(operation), direction, &frame.data);
        let text = match read.and_then(|message| message.canonical()) {
            Ok(text) => text,
            Err(error) => {
                return self.refuse(frame.id, ResultRole::Invalid, &error.to_string());
            }
        };
        let request = json(&text).unwrap_or(Value::Null);
        let scenario = self.scenario.as_mut();
        let scripted = scenario.and_then(|play| play.request(&operation.name, &request));
        // In a scenario, preconditions do not count.
        if scripted.is_none() && !self.ignores_preconditions {
            let objection = self.memory.objection(self.reflector.model(), operation);
            if let Some(objection) = objection {
                return self.refuse(frame.id, ResultRole::Protocol, &objection);
            }
        }
        self.act(frame.id, operation, &request, &scripted.unwrap_or_default())
    }

    /// Answers as an action demands. The default one accepts the request.
    fn act(
        &mut self,
        id: FrameId,
        command: &'m Operation,
        request: &Value,
        action: &Action,
    ) -> Option<Answer<'m>> {
        let model = self.reflector.model();
        let (message, accepted) = if let Some(code) = action.refuse {
            let result = model.results.iter().find(|result| result.code == code)?;
            (self.reflector.samples().response(None, result), None)
        } else {
            self.memory.accept(model, command, request);
            let success = facts::result(model, ResultRole::Success)?;
            let mut message = (self.reflector.samples()).response(Some(command), success);
            (self.memory).fill(model, command, Direction::Response, &mut message);
            if let Some(values) = &action.answer {
                merge(&mut message, values);
            }
            for path in &action.omit {
                omit(&mut message, path);
            }
            if action.reports.is_none() {
                self.begin(command, request, &message);
            }
            (message, Some(command))
        };
        let mut bytes = self.seal(id.answer(), message)?;
        self.plan_scripted(action);
        if action.bad_digest {
            let digest = HeaderRole::Digest;
            self.reflector.overwrite(&mut bytes, digest, 0xBAD);
        }
        if action.silent {
            bytes.clear();
        }
        Some(Answer {
            bytes,
            accepted,
            delay: action.delay,
            disconnect: action.disconnect,
        })
    }

    fn plan_scripted(&mut self, action: &Action) {
        let mut due = Instant::now() + action.delay;
        for scripted in action.reports.iter().flatten() {
            let Some(report) = self.reflector.model().operation(&scripted.report) else {
                continue;
            };
            due += scripted.after;
            let mut message = self.sample(report);
            merge(&mut message, &scripted.body);
            if self.plan.len() < MOST_PLANNED {
                self.plan.push(Planned {
                    due,
                    report,
                    message,
                    interval: None,
                });
            }
        }
    }

    /// Notes the acknowledgement of a report.
    pub(super) fn acknowledged(&mut self, frame: &Frame<'_>) {
        if let (Some(play), Some(report)) = (&mut self.scenario, frame.operation) {
            play.acknowledged(&report.name);
        }
    }

    /// Returns the state of the scenario, or `None` without one.
    pub(super) fn verdict(&self) -> Option<Verdict> {
        self.scenario.as_ref().map(Play::verdict)
    }

    /// Plans the reports that a command sets off. They replace those of a process that still runs.
    fn begin(&mut self, command: &'m Operation, request: &Value, response: &Value) {
        let now = Instant::now();
        for set_off in command.sets_off() {
            let Some(report) = self.reflector.model().operation(&set_off.report) else {
                continue;
            };
            self.plan
                .retain(|planned| planned.report.name != report.name);
            let steps = process::steps(
                self.reflector,
                set_off,
                report,
                request,
                response,
                self.pace,
            );
            self.plan.extend(steps.into_iter().map(|step| Planned {
                due: now + step.after,
                report,
                message: step.message,
                interval: None,
            }));
        }
    }

    /// Returns the answer to a frame with an error.
    pub(super) fn answer_invalid(&mut self, id: FrameId, error: &FrameError) -> Option<Answer<'m>> {
        if id.direction == Direction::Response {
            return None;
        }
        self.refuse(id, ResultRole::Protocol, error.fault.name())
    }

    fn refuse(&self, id: FrameId, role: ResultRole, reason: &str) -> Option<Answer<'m>> {
        let model = self.reflector.model();
        model.envelope.result_code()?;
        let result = facts::result(model, role)?;
        let mut message = (self.reflector.samples()).response(None, result);
        let fields = model.envelope.response.iter();
        let texts = fields.filter(|field| field.role == EnvelopeRole::ResultText);
        // The reason follows the text of the result.
        for field in texts.filter(|_| !reason.is_empty()) {
            let text = format!("{}: {reason}", result.text.zh);
            message.set(&field.wire, Value::String(text));
        }
        Some(Answer {
            bytes: self.seal(id.answer(), message)?,
            accepted: None,
            delay: Duration::ZERO,
            disconnect: false,
        })
    }

    fn seal(&self, id: FrameId, mut message: Value) -> Option<Vec<u8>> {
        facts::stamp(self.reflector.model(), id.direction, &mut message);
        let data = message.to_string();
        (self.reflector)
            .seal(id, data.as_bytes(), Packing::Plain)
            .ok()
    }
}

/// Returns the reports that no command sets off.
fn spontaneous<'m>(reflector: &Reflector<'m>) -> impl Iterator<Item = &'m Operation> {
    let model = reflector.model();
    let reports = model.operations.iter();
    reports.filter(|report| {
        report.kind() == Kind::Report && model.commands_that_set_off(report).next().is_none()
    })
}
