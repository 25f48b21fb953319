//! One app's connection, as far as driver, handlers and pushes share it.

use super::allow::Effects;
use super::budget::{ConnectionMemory, MemoryHolder, NO_MEMORY};
use super::config::Settings;
use super::connection_id::ConnectionId;
use super::counters::Counters;
use super::detached::DetachedHandlers;
use super::output::Output;
use super::push::{AckOutcome, Queued};
use crate::protocol::Protocol;
use crate::session::Session;
use crate::sync::{lock, register};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};
use std::task::{Poll, Waker};
use tokio::sync::Notify;

/// What pushers and the driver share.
pub(super) struct PeerState<P: Protocol> {
    /// Reports in flight.
    pub(super) session: Session<P, Queued>,
    /// Reports not yet sent, oldest first.
    pub(super) queue: VecDeque<Queued>,
    /// The driver's, while it waits for something to do.
    pub(super) driver: Option<Waker>,
}

pub(super) struct Peer<P: Protocol> {
    pub(super) id: ConnectionId,
    pub(super) address: SocketAddr,
    /// What may be called from there.
    pub(super) effects: Effects,
    pub(super) settings: Arc<Settings>,
    pub(super) counters: Arc<Counters>,
    pub(super) detached: Arc<DetachedHandlers>,
    pub(super) memory: ConnectionMemory,
    output: Mutex<Output<P>>,
    state: Mutex<PeerState<P>>,
    unsent: AtomicUsize,
    unusable: AtomicU32,
    draining: AtomicBool,
    /// Something has been received.
    heard: AtomicBool,
    /// It has given way, for this reason.
    evicted: OnceLock<&'static str>,
    /// What is not needed is to be given back.
    untidy: AtomicBool,
    /// Set under the lock: nothing can be sent any more.
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

    /// Bytes gathered to be sent, as of the last answer.
    pub(super) fn unsent(&self) -> usize {
        self.unsent.load(Ordering::Relaxed)
    }

    /// Notes how much `output` holds now.
    pub(super) fn note(&self, output: &Output<P>) {
        self.unsent.store(output.out.len(), Ordering::Relaxed);
    }

    /// Notes a frame that nobody can make use of.
    pub(super) fn unusable(&self) {
        self.unusable.fetch_add(1, Ordering::Relaxed);
    }

    /// How many of these there have been since this was last asked.
    pub(super) fn take_unusable(&self) -> u32 {
        // Mostly there are none, and looking is cheaper than taking.
        match self.unusable.load(Ordering::Relaxed) {
            0 => 0,
            _ => self.unusable.swap(0, Ordering::Relaxed),
        }
    }

    /// Whether no more requests are read, while those being handled are answered still.
    pub(super) fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Acquire)
    }

    /// Lets the connection end once everything is answered.
    pub(super) fn drain(&self) {
        self.draining.store(true, Ordering::Release);
        self.wake();
    }

    /// Notes that something has been received.
    pub(super) fn hear(&self) {
        self.heard.store(true, Ordering::Relaxed);
    }

    /// Whether anything has been received.
    pub(super) fn is_heard(&self) -> bool {
        self.heard.load(Ordering::Relaxed)
    }

    /// Why the connection has to go, if it has.
    pub(super) fn evicted(&self) -> Option<&'static str> {
        self.evicted.get().copied()
    }

    /// Lets the connection end at once. The first reason counts.
    pub(super) fn give_way(&self, reason: &'static str) {
        let _ = self.evicted.set(reason);
        self.wake();
    }

    /// Whether memory is to be given back that is not needed.
    pub(super) fn take_untidy(&self) -> bool {
        self.untidy.load(Ordering::Relaxed) && self.untidy.swap(false, Ordering::Relaxed)
    }

    /// Resolves once the connection has to go before it has come to its first frame: another has taken
    /// its place, or the server ends.
    pub(super) async fn sent_away(&self) {
        poll_fn(|cx| {
            let mut state = self.lock();
            // Under the lock: who sends it away wakes afterwards.
            if self.evicted().is_some() || self.is_draining() {
                return Poll::Ready(());
            }
            register(&mut state.driver, cx);
            Poll::Pending
        })
        .await;
    }

    /// Queues a report. If the queue is full or memory is short, the oldest reports in it give way;
    /// where all the room is taken by reports in flight, the new one is dropped.
    pub(super) fn push(&self, mut report: Queued) {
        let (driver, dropped) = {
            let mut state = self.lock();
            if self.is_gone() {
                // A handler may hold on to the connection; nothing may wait in it.
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
            self.counters.reports_dropped.one();
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

    /// Charges a report to the app, if there is room for it.
    fn charge(&self, report: &mut Queued) -> bool {
        let bytes = report.body.len();
        if self.memory.queued().saturating_add(bytes) <= self.settings.queued_bytes {
            report.charge = self.memory.queue(bytes);
        }
        report.charge.is_some()
    }

    /// Ends all reports, because the connection has ended, and keeps nothing for it.
    pub(super) fn end(&self) {
        let (queue, in_flight) = {
            let mut state = self.lock();
            self.gone.store(true, Ordering::Release);
            let in_flight = state.session.end_if(|_, _| true);
            (std::mem::take(&mut state.queue), in_flight)
        };
        *self.output() = Output::new(self.settings.encoder());
        // Dropped outside the lock: each wakes whoever waits for it.
        drop((queue, in_flight));
        self.going.notify_waiters();
    }

    /// Whether the connection has ended.
    pub(super) fn is_gone(&self) -> bool {
        self.gone.load(Ordering::Acquire)
    }

    /// Resolves once the connection has ended.
    pub(super) async fn gone(&self) {
        let mut going = pin!(self.going.notified());
        // From here on it is heard; what was before is seen.
        going.as_mut().enable();
        if !self.is_gone() {
            going.await;
        }
    }

    /// Nothing is left half done when the lock is given back, not even by a panic: the encoder takes
    /// back what it has begun. So poison means nothing.
    pub(super) fn output(&self) -> MutexGuard<'_, Output<P>> {
        lock(&self.output)
    }

    /// Poison means nothing here either.
    pub(super) fn lock(&self) -> MutexGuard<'_, PeerState<P>> {
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
