//! Whether a frame that has begun goes on.
//!
//! Not the rule of [`MinimumRate`](crate::rate::MinimumRate), which counts in windows. An app's danger is a wrong
//! length that swallows the answers while it keeps asking, and they may come at some KiB per second. In
//! windows, a rate above that would cost a good frame over a slow link its connection; counted over the
//! whole frame, with the stall timeout ahead, it does not.

use crate::session::after;
use std::time::{Duration, Instant};

/// What a frame has to bring beside the stall timeout, in bytes per second: a robot that claims a length
/// that is wrong swallows what follows, and that must not pass for progress.
const LEAST: u64 = 16 * 1024;

/// The watch over the frame that is arriving.
#[derive(Debug)]
pub(crate) struct FrameProgress {
    limit: Duration,
    /// When the frame began, and when bytes of it last came.
    since: Option<(Instant, Instant)>,
}

impl FrameProgress {
    pub(crate) fn new(limit: Duration) -> Self {
        Self { limit, since: None }
    }

    /// A frame is whole, or has been skipped.
    pub(crate) fn whole(&mut self) {
        self.since = None;
    }

    /// Bytes have come.
    pub(crate) fn came(&mut self, now: Instant) {
        if let Some((_, last)) = &mut self.since {
            *last = now;
        }
    }

    /// When a frame of which `received` bytes have come stalls; `None` in between frames.
    pub(crate) fn deadline(&mut self, received: usize, now: Instant) -> Option<Instant> {
        if received == 0 {
            self.since = None;
            return None;
        }
        let (begun, last) = *self.since.get_or_insert((now, now));
        let earned = Duration::from_millis((received as u64).saturating_mul(1000) / LEAST);
        let slow = after(begun, self.limit.saturating_add(earned));
        Some(after(last, self.limit).min(slow))
    }
}
