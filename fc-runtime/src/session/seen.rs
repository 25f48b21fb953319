//! Recently delivered reports, to detect repetitions.

use crate::frame::FrameId;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// The last delivered reports, bounded in number.
///
/// A report with the same id *and* the same data is the same report at any time, because an app that was suspended
/// finds old repetitions in its socket. A report with only the same id is the same report if it comes soon and over the
/// same connection. Otherwise it is another report, because a restarted peer may reuse its ids.
#[derive(Debug)]
pub(super) struct Seen {
    /// Oldest first.
    window: VecDeque<Entry>,
    /// Ids of the entries in a separate list. Nearly every report is new, and a scan of this list shows that quickly.
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
    /// Last arrival.
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

    /// Returns `true` if this report has been delivered before, and updates its last arrival.
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
