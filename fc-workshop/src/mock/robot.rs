//! The robot of a mock: its answers and its reports.

use super::apps::Report;
use crate::facts;
use fc_reflect::sample::Profile;
use fc_reflect::{Direction, Frame, FrameError, FrameId, Packing, Reflector};
use fc_spec::model::{
    Cadence, EnvelopeRole, Exchange, Kind, Operation, ResultCode, ResultRole, Side, Value,
};
use std::time::{Duration, Instant};

/// A robot without a connection.
pub(super) struct Robot<'m> {
    reflector: &'m Reflector<'m>,
    /// Reports at intervals, with the time of the next one.
    periodic: Vec<(Instant, Duration, &'m Operation)>,
}

impl<'m> Robot<'m> {
    pub(super) fn new(reflector: &'m Reflector<'m>) -> Self {
        let now = Instant::now();
        let operations = reflector.model().operations.iter();
        let periodic = operations.filter_map(|operation| match operation.cadence() {
            Some(Cadence::EveryMs(interval)) => {
                let interval = Duration::from_millis(u64::from(*interval).max(1));
                Some((now + interval, interval, operation))
            }
            _ => None,
        });
        Self {
            reflector,
            periodic: periodic.collect(),
        }
    }

    /// Returns the time of the next report.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.periodic.iter().map(|(due, _, _)| *due).min()
    }

    /// Returns the reports that are due.
    pub(super) fn due(&mut self, now: Instant) -> Vec<Report> {
        let mut reports = Vec::new();
        for (due, interval, operation) in &mut self.periodic {
            if *due <= now {
                *due = now + *interval;
                reports.push(*operation);
            }
        }
        let reports = reports.into_iter();
        reports.filter_map(|report| self.report(report)).collect()
    }

    fn report(&self, operation: &Operation) -> Option<Report> {
        let samples = self.reflector.samples();
        let mut message = samples.message(operation, Direction::Request, Profile::Example);
        facts::stamp(self.reflector.model(), Direction::Request, &mut message);
        let Exchange::Report { ack, .. } = &operation.exchange else {
            return None;
        };
        Some(Report {
            code: operation.code.value?,
            data: message.to_string().into_bytes().into(),
            ack: facts::ack(*ack),
        })
    }

    /// Returns the answer to a request.
    pub(super) fn answer(&mut self, frame: &Frame<'m>) -> Option<Vec<u8>> {
        let model = self.reflector.model();
        let is_mine = |operation: &&Operation| {
            operation.kind() == Kind::Command && operation.sender == Side::App
        };
        let Some(operation) = frame.operation.filter(is_mine) else {
            return self.refuse(frame.id, ResultRole::Protocol, "");
        };
        let direction = Direction::Request;
        let read = (self.reflector).message(Some(operation), direction, &frame.data);
        if let Err(error) = read.and_then(|message| message.body) {
            return self.refuse(frame.id, ResultRole::Invalid, &error.to_string());
        }
        let success = facts::result(model, ResultRole::Success)?;
        let message = (self.reflector.samples()).response(Some(operation), success);
        self.seal(frame.id.answer(), message)
    }

    /// Returns the answer to a frame with an error.
    pub(super) fn answer_invalid(&mut self, id: FrameId, error: &FrameError) -> Option<Vec<u8>> {
        (id.direction == Direction::Request)
            .then(|| self.refuse(id, ResultRole::Protocol, error.fault.name()))?
    }

    fn refuse(&self, id: FrameId, role: ResultRole, reason: &str) -> Option<Vec<u8>> {
        let model = self.reflector.model();
        model.envelope.result_code()?;
        let result = facts::result(model, role)?;
        let mut message = (self.reflector.samples()).response(None, result);
        if !reason.is_empty() {
            self.set_text(&mut message, result, reason);
        }
        self.seal(id.answer(), message)
    }

    /// Adds the reason of a refusal to its text.
    fn set_text(&self, message: &mut Value, result: &ResultCode, reason: &str) {
        let fields = &self.reflector.model().envelope.response;
        let texts = fields.iter();
        for field in texts.filter(|field| field.role == EnvelopeRole::ResultText) {
            let text = format!("{}: {reason}", result.text.zh);
            message.set(&field.wire, Value::String(text));
        }
    }

    fn seal(&self, id: FrameId, mut message: Value) -> Option<Vec<u8>> {
        facts::stamp(self.reflector.model(), id.direction, &mut message);
        let data = message.to_string();
        (self.reflector)
            .seal(id, data.as_bytes(), Packing::Plain)
            .ok()
    }
}
