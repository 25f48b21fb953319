//! The memory that apps may make a server hold, for both ports together, and the choice of a connection to be closed.
//!
//! For each connection, the budget counts the memory that closing it would free: received and unsent bytes, waiting
//! requests, queued reports. Memory that has left its connection but is still in use is charged to the server only. No
//! memory is granted beyond the limit: the connection waits, and the one with the most memory is closed.

use super::connection_id::ConnectionId;
use crate::sync::lock;
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::task::{Context, Poll, Waker};

/// The reason of a connection closed for its memory, for the log.
pub(super) const NO_MEMORY: &str = "memory is short, and it held most";

/// Memory below which a connection is not closed, in bytes. Any connection needs this much.
const NEEDED: usize = 128 * 1024;

/// An owner of memory that can release it. It is called without a lock of the budget.
pub(super) trait MemoryHolder: Send + Sync {
    /// Releases unused memory.
    fn tidy(&self);

    /// Ends the connection at once. It holds this many bytes, and memory is short.
    fn evict(&self, held: usize);
}

/// The memory budget of all connections of a server.
#[derive(Clone)]
pub(super) struct MemoryBudget(Arc<Shared>);

struct Shared {
    limit: usize,
    held: AtomicUsize,
    /// Held memory that closing a connection does not free.
    lent: AtomicUsize,
    /// `true` if a task waits for memory.
    short: AtomicBool,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    connections: HashMap<ConnectionId, Entry>,
    waiting: Vec<Waker>,
}

struct Entry {
    usage: Arc<Usage>,
    holder: Weak<dyn MemoryHolder>,
    leaving: bool,
}

/// The memory that closing a connection frees, in bytes.
#[derive(Default)]
struct Usage {
    busy: AtomicUsize,
    /// Memory kept for the next frames.
    idle: AtomicUsize,
    queued: AtomicUsize,
}

impl Usage {
    /// Returns the memory in use.
    fn needed(&self) -> usize {
        self.busy.load(Ordering::Relaxed) + self.queued.load(Ordering::Relaxed)
    }
}

impl MemoryBudget {
    pub(super) fn new(limit: usize) -> Self {
        Self(Arc::new(Shared {
            limit,
            held: AtomicUsize::new(0),
            lent: AtomicUsize::new(0),
            short: AtomicBool::new(false),
            state: Mutex::default(),
        }))
    }

    /// Returns the held memory in bytes.
    pub(super) fn held(&self) -> usize {
        self.0.held.load(Ordering::Relaxed)
    }

    /// Registers a connection until the returned value is dropped.
    pub(super) fn open(
        &self,
        id: ConnectionId,
        holder: Weak<dyn MemoryHolder>,
    ) -> ConnectionMemory {
        let usage = Arc::<Usage>::default();
        let entry = Entry {
            usage: Arc::clone(&usage),
            holder,
            leaving: false,
        };
        self.0.lock().connections.insert(id, entry);
        ConnectionMemory {
            id,
            usage,
            shared: Arc::clone(&self.0),
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Takes memory if it is available.
    fn take(&self, bytes: usize) -> bool {
        let more = |held: usize| held.checked_add(bytes).filter(|held| *held <= self.limit);
        self.held
            .fetch_update(Ordering::SeqCst, Ordering::SeqCst, more)
            .is_ok()
    }

    fn give(&self, bytes: usize) {
        if bytes == 0 {
            return;
        }
        self.held.fetch_sub(bytes, Ordering::SeqCst);
        if self.short.swap(false, Ordering::SeqCst) {
            let waiting = std::mem::take(&mut self.lock().waiting);
            waiting.into_iter().for_each(Waker::wake);
        }
    }

    /// Takes memory, or wakes the task of `cx` when some is freed.
    fn poll_take(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        self.poll_once(cx, || self.take(bytes))
    }

    /// Ready when `done` returns `true`. It is called again after each release of memory.
    fn poll_once(&self, cx: &mut Context<'_>, done: impl Fn() -> bool) -> Poll<()> {
        if done() {
            return Poll::Ready(());
        }
        {
            let mut state = self.lock();
            let waits = |waker: &Waker| waker.will_wake(cx.waker());
            if !state.waiting.iter().any(waits) {
                state.waiting.push(cx.waker().clone());
            }
            self.short.store(true, Ordering::SeqCst);
        }
        // Memory freed before this point has not woken this task.
        if done() {
            Poll::Ready(())
        } else {
            Poll::Pending
        }
    }

    /// Lends held memory if at most half of the limit is lent then, or if nothing else is lent.
    fn lend(&self, bytes: usize) -> bool {
        let more = |lent: usize| {
            let after = lent.saturating_add(bytes);
            (lent == 0 || after <= self.limit / 2).then_some(after)
        };
        self.lent
            .fetch_update(Ordering::SeqCst, Ordering::SeqCst, more)
            .is_ok()
    }

    /// Takes memory, or makes room for it.
    fn poll_demand(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        let taken = self.poll_take(cx, bytes);
        if taken.is_pending() {
            self.make_room(bytes);
        }
        taken
    }

    /// Frees memory until `bytes` more fit: first unused memory, then connections with the most memory.
    fn make_room(&self, bytes: usize) {
        let mut tidy = Vec::new();
        let mut evict = Vec::new();
        {
            let mut state = self.lock();
            let mut coming = 0;
            for entry in state.connections.values() {
                let idle = entry.usage.idle.load(Ordering::Relaxed);
                coming += idle;
                if entry.leaving {
                    coming += entry.usage.needed();
                } else if idle > 0 {
                    tidy.push(entry.holder.clone());
                }
            }
            let wanted =
                (self.held.load(Ordering::SeqCst).saturating_add(bytes)).saturating_sub(self.limit);
            while coming < wanted {
                let staying = state
                    .connections
                    .values_mut()
                    .filter(|entry| !entry.leaving);
                let Some(greatest) = staying.max_by_key(|entry| entry.usage.needed()) else {
                    break;
                };
                let held = greatest.usage.needed();
                if held < NEEDED {
                    // The rest is held by handlers, which will end.
                    break;
                }
                greatest.leaving = true;
                coming += held;
                evict.push((greatest.holder.clone(), held));
            }
        }
        for holder in tidy.iter().filter_map(Weak::upgrade) {
            holder.tidy();
        }
        for (holder, held) in evict {
            if let Some(holder) = holder.upgrade() {
                holder.evict(held);
            }
        }
    }
}

/// The memory of one connection.
pub(super) struct ConnectionMemory {
    id: ConnectionId,
    usage: Arc<Usage>,
    shared: Arc<Shared>,
}

impl ConnectionMemory {
    /// Requests memory for the connection. Until it is available, the connection with the most memory is closed, which
    /// may be this one.
    pub(super) fn poll_grow(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        let taken = self.shared.poll_demand(cx, bytes);
        if taken.is_ready() {
            self.usage.busy.fetch_add(bytes, Ordering::Relaxed);
        }
        taken
    }

    /// Requests memory that is released soon.
    pub(super) fn poll_lend(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<Charge> {
        let taken = self.shared.poll_demand(cx, bytes);
        taken.map(|()| {
            self.shared.lent.fetch_add(bytes, Ordering::SeqCst);
            self.charge(None, bytes)
        })
    }

    /// Sets the memory in use and the memory kept for the next frames, besides queued memory.
    pub(super) fn update(&self, busy: usize, idle: usize) {
        let before =
            self.usage.busy.load(Ordering::Relaxed) + self.usage.idle.load(Ordering::Relaxed);
        let after = busy + idle;
        self.usage.busy.store(busy, Ordering::Relaxed);
        self.usage.idle.store(idle, Ordering::Relaxed);
        if after > before {
            self.add(after - before);
        } else {
            self.shared.give(before - after);
        }
    }

    /// Charges queued data if there is memory for it. Closes no connection.
    pub(super) fn try_queue(&self, bytes: usize) -> Option<Charge> {
        let taken = self.shared.take(bytes);
        taken.then(|| self.queued_charge(bytes))
    }

    /// Charges queued data when there is memory for it.
    pub(super) fn poll_queue(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<Charge> {
        let taken = self.shared.poll_take(cx, bytes);
        taken.map(|()| self.queued_charge(bytes))
    }

    fn queued_charge(&self, bytes: usize) -> Charge {
        self.usage.queued.fetch_add(bytes, Ordering::Relaxed);
        self.charge(Some(Arc::clone(&self.usage)), bytes)
    }

    fn charge(&self, usage: Option<Arc<Usage>>, bytes: usize) -> Charge {
        Charge {
            shared: Arc::clone(&self.shared),
            usage,
            bytes,
        }
    }

    /// Returns the queued memory in bytes.
    pub(super) fn queued(&self) -> usize {
        self.usage.queued.load(Ordering::Relaxed)
    }

    /// Charges existing data to the connection.
    pub(super) fn queue_existing(&self, bytes: usize) -> Charge {
        self.add(bytes);
        self.queued_charge(bytes)
    }

    /// Charges existing data that outlives the connection.
    pub(super) fn lend_existing(&self, bytes: usize) -> Charge {
        self.add(bytes);
        self.shared.lent.fetch_add(bytes, Ordering::SeqCst);
        self.charge(None, bytes)
    }

    /// Counts existing data even beyond the limit.
    fn add(&self, bytes: usize) {
        let held = self.shared.held.fetch_add(bytes, Ordering::SeqCst) + bytes;
        if held > self.shared.limit {
            self.shared.make_room(0);
        }
    }

    /// Removes the connection.
    pub(super) fn close(&self) {
        self.shared.lock().connections.remove(&self.id);
        self.update(0, 0);
    }
}

impl Drop for ConnectionMemory {
    fn drop(&mut self) {
        self.close();
    }
}

impl fmt::Debug for ConnectionMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ConnectionMemory({})", self.id)
    }
}

/// Charged memory, released on drop.
pub(super) struct Charge {
    shared: Arc<Shared>,
    /// Usage of the connection that it is queued at.
    usage: Option<Arc<Usage>>,
    bytes: usize,
}

impl fmt::Debug for Charge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Charge({} bytes)", self.bytes)
    }
}

impl Charge {
    /// Moves the charge from its connection to the server. Ready when not too much is lent already.
    pub(super) fn poll_hand_over(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        if self.usage.is_none() {
            return Poll::Ready(());
        }
        let handed = self.shared.poll_once(cx, || self.shared.lend(self.bytes));
        if handed.is_ready()
            && let Some(usage) = self.usage.take()
        {
            usage.queued.fetch_sub(self.bytes, Ordering::Relaxed);
        }
        handed
    }
}

impl Drop for Charge {
    fn drop(&mut self) {
        match &self.usage {
            Some(usage) => usage.queued.fetch_sub(self.bytes, Ordering::Relaxed),
            None => self.shared.lent.fetch_sub(self.bytes, Ordering::SeqCst),
        };
        self.shared.give(self.bytes);
    }
}
