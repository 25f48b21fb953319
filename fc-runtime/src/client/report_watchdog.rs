//! Detection of late periodic reports.

use crate::preconditions::Cadence;
use crate::protocol::Protocol;
use std::time::{Duration, Instant};

/// The intervals of the spec, and the last arrival of each periodic report. Other reports are not included.
#[derive(Debug)]
pub(super) struct ReportWatchdog(Vec<ReportInterval>);

#[derive(Debug)]
struct ReportInterval {
    code: u16,
    /// Longest time between two reports, with a margin for networks and robots.
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

    /// Starts a connection. Arrivals on earlier ones do not count.
    pub(super) fn restart(&mut self) {
        for interval in &mut self.0 {
            interval.last = None;
        }
    }

    /// Notes a new report. Returns the time since the last one if that is too long.
    pub(super) fn received(&mut self, code: u16, now: Instant) -> Option<Duration> {
        let interval = self.0.iter_mut().find(|interval| interval.code == code)?;
        let last = interval.last.replace(now)?;
        Some(now.saturating_duration_since(last)).filter(|since| *since > interval.at_most)
    }
}
