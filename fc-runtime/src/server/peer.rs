//! The state of a command connection that driver, handlers and pushes share.

use super::allow::Effects;
use super::budget::{ConnectionMemory, MemoryHolder, NO_MEMORY};
use super::config::Settings;
use super::connection_id::ConnectionId;
use super::counters::Counters;
use super::detached::DetachedHandlers;
use super::output::Output;
use super::push::{AckOutcome, Queued};
use crate::protocol::Protocol;
use crate::session::{Session, SessionRules};
use crate::sync::{lock, register};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};
use std::task::{Poll, Waker};
use tokio::sync::Notify;

/// The state that pushes and the driver share.
pub(super) struct PeerState {
    /// Reports in flight.
    pub(super) session: Session<Queued>,
    /// Reports not yet sent, oldest first.
    pub(super) queue: VecDeque<Queued>,
    /// Waker of the driver while it waits.
    pub(super) driver: Option<Waker>,
}

pub(super) struct Peer<P: Protocol> {
    pub(super) id: ConnectionId,
    pub(super) address: SocketAddr,
    /// Effects that the app's address may call.
    pub(super) effects: Effects,
    pub(super) settings: Arc<Settings>,
    pub(super) counters: Arc<Counters>,
    pub(super) detached: Arc<DetachedHandlers>,
    pub(super) memory: ConnectionMemory,
    output: Mutex<Output<P>>,
    state: Mutex<PeerState>,
    unsent: AtomicUsize,
    unusable: AtomicU32,
    draining: AtomicBool,
    /// `true` if data has been received.
    heard: AtomicBool,
    /// Reason if the connection must end at once.
    evicted: OnceLock<&'static str>,
    /// `true` if unused memory must be released.
    untidy: AtomicBool,
    /// `true` if nothing can be sent any more. Set under the lock.
    gone: AtomicBool,
    going: Notify,
}

impl<P: Protocol> Peer<P> {
    pub(super) fn new(
        id: ConnectionId,
        address: SocketAddr,
        effects: Effects,
        settings: Arc<Settings>,
        counters: Arc<Counters>,
        detached: Arc<DetachedHandlers>,
        memory: ConnectionMemory,
    ) -> Self {
        let session = Session::new(
            SessionRules::of::<P>(),
            &settings.limits,
            P::DEFAULTS.ack,
            settings.connection.first_id(),
        );
        Self {
            id,
            address,
            effects,
            memory,
            output: Mutex::new(Output::new(settings.encoder())),
            state: Mutex::new(PeerState {
                session,
                queue: VecDeque::new(),
                driver: None,
            }),
            unsent: AtomicUsize::new(0),
            unusable: AtomicU32::new(0),
            draining: AtomicBool::new(false),
            heard: AtomicBool::new(false),
            evicted: OnceLock::new(),
            untidy: AtomicBool::new(false),
            gone: AtomicBool::new(false),
            going: Notify::new(),
            settings,
            counters,
            detached,
        }
    }

    /// Returns the unsent bytes as of the last response.
    pub(super) fn unsent(&self) -> usize {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Updates the number of unsent bytes.
    pub(super) fn note(&self, output: &Output<P>) {
        self.unsent.store(output.out.len(), Ordering::Relaxed);
    }

    /// Counts an unusable frame.
    pub(super) fn unusable(&self) {
        self.unusable.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the number of unusable frames since the last call.
    pub(super) fn take_unusable(&self) -> u32 {
        // Usually there are none, and a load is cheaper than a swap.
        match self.unusable.load(Ordering::Relaxed) {
            0 => 0,
            _ => self.unusable.swap(0, Ordering::Relaxed),
        }
    }

    /// Returns `true` if no more requests are read. Running ones are still answered.
    pub(super) fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Acquire)
    }

    /// Ends the connection when everything is answered.
    pub(super) fn drain(&self) {
        self.draining.store(true, Ordering::Release);
        self.wake();
    }

    /// Notes that data has been received.
    pub(super) fn hear(&self) {
        self.heard.store(true, Ordering::Relaxed);
    }

    /// Returns `true` if data has been received.
    pub(super) fn is_heard(&self) -> bool {
        self.heard.load(Ordering::Relaxed)
    }

    /// Returns the reason if the connection must end at once.
    pub(super) fn evicted(&self) -> Option<&'static str> {
        self.evicted.get().copied()
    }

    /// Ends the connection at once. The first reason is kept.
    pub(super) fn give_way(&self, reason: &'static str) {
        let _ = self.evicted.set(reason);
        self.wake();
    }

    /// Returns `true` if unused memory must be released, once per request.
    pub(super) fn take_untidy(&self) -> bool {
        self.untidy.load(Ordering::Relaxed) && self.untidy.swap(false, Ordering::Relaxed)
    }

    /// Resolves when the connection must end before its first frame, because it was replaced or the server ends.
    pub(super) async fn sent_away(&self) {
        poll_fn(|cx| {
            let mut state = self.lock();
            // Check under the lock, because the wake-up follows the change.
            if self.evicted().is_some() || self.is_draining() {
                return Poll::Ready(());
            }
            register(&mut state.driver, cx);
            Poll::Pending
        })
        .await;
    }

    /// Queues a report. If the queue is full or memory is short, the oldest reports are dropped. If reports in flight
    /// take all the room, the new one is dropped.
    pub(super) fn push(&self, mut report: Queued) {
        let (driver, dropped) = {
            let mut state = self.lock();
            if self.is_gone() {
                // A handler may keep this object. No report must wait in it.
                drop(state);
                return;
            }
            let mut dropped = Vec::new();
            loop {
                if state.queue.len() < self.settings.limits.queued_reports
                    && self.charge(&mut report)
                {
                    state.queue.push_back(report);
                    break;
                }
                let Some(mut oldest) = state.queue.pop_front() else {
                    dropped.push(report);
                    break;
                };
                oldest.charge = None;
                dropped.push(oldest);
            }
            (state.driver.take(), dropped)
        };
        for dropped in dropped {
            self.counters.reports_dropped.increment();
            if let Some(held) = self.counters.limiters.dropped.admit() {
                let (protocol, connection, code) = (P::NAME, self.id.0, dropped.code);
                let (peer, held) = (self.address, held.shown());
                tracing::warn!(protocol, connection, %peer, code, held, "report dropped: the app is slow");
            }
            dropped.end(AckOutcome::Dropped);
        }
        if let Some(driver) = driver {
            driver.wake();
        }
    }

    /// Charges a report to the connection, if there is memory for it.
    fn charge(&self, report: &mut Queued) -> bool {
        let bytes = report.body.len();
        if self.memory.queued().saturating_add(bytes) <= self.settings.queued_bytes {
            report.charge = self.memory.try_queue(bytes);
        }
        report.charge.is_some()
    }

    /// Ends all reports at the end of the connection, and releases its memory.
    pub(super) fn end(&self) {
        let (queue, in_flight) = {
            let mut state = self.lock();
            self.gone.store(true, Ordering::Release);
            let in_flight = state.session.end_if(|_, _| true);
            (std::mem::take(&mut state.queue), in_flight)
        };
        *self.output() = Output::new(self.settings.encoder());
        // Dropped outside the lock, because each one wakes its waiter.
        drop((queue, in_flight));
        self.going.notify_waiters();
    }

    /// Returns `true` if the connection has ended.
    pub(super) fn is_gone(&self) -> bool {
        self.gone.load(Ordering::Acquire)
    }

    /// Resolves when the connection has ended.
    pub(super) async fn gone(&self) {
        let mut going = pin!(self.going.notified());
        // Register first, so that an end between the check and the wait is not missed.
        going.as_mut().enable();
        if !self.is_gone() {
            going.await;
        }
    }

    /// Every holder leaves a consistent state, even after a panic: the encoder removes an unfinished frame.
    pub(super) fn output(&self) -> MutexGuard<'_, Output<P>> {
        lock(&self.output)
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, PeerState> {
        lock(&self.state)
    }

    /// Wakes the driver.
    pub(super) fn wake(&self) {
        let driver = self.lock().driver.take();
        if let Some(driver) = driver {
            driver.wake();
        }
    }
}

impl<P: Protocol> MemoryHolder for Peer<P> {
    fn tidy(&self) {
        self.untidy.store(true, Ordering::Relaxed);
        self.wake();
    }

    fn evict(&self, held: usize) {
        self.counters
            .evicted::<P>(self.id, self.address, "command", held);
        self.give_way(NO_MEMORY);
    }
}
