//! Reports handed on not long ago, so that a repetition is not handed on again.

use crate::frame::FrameId;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// A window over the last reports handed on, bounded in number.
///
/// What has the same id *and* the same data is the same report, whenever it comes: an app that was
/// asleep finds repetitions of long ago in its socket. What has only the same id is the same report
/// if it comes soon and over the same connection; later, or over another one, it is another report:
/// a peer that restarts may use its ids again.
#[derive(Debug)]
pub(super) struct Seen {
    /// Oldest first.
    window: VecDeque<Entry>,
    /// Their ids side by side: nearly every report is new, and is seen to be so at a glance.
    ids: VecDeque<u32>,
    length: usize,
    age: Duration,
    connection: u64,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    frame: FrameId,
    digest: Option<[u8; 16]>,
    connection: u64,
    /// When it last came.
    at: Instant,
}

impl Seen {
    pub(super) fn new(length: usize, age: Duration) -> Self {
        Self {
            window: VecDeque::new(),
            ids: VecDeque::new(),
            length,
            age,
            connection: 0,
        }
    }

    pub(super) fn reconnected(&mut self) {
        self.connection += 1;
    }

    /// Whether this report has been handed on. If so, it may come again for as long as ever: its age
    /// counts from now.
    pub(super) fn contains(
        &mut self,
        frame: FrameId,
        digest: Option<[u8; 16]>,
        now: Instant,
    ) -> bool {
        if !self.ids.contains(&frame.id) {
            return false;
        }
        let same = |entry: &Entry| {
            entry.frame == frame
                && match (entry.digest, digest) {
                    (Some(before), Some(digest)) if before == digest => true,
                    (None, _) | (_, None) => self.is_recent(entry, now),
                    _ => entry.connection == self.connection && self.is_recent(entry, now),
                }
        };
        let Some(index) = self.window.iter().rposition(same) else {
            return false;
        };
        if let Some(entry) = self.window.remove(index) {
            self.ids.remove(index);
            self.push(Entry {
                connection: self.connection,
                at: now,
                ..entry
            });
        }
        true
    }

    fn push(&mut self, entry: Entry) {
        self.ids.push_back(entry.frame.id);
        self.window.push_back(entry);
        debug_assert_eq!(self.ids.len(), self.window.len());
    }

    fn is_recent(&self, entry: &Entry, now: Instant) -> bool {
        now.saturating_duration_since(entry.at) <= self.age
    }

    pub(super) fn insert(&mut self, frame: FrameId, digest: Option<[u8; 16]>, now: Instant) {
        if self.length == 0 {
            return;
        }
        if self.window.len() == self.length {
            self.window.pop_front();
            self.ids.pop_front();
        }
        self.push(Entry {
            frame,
            digest,
            connection: self.connection,
            at: now,
        });
    }
}
