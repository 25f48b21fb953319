//! Puts the segments of each flow in order.

use super::packet::{Ports, Segment};
use super::{Event, Flow, Receiver};
use std::collections::{HashMap, VecDeque};
use std::io;
use std::time::Duration;

/// Flows that are followed at the same time.
const FLOWS: usize = 2048;

/// Bytes of a flow that wait for earlier ones. A longer wait means that the earlier ones are missing.
const WAITING: usize = 1 << 20;

/// Segments of a flow that wait for earlier ones.
const SEGMENTS: usize = 1024;

/// Waiting bytes of all flows.
const ALL_WAITING: usize = 32 << 20;

/// The TCP segments of a capture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Segments of connections with a wanted port.
    pub wanted: u64,
    /// Segments of other connections.
    pub others: u64,
}

/// The flows of a capture that have one of the wanted ports.
#[derive(Debug)]
pub(super) struct Flows<'p> {
    ports: &'p Ports,
    /// The numbers of segments so far. The wanted ones are the clock.
    seen: Seen,
    states: HashMap<Flow, State>,
    /// The number of waiting bytes of all flows.
    waiting: usize,
}

#[derive(Debug, Default)]
struct State {
    /// The sequence number of the next byte.
    next: u32,
    /// Later segments, in the order of their sequence numbers.
    later: VecDeque<Later>,
    waiting: usize,
    /// The sequence number of the end of the flow.
    end: Option<u32>,
    is_closed: bool,
    /// The time of the last segment.
    used: u64,
}

#[derive(Debug)]
struct Later {
    sequence: u32,
    time: Duration,
    bytes: Vec<u8>,
}

impl State {
    /// Takes the bytes at a sequence number that follow those before, without those that came already. Returns
    /// `None` if earlier ones are missing.
    fn fresh<'b>(&mut self, sequence: u32, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let ahead = distance(self.next, sequence);
        if ahead > 0 {
            return None;
        }
        let old = usize::try_from(ahead.unsigned_abs()).unwrap_or(usize::MAX);
        let fresh = bytes.get(old..).unwrap_or_default();
        self.next = self.next.wrapping_add(count(fresh));
        Some(fresh)
    }
}

/// Returns the sequence numbers that bytes take.
fn count(bytes: &[u8]) -> u32 {
    // A packet has at most 65,535 bytes.
    u32::try_from(bytes.len()).unwrap_or(u32::MAX)
}

/// Returns the distance from one sequence number to another, which can be smaller.
fn distance(from: u32, to: u32) -> i32 {
    to.wrapping_sub(from).cast_signed()
}

impl<'p> Flows<'p> {
    pub(super) fn new(ports: &'p Ports) -> Self {
        Self {
            ports,
            seen: Seen::default(),
            states: HashMap::new(),
            waiting: 0,
        }
    }

    /// Counts a segment. With a wanted port, adds it and passes on the bytes that are in order.
    pub(super) fn add(
        &mut self,
        segment: &Segment<'_>,
        time: Duration,
        receiver: &mut Receiver<'_>,
    ) -> io::Result<()> {
        if !self.ports.include(segment.flow) {
            self.seen.others += 1;
            return Ok(());
        }
        self.seen.wanted += 1;
        if let Some(acknowledged) = segment.acknowledged {
            self.acknowledge(segment.flow.reversed(), acknowledged, receiver)?;
        }
        let first = segment.sequence.wrapping_add(u32::from(segment.syn));
        if segment.syn {
            // A repeated SYN has the number of the first one.
            let is_new = |state: &State| state.is_closed || state.next != first;
            if self.states.get(&segment.flow).is_some_and(is_new) {
                self.close(segment.flow, receiver)?;
            }
        }
        let is_known = self.states.contains_key(&segment.flow);
        if !is_known && segment.payload.is_empty() && !segment.syn {
            return Ok(());
        }
        if !is_known {
            self.make_room(receiver)?;
        }
        let state = self.states.entry(segment.flow);
        let state = state.or_insert_with(|| State {
            next: first,
            ..State::default()
        });
        state.used = self.seen.wanted;
        if segment.fin {
            state.end = Some(first.wrapping_add(count(segment.payload)));
        }
        match state.fresh(first, segment.payload) {
            Some([]) => {}
            Some(bytes) => receiver(segment.flow, Event::Bytes(time, bytes))?,
            None => self.keep(segment.flow, first, time, segment.payload),
        }
        self.deliver(segment.flow, receiver)?;
        if segment.rst {
            self.close(segment.flow, receiver)?;
            self.close(segment.flow.reversed(), receiver)?;
        }
        Ok(())
    }

    /// Passes on all waiting bytes and ends all flows. Returns the numbers of segments.
    pub(super) fn finish(&mut self, receiver: &mut Receiver<'_>) -> io::Result<Seen> {
        let mut flows: Vec<_> = self.states.keys().copied().collect();
        flows.sort_unstable();
        for flow in flows {
            self.close(flow, receiver)?;
        }
        Ok(self.seen)
    }

    /// Keeps the bytes of a later segment.
    fn keep(&mut self, flow: Flow, sequence: u32, time: Duration, bytes: &[u8]) {
        let Some(state) = self.states.get_mut(&flow) else {
            return;
        };
        let next = state.next;
        let place = state
            .later
            .partition_point(|later| distance(next, later.sequence) <= distance(next, sequence));
        let later = Later {
            sequence,
            time,
            bytes: bytes.to_vec(),
        };
        state.waiting += bytes.len();
        self.waiting += bytes.len();
        state.later.insert(place, later);
    }

    /// Passes on waiting bytes that are in order now, and gives up waiting beyond the limits.
    fn deliver(&mut self, flow: Flow, receiver: &mut Receiver<'_>) -> io::Result<()> {
        self.pass(flow, receiver, |state, first, waiting| {
            distance(state.next, first.sequence) <= 0
                || state.waiting > WAITING
                || state.later.len() > SEGMENTS
                || waiting > ALL_WAITING
        })?;
        if let Some(state) = self.states.get_mut(&flow)
            && state.later.is_empty()
            && state.end == Some(state.next)
            && !state.is_closed
        {
            state.is_closed = true;
            receiver(flow, Event::End)?;
        }
        Ok(())
    }

    /// Passes on the first waiting segments while they are wanted, which the number of waiting bytes of all flows may
    /// decide. The capture lacks the bytes before them.
    fn pass(
        &mut self,
        flow: Flow,
        receiver: &mut Receiver<'_>,
        is_wanted: impl Fn(&State, &Later, usize) -> bool,
    ) -> io::Result<()> {
        while let Some(state) = self.states.get_mut(&flow)
            && let Some(first) = state.later.front()
            && is_wanted(state, first, self.waiting)
            && let Some(later) = state.later.pop_front()
        {
            let ahead = distance(state.next, later.sequence);
            if ahead > 0 {
                state.next = later.sequence;
                receiver(flow, Event::Missing(u64::from(ahead.unsigned_abs())))?;
            }
            state.waiting -= later.bytes.len();
            self.waiting -= later.bytes.len();
            match state.fresh(later.sequence, &later.bytes) {
                None | Some([]) => {}
                Some(bytes) => receiver(flow, Event::Bytes(later.time, bytes))?,
            }
        }
        Ok(())
    }

    /// Gives up waiting for bytes that the peer has acknowledged: the capture lacks them.
    fn acknowledge(
        &mut self,
        flow: Flow,
        acknowledged: u32,
        receiver: &mut Receiver<'_>,
    ) -> io::Result<()> {
        self.pass(flow, receiver, |_, first, _| {
            distance(first.sequence, acknowledged) > 0
        })
    }

    /// Passes on all waiting bytes of a flow and ends it.
    fn close(&mut self, flow: Flow, receiver: &mut Receiver<'_>) -> io::Result<()> {
        self.pass(flow, receiver, |_, _, _| true)?;
        match self.states.remove(&flow) {
            Some(state) if !state.is_closed => receiver(flow, Event::End),
            _ => Ok(()),
        }
    }

    /// Ends the flow that was unused for the longest time if there are too many.
    fn make_room(&mut self, receiver: &mut Receiver<'_>) -> io::Result<()> {
        if self.states.len() < FLOWS {
            return Ok(());
        }
        let oldest = self.states.iter().min_by_key(|(_, state)| state.used);
        match oldest.map(|(flow, _)| *flow) {
            Some(flow) => self.close(flow, receiver),
            None => Ok(()),
        }
    }
}
