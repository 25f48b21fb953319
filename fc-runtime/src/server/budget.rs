//! What apps may make a server hold in memory, those of both ports together, and who goes when that
//! does not suffice.
//!
//! Each connection has an account of what its end would give back: what has come and what is to be
//! sent, requests that wait for their handlers, reports that wait for the app. What has left its
//! connection and is still in somebody's hands is charged to the server alone. Nobody gets
//! memory beyond the limit: he waits until there is some, and the connection that holds most is
//! closed.

use super::connection_id::ConnectionId;
use crate::sync::lock;
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::task::{Context, Poll, Waker};

/// Why a connection has ended whose memory was needed, for the log.
pub(super) const NO_MEMORY: &str = "memory is short, and it held most";

/// Who holds less than this is not closed, in bytes: that is what any connection needs.
const NEEDED: usize = 128 * 1024;

/// One that can be told to give memory back. Called under no lock of the budget.
pub(super) trait MemoryHolder: Send + Sync {
    /// Give back what is not needed at this moment.
    fn tidy(&self);

    /// End the connection at once: it holds so many bytes, and memory is short.
    fn evict(&self, held: usize);
}

/// What all connections of a server share.
#[derive(Clone)]
pub(super) struct MemoryBudget(Arc<Shared>);

struct Shared {
    limit: usize,
    held: AtomicUsize,
    /// What the end of no connection gives back, of what is held.
    lent: AtomicUsize,
    /// Somebody waits for memory.
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

/// What the end of a connection gives back, in bytes.
#[derive(Default)]
struct Usage {
    busy: AtomicUsize,
    /// Memory that is kept for what comes next.
    idle: AtomicUsize,
    queued: AtomicUsize,
}

impl Usage {
    /// What it needs at this moment.
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

    /// How much is held at this moment, in bytes.
    pub(super) fn held(&self) -> usize {
        self.0.held.load(Ordering::Relaxed)
    }

    /// The account of a new connection; it is closed when it is dropped.
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

    /// Takes so many bytes if they are there.
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

    /// Takes so many bytes, or lets `cx` hear when some are given back.
    fn poll_take(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        self.poll_once(cx, || self.take(bytes))
    }

    /// Ready once `done`, which is asked again whenever something is given back.
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
        // What was given back before that has woken nobody.
        if done() {
            Poll::Ready(())
        } else {
            Poll::Pending
        }
    }

    /// Lends so many bytes of what is held, if no more than half of all is lent then, or nothing else
    /// is.
    fn lend(&self, bytes: usize) -> bool {
        let more = |lent: usize| {
            let after = lent.saturating_add(bytes);
            (lent == 0 || after <= self.limit / 2).then_some(after)
        };
        self.lent
            .fetch_update(Ordering::SeqCst, Ordering::SeqCst, more)
            .is_ok()
    }

    /// Takes so many bytes, or sees to it that they are given back.
    fn poll_demand(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        let taken = self.poll_take(cx, bytes);
        if taken.is_pending() {
            self.make_room(bytes);
        }
        taken
    }

    /// Has memory given back until so many bytes more fit: first what nobody needs, then by those
    /// who hold most.
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
                    // What is missing is in the hands of handlers; they end by themselves.
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

/// What is held for one connection.
pub(super) struct ConnectionMemory {
    id: ConnectionId,
    usage: Arc<Usage>,
    shared: Arc<Shared>,
}

impl ConnectionMemory {
    /// Asks for memory that the connection is to hold from now on. Until it is there, the one that
    /// holds most is told to go, and that may be the one that asks.
    pub(super) fn poll_more(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<()> {
        let taken = self.shared.poll_demand(cx, bytes);
        if taken.is_ready() {
            self.usage.busy.fetch_add(bytes, Ordering::Relaxed);
        }
        taken
    }

    /// The same for memory that is given back at once.
    pub(super) fn poll_lend(&self, cx: &mut Context<'_>, bytes: usize) -> Poll<Charge> {
        let taken = self.shared.poll_demand(cx, bytes);
        taken.map(|()| {
            self.shared.lent.fetch_add(bytes, Ordering::SeqCst);
            self.charge(None, bytes)
        })
    }

    /// Says how much the connection holds, beside what is queued: what it needs, and what it keeps
    /// for what comes next.
    pub(super) fn hold(&self, busy: usize, idle: usize) {
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

    /// Charges what waits to be sent, if there is memory for it; nobody has to go for it.
    pub(super) fn queue(&self, bytes: usize) -> Option<Charge> {
        let taken = self.shared.take(bytes);
        taken.then(|| self.queued_charge(bytes))
    }

    /// The same, as soon as there is memory for it.
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

    /// How much is queued, in bytes.
    pub(super) fn queued(&self) -> usize {
        self.usage.queued.load(Ordering::Relaxed)
    }

    /// Charges what is there already, and goes with the connection.
    pub(super) fn keep(&self, bytes: usize) -> Charge {
        self.add(bytes);
        self.queued_charge(bytes)
    }

    /// Charges what is there already, and stays when the connection ends.
    pub(super) fn lend(&self, bytes: usize) -> Charge {
        self.add(bytes);
        self.shared.lent.fetch_add(bytes, Ordering::SeqCst);
        self.charge(None, bytes)
    }

    /// What is there already is counted even if it is too much.
    fn add(&self, bytes: usize) {
        let held = self.shared.held.fetch_add(bytes, Ordering::SeqCst) + bytes;
        if held > self.shared.limit {
            self.shared.make_room(0);
        }
    }

    /// The connection has ended.
    pub(super) fn close(&self) {
        self.shared.lock().connections.remove(&self.id);
        self.hold(0, 0);
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

/// Memory that is given back when this is dropped.
pub(super) struct Charge {
    shared: Arc<Shared>,
    /// Of the connection that it is queued at.
    usage: Option<Arc<Usage>>,
    bytes: usize,
}

impl fmt::Debug for Charge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Charge({} bytes)", self.bytes)
    }
}

impl Charge {
    /// Lets what is charged to a connection leave it: ready when not too much is out of
    /// reach already.
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
