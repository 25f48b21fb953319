//! Requests handed on not long ago, so that a repetition is not handed on again.

use crate::frame::FrameId;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// A window over the last requests handed on, bounded in number and in age.
///
/// The age matters: a peer that starts anew may use its ids again, and its new reports must not
/// pass for repetitions of old ones.
#[derive(Debug)]
pub(super) struct Seen {
    window: VecDeque<(FrameId, Instant)>,
    length: usize,
    age: Duration,
}

impl Seen {
    pub(super) fn new(length: usize, age: Duration) -> Self {
        Self {
            window: VecDeque::new(),
            length,
            age,
        }
    }

    pub(super) fn contains(&mut self, frame: FrameId, now: Instant) -> bool {
        while let Some((_, at)) = self.window.front()
            && now.saturating_duration_since(*at) > self.age
        {
            self.window.pop_front();
        }
        self.window.iter().any(|(seen, _)| *seen == frame)
    }

    pub(super) fn insert(&mut self, frame: FrameId, now: Instant) {
        if self.length == 0 {
            return;
        }
        if self.window.len() == self.length {
            self.window.pop_front();
        }
        self.window.push_back((frame, now));
    }
}
