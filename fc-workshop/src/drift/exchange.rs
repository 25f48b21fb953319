//! Requests without an answer.

use super::{DeviationKind, Found, Moment, Place, place};
use crate::capture::Flow;
use crate::decode::Record;
use fc_reflect::FrameId;
use fc_spec::model::{Direction, Exchange, Kind, Model};
use std::collections::{HashMap, HashSet, VecDeque};
use std::time::Duration;

/// Requests that are kept while their answer has not come, and flows that are known.
const KEPT: usize = 4096;

/// A request without an answer so far.
struct Open<'m> {
    place: Place,
    moment: Moment<'m>,
    /// The time until which an answer may come, if the input has times.
    deadline: Option<Duration>,
    /// Its number among the requests of all connections.
    number: u64,
}

/// The flow of a request, and the id of its frame.
type Asked = (Option<Flow>, FrameId);

/// The flow of a request, its kind and its code.
type Operation = (Option<Flow>, u8, u16);

/// The requests of all connections.
#[derive(Default)]
pub(super) struct Exchanges<'m> {
    open: HashMap<Asked, Open<'m>>,
    order: VecDeque<Asked>,
    /// The latest answered request of each operation, by number.
    answered: HashMap<Operation, u64>,
    /// Flows with frames. An input with one direction of a connection has no answers.
    flows: HashSet<Option<Flow>>,
    requests: u64,
    now: Option<Duration>,
}

impl<'m> Exchanges<'m> {
    /// Follows a record. Returns `true` if it repeats a request.
    pub(super) fn follow(
        &mut self,
        model: &'m Model,
        record: &Record<'m>,
        found: &mut Found<'m>,
    ) -> bool {
        self.now = self.now.max(record.time);
        if self.flows.len() < KEPT {
            self.flows.insert(record.flow);
        }
        self.expire(found);
        let Some(id) = record.id.filter(|_| record.frame.is_some()) else {
            return false;
        };
        if id.direction == Direction::Response {
            self.answer(record.flow.map(Flow::reversed), id);
            return false;
        }
        let operation = record.operation;
        let Some(wait) = operation.and_then(|it| longest_wait(model, &it.exchange)) else {
            return false;
        };
        let asked = (record.flow, id);
        let deadline = record.time.map(|time| time.saturating_add(wait));
        if let Some(earlier) = self.open.get_mut(&asked) {
            earlier.deadline = deadline;
            return true;
        }
        let kind = if operation.map(fc_spec::model::Operation::kind) == Some(Kind::Report) {
            DeviationKind::Unacknowledged
        } else {
            DeviationKind::Unanswered
        };
        self.requests += 1;
        let open = Open {
            place: place(record, kind),
            moment: Moment::of(record),
            deadline,
            number: self.requests,
        };
        self.open.insert(asked, open);
        self.order.push_back(asked);
        if self.order.len() > KEPT
            && let Some(oldest) = self.order.pop_front()
        {
            self.open.remove(&oldest);
        }
        false
    }

    /// Ends the request of an answer.
    fn answer(&mut self, flow: Option<Flow>, answer: FrameId) {
        let request = FrameId {
            direction: Direction::Request,
            ..answer
        };
        let Some(open) = self.open.remove(&(flow, request)) else {
            return;
        };
        let operation = (flow, request.kind, request.code);
        if self.answered.len() < KEPT || self.answered.contains_key(&operation) {
            let latest = self.answered.entry(operation).or_default();
            *latest = open.number.max(*latest);
        }
    }

    /// Counts the requests whose time is over.
    fn expire(&mut self, found: &mut Found<'m>) {
        while let Some(asked) = self.order.front() {
            let open = self.open.get(asked);
            let deadline = open.map(|open| open.deadline.zip(self.now));
            match deadline {
                // It has an answer, or its time is over.
                None => {}
                Some(Some((deadline, now))) if deadline < now => {}
                Some(_) => return,
            }
            if let Some(open) = self.open.remove(asked)
                && self.flows.contains(&asked.0.map(Flow::reversed))
            {
                found.add_at(&open.moment, open.place, Default::default);
            }
            self.order.pop_front();
        }
    }

    /// Counts the requests of an input without times: those that a later request of the same operation has overtaken.
    pub(super) fn finish(&mut self, found: &mut Found<'m>) {
        self.expire(found);
        for asked in std::mem::take(&mut self.order) {
            let (flow, id) = asked;
            let Some(open) = self.open.remove(&asked) else {
                continue;
            };
            let latest = self.answered.get(&(flow, id.kind, id.code));
            let is_overtaken = latest.is_some_and(|latest| open.number < *latest);
            if open.deadline.is_none() && is_overtaken {
                found.add_at(&open.moment, open.place, Default::default);
            }
        }
    }
}

/// Returns the longest time from a request to its answer, or `None` if it has none.
fn longest_wait(model: &Model, exchange: &Exchange) -> Option<Duration> {
    let ms = match exchange {
        Exchange::Command { .. } => model.calls.timeout_ms,
        Exchange::Report { ack, .. } => {
            let sendings = ack.retries.saturating_add(1);
            ack.timeout_ms.saturating_mul(sendings)
        }
        Exchange::Stream(_) => return None,
    };
    Some(Duration::from_millis(ms.into()))
}
