//! Requests in flight: ids, deadlines, repetitions.

use super::deadline::after;
use crate::frame::FrameId;
use crate::operation::AckPolicy;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Instant;

/// Initial number of slots.
const FIRST_SLOTS: usize = 16;

/// A request in flight.
#[derive(Debug)]
struct Entry<T> {
    frame: FrameId,
    due: Instant,
    policy: AckPolicy,
    repetitions_left: u32,
    token: T,
}

/// Too many requests are in flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{limit} requests are in flight already; wait for one, or raise `in_flight`")]
pub struct Busy {
    /// The limit.
    pub limit: usize,
}

/// A request in flight whose deadline has passed.
#[derive(Debug, PartialEq, Eq)]
pub enum Due<'a, T> {
    /// Send it again with the same id.
    Again(FrameId, &'a mut T),
    /// It has ended without a response; no repetition is left.
    Expired(FrameId, T),
}

/// The table of requests in flight.
///
/// Ids count up, and the low bits of an id are its slot. So a lookup needs no hashing. An id whose slot is taken is
/// skipped, so that ids in flight are unique even after the counter has wrapped.
#[derive(Debug)]
pub(super) struct Outgoing<T> {
    slots: Vec<Option<Entry<T>>>,
    in_flight: usize,
    limit: usize,
    next_id: u32,
    /// Largest id; all bits of an id are set.
    id_max: u32,
    /// Deadlines of ids, earliest first. Some belong to requests that have ended.
    deadlines: BinaryHeap<Reverse<(Instant, u32)>>,
}

impl<T> Outgoing<T> {
    pub(super) fn new(limit: usize, first_id: u32, id_max: u32) -> Self {
        Self {
            slots: Vec::new(),
            in_flight: 0,
            limit,
            next_id: first_id & id_max,
            id_max,
            deadlines: BinaryHeap::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.in_flight
    }

    /// Returns a time before which no request is due.
    pub(super) fn earliest(&self) -> Option<Instant> {
        self.deadlines.peek().map(|Reverse((due, _))| *due)
    }

    fn add_deadline(&mut self, due: Instant, id: u32) {
        // Most requests end before their deadline. So outdated deadlines are removed when about as many have gathered
        // as there are requests.
        if self.deadlines.len() >= 2 * self.in_flight + FIRST_SLOTS {
            let mut deadlines = std::mem::take(&mut self.deadlines);
            deadlines.retain(|Reverse((due, id))| self.is_due_at(*id, *due));
            self.deadlines = deadlines;
        }
        self.deadlines.push(Reverse((due, id)));
    }

    /// Returns `true` if a request with this id is in flight and has this deadline.
    fn is_due_at(&self, id: u32, due: Instant) -> bool {
        let entry = self.slots.get(self.slot(id)).and_then(Option::as_ref);
        entry.is_some_and(|entry| entry.frame.id == id && entry.due == due)
    }

    fn slot(&self, id: u32) -> usize {
        usize::try_from(id).unwrap_or(0) & self.slots.len().wrapping_sub(1)
    }

    /// Grows the table so that at most half of the slots are taken and a free slot is near.
    fn grow(&mut self) {
        if (self.in_flight + 1) * 2 <= self.slots.len() {
            return;
        }
        let wanted = (self.slots.len() * 2).max(FIRST_SLOTS);
        let old = std::mem::take(&mut self.slots);
        self.slots.resize_with(wanted, || None);
        for entry in old.into_iter().flatten() {
            // Ids with different low bits still differ with one more bit.
            let slot = self.slot(entry.frame.id);
            if let Some(place) = self.slots.get_mut(slot) {
                *place = Some(entry);
            }
        }
    }

    pub(super) fn open(
        &mut self,
        kind: u8,
        code: u16,
        policy: AckPolicy,
        now: Instant,
        token: T,
    ) -> Result<FrameId, Busy> {
        if self.in_flight >= self.limit {
            return Err(Busy { limit: self.limit });
        }
        self.grow();
        loop {
            let id = self.next_id;
            self.next_id = id.wrapping_add(1) & self.id_max;
            let slot = self.slot(id);
            if let Some(place @ None) = self.slots.get_mut(slot) {
                let frame = FrameId {
                    response: false,
                    kind,
                    code,
                    id,
                };
                let due = after(now, policy.timeout);
                *place = Some(Entry {
                    frame,
                    due,
                    policy,
                    repetitions_left: policy.retries,
                    token,
                });
                self.in_flight += 1;
                self.add_deadline(due, id);
                return Ok(frame);
            }
        }
    }

    /// Ends the request with this kind, code and id.
    pub(super) fn end(&mut self, frame: FrameId) -> Option<T> {
        let slot = self.slot(frame.id);
        let place = self.slots.get_mut(slot)?;
        let same = |entry: &mut Entry<T>| {
            entry.frame.id == frame.id
                && entry.frame.kind == frame.kind
                && entry.frame.code == frame.code
        };
        let entry = place.take_if(same)?;
        self.in_flight -= 1;
        Some(entry.token)
    }

    pub(super) fn due(&mut self, now: Instant) -> Option<Due<'_, T>> {
        let id = loop {
            let Reverse((due, id)) = *self.deadlines.peek()?;
            if due > now {
                return None;
            }
            self.deadlines.pop();
            if self.is_due_at(id, due) {
                break id;
            }
        };
        let slot = self.slot(id);
        if let Some(entry) =
            (self.slots.get_mut(slot)?).take_if(|entry| entry.repetitions_left == 0)
        {
            self.in_flight -= 1;
            return Some(Due::Expired(entry.frame, entry.token));
        }
        let entry = self.slots.get_mut(slot)?.as_mut()?;
        entry.repetitions_left -= 1;
        entry.due = after(now, entry.policy.timeout);
        self.deadlines.push(Reverse((entry.due, id)));
        Some(Due::Again(entry.frame, &mut entry.token))
    }

    /// Ends every request for which `ends` returns `true`.
    pub(super) fn end_if(
        &mut self,
        mut ends: impl FnMut(FrameId, &mut T) -> bool,
    ) -> Vec<(FrameId, T)> {
        let ended: Vec<_> = self
            .slots
            .iter_mut()
            .filter_map(|place| place.take_if(|entry| ends(entry.frame, &mut entry.token)))
            .map(|entry| (entry.frame, entry.token))
            .collect();
        self.in_flight -= ended.len();
        ended
    }
}
