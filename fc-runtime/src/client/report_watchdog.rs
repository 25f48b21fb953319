//! Whether reports that come at intervals come in time.

use crate::preconditions::Cadence;
use crate::protocol::Protocol;
use std::time::{Duration, Instant};

/// What the spec says of intervals, and when the last report of each kind came. Other reports are not here.
#[derive(Debug)]
pub(super) struct ReportWatchdog(Vec<ReportInterval>);

#[derive(Debug)]
struct ReportInterval {
    code: u16,
    /// From one report to the next, with what networks and robots add.
    at_most: Duration,
    last: Option<Instant>,
}

impl ReportWatchdog {
    pub(super) fn of<P: Protocol>() -> Self {
        let intervals = P::operations().iter().filter_map(|operation| {
            let Some(Cadence::Every(every)) = operation.cadence else {
                return None;
            };
            Some(ReportInterval {
                code: operation.code?,
                at_most: every.saturating_add(every / 2),
                last: None,
            })
        });
        Self(intervals.collect())
    }

    /// A connection begins; what came over another says nothing about it.
    pub(super) fn begin(&mut self) {
        for interval in &mut self.0 {
            interval.last = None;
        }
    }

    /// A report has come, and was not there before. How long after the last one, if that is too long.
    pub(super) fn came(&mut self, code: u16, now: Instant) -> Option<Duration> {
        let interval = self.0.iter_mut().find(|interval| interval.code == code)?;
        let last = interval.last.replace(now)?;
        Some(now.saturating_duration_since(last)).filter(|since| *since > interval.at_most)
    }
}
