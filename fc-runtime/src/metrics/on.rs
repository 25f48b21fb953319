//! Metrics with a recorder.

use super::Family;
use crate::clock;
use crate::operation::OperationKind;
use crate::protocol::Protocol;
use crate::sync::lock;
use metrics::{Histogram, Unit};
use std::collections::HashMap;
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Label of all codes that the spec does not have, because a peer can send any number of them.
const UNKNOWN: &str = "unknown";

/// A number that only grows.
#[derive(Debug)]
pub(crate) struct Counter(metrics::Counter);

impl Counter {
    /// Returns the counter with this name and help text.
    pub(crate) fn new(name: &'static str, help: &'static str) -> Self {
        metrics::describe_counter!(name, help.trim_start());
        Self(metrics::counter!(name))
    }

    pub(crate) fn add(&self, n: u64) {
        self.0.increment(n);
    }
}

/// A number that rises and falls.
#[derive(Debug)]
pub(crate) struct Gauge(metrics::Gauge);

impl Gauge {
    /// Returns the gauge with this name, or its part for a port.
    pub(crate) fn new(name: &'static str, help: &'static str, port: Option<&'static str>) -> Self {
        metrics::describe_gauge!(name, help);
        Self(if let Some(port) = port {
            metrics::gauge!(name, "port" => port)
        } else {
            metrics::gauge!(name)
        })
    }

    /// Adds one until the returned value is dropped.
    pub(crate) fn hold(&self) -> Held {
        self.0.increment(1.0);
        Held(self.0.clone())
    }
}

/// One unit of a [`Gauge`].
#[derive(Debug)]
pub(crate) struct Held(metrics::Gauge);

impl Drop for Held {
    fn drop(&mut self) {
        self.0.decrement(1.0);
    }
}

/// Calls and times by operation. Operations of the spec have their own label; all other codes share one.
#[derive(Debug)]
pub(crate) struct Operations {
    family: &'static Family,
    by_code: HashMap<u16, Operation>,
    unknown: Operation,
}

#[derive(Debug)]
struct Operation {
    name: &'static str,
    seconds: OnceLock<Histogram>,
    /// Counters by result. There are few results.
    calls: Mutex<Vec<(&'static str, metrics::Counter)>>,
}

impl Operation {
    fn of(name: &'static str) -> Self {
        Self {
            name,
            seconds: OnceLock::new(),
            calls: Mutex::default(),
        }
    }
}

impl Operations {
    pub(crate) fn of<P: Protocol>(family: &'static Family) -> Self {
        metrics::describe_counter!(family.calls, family.calls_help);
        metrics::describe_histogram!(family.seconds, Unit::Seconds, family.seconds_help);
        // A stream is not called, and may have the code of its command.
        let called = P::operations()
            .iter()
            .filter(|operation| operation.kind != OperationKind::Stream);
        let named = called.filter_map(|operation| {
            let operation = (operation.code?, Operation::of(operation.name));
            Some(operation)
        });
        Self {
            family,
            by_code: named.collect(),
            unknown: Operation::of(UNKNOWN),
        }
    }

    fn get(&self, code: u16) -> &Operation {
        self.by_code.get(&code).unwrap_or(&self.unknown)
    }

    /// Counts a call with its result, which is one of few.
    pub(crate) fn called(&self, code: u16, result: &'static str) {
        let operation = self.get(code);
        let mut calls = lock(&operation.calls);
        if let Some((_, calls)) = calls.iter().find(|(known, _)| *known == result) {
            return calls.increment(1);
        }
        let counter = metrics::counter!(
            self.family.calls, "operation" => operation.name, "result" => result
        );
        counter.increment(1);
        calls.push((result, counter));
    }

    /// Records the time of a call.
    pub(crate) fn took(&self, code: u16, time: Duration) {
        let operation = self.get(code);
        let seconds = operation.seconds.get_or_init(
            || metrics::histogram!(self.family.seconds, "operation" => operation.name),
        );
        seconds.record(time);
    }
}

/// A start time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Since(Instant);

impl Since {
    pub(crate) fn now() -> Self {
        Self(clock::now())
    }

    pub(crate) fn elapsed(self) -> Duration {
        clock::now().saturating_duration_since(self.0)
    }
}
