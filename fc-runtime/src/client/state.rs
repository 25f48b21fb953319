//! The state that the handles of a connection share with its driver.

use super::config::ClientConfig;
use super::error::CallError;
use super::loss::Loss;
use super::queues::Queues;
use super::report_watchdog::ReportWatchdog;
use super::socket::CallersSocket;
use super::state_watch::StateWatch;
use crate::frame::{Body, Encoder, FrameError, Staged};
use crate::log_limiter::LogLimiter;
use crate::metrics::{CLIENT, Counter, Gauge, Held, Operations};
use crate::protocol::Protocol;
use crate::session::{Session, SessionRules};
use crate::sync::lock;
use crate::wire::Limits;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};
use std::task::Waker;
use std::time::{Duration, Instant};

/// The progress of a call.
#[derive(Debug, Default)]
pub(super) enum Progress {
    /// Not sent. The caller encodes it when the connection is up.
    #[default]
    Unsent,
    /// Sent.
    Sent,
    /// Sent over a lost connection, and may be sent once more.
    Again,
    /// Ended. The caller has not fetched the result yet.
    Done(Result<Body, CallError>),
}

impl Progress {
    /// Returns `true` if the caller must encode the request.
    pub(super) fn is_to_send(&self) -> bool {
        matches!(self, Self::Unsent | Self::Again)
    }
}

/// The data shared by one caller and the driver.
#[derive(Debug, Default)]
pub(super) struct Slot {
    pub(super) progress: Progress,
    pub(super) waker: Option<Waker>,
    /// `true` if the call may be sent once more after a loss.
    pub(super) repeat: bool,
}

/// Reusable slots. A slot belongs to its caller until the caller frees it.
#[derive(Debug, Default)]
pub(super) struct Slots {
    slots: Vec<Slot>,
    free: Vec<usize>,
}

impl Slots {
    pub(super) fn take(&mut self) -> usize {
        self.free.pop().unwrap_or_else(|| {
            self.slots.push(Slot::default());
            self.slots.len() - 1
        })
    }

    pub(super) fn get(&mut self, slot: usize) -> Option<&mut Slot> {
        self.slots.get_mut(slot)
    }

    pub(super) fn is_unsent(&self, slot: usize) -> bool {
        let slot = self.slots.get(slot);
        slot.is_some_and(|slot| matches!(slot.progress, Progress::Unsent))
    }

    pub(super) fn free(&mut self, slot: usize) -> Progress {
        self.free.push(slot);
        self.get(slot)
            .map(std::mem::take)
            .unwrap_or_default()
            .progress
    }

    /// Returns the number of used slots, including those of ended calls whose result has not been fetched.
    pub(super) fn used(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    pub(super) fn iter_mut(&mut self) -> impl Iterator<Item = &mut Slot> {
        self.slots.iter_mut()
    }

    /// Ends the call in `slot` and returns its waker.
    pub(super) fn finish(&mut self, slot: usize, result: Result<Body, CallError>) -> Option<Waker> {
        let slot = self.slots.get_mut(slot)?;
        slot.progress = Progress::Done(result);
        slot.waker.take()
    }
}

/// The state behind the lock.
#[derive(Debug)]
pub(super) struct State<P> {
    pub(super) connection: StateWatch,
    /// Frames to be written.
    pub(super) out: Vec<u8>,
    /// The socket, while there is a connection.
    pub(super) socket: Option<CallersSocket>,
    /// Time at which the timer of the driver wakes it.
    pub(super) alarm: Option<Instant>,
    /// Encoder of acknowledgements.
    pub(super) encoder: Encoder<P>,
    pub(super) session: Session<usize>,
    pub(super) slots: Slots,
    pub(super) reports: Queues,
    pub(super) report_watchdog: ReportWatchdog,
    /// Waker of the driver while it waits.
    pub(super) driver: Option<Waker>,
    /// Memory with which the decoder continues after giving away a large body.
    pub(super) spare: Vec<u8>,
    pub(super) counters: ClientCounters,
    pub(super) metrics: FedMetrics,
    pub(super) limiters: LogLimiters,
}

/// Limits of log lines about arrivals and calls.
#[derive(Debug, Default)]
pub(super) struct LogLimiters {
    pub(super) bad_frame: LogLimiter,
    pub(super) invalid: LogLimiter,
    pub(super) untaken: LogLimiter,
    pub(super) late: LogLimiter,
    pub(super) busy: LogLimiter,
    pub(super) out_of_order: LogLimiter,
}

macro_rules! counters {
    ($($(#[doc = $doc:literal])* $name:ident,)*) => {
        /// Counters of a connection since its creation, reconnections included.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[non_exhaustive]
        pub struct ClientCounters {
            $($(#[doc = $doc])* pub $name: u64,)*
        }

        /// Metrics of the counters, with the values recorded so far.
        #[derive(Debug)]
        struct CounterMetrics {
            $($name: Counter,)*
            fed: ClientCounters,
        }

        impl CounterMetrics {
            fn new() -> Self {
                Self {
                    $($name: Counter::new(
                        concat!("fc_client_", stringify!($name), "_total"),
                        concat!($($doc),*),
                    ),)*
                    fed: ClientCounters::default(),
                }
            }

            /// Records the changes since the last call.
            fn feed(&mut self, counters: ClientCounters) {
                $(self.$name.add(counters.$name.saturating_sub(self.fed.$name));)*
                self.fed = counters;
            }
        }
    };
}

counters! {
    /// Bytes received.
    bytes_in,
    /// Bytes handed to the connection to be sent.
    bytes_out,
    /// Responses delivered to their call.
    answers,
    /// Responses that arrived after the end of their call.
    late_answers,
    /// Calls that ended without a response in time.
    timeouts,
    /// Reports put into the queue of at least one receiver, and acknowledged.
    reports,
    /// Reports that a full receiver missed while another one took them, counted per receiver.
    reports_missed,
    /// Repeated reports, which were only acknowledged.
    repeated_reports,
    /// Reports not acknowledged, because there was no receiver or none had room.
    reports_refused,
    /// Reports refused because of an invalid body or envelope.
    reports_invalid,
    /// Reports later than one and a half intervals after the last one of their kind on the connection.
    reports_late,
    /// Reports in an order that the spec does not allow, counted by each follower of the process.
    reports_out_of_order,
    /// Frames that could not be read.
    bad_frames,
}

/// Metrics of one connection.
#[derive(Debug)]
pub(super) struct FedMetrics {
    counters: CounterMetrics,
    connects: Counter,
    counted: u64,
    connected: Gauge,
    is_connected: Option<Held>,
}

impl FedMetrics {
    fn new() -> Self {
        Self {
            counters: CounterMetrics::new(),
            connects: Counter::new(
                "fc_client_connects_total",
                "Connections made, including reconnections.",
            ),
            counted: 0,
            connected: Gauge::new("fc_client_connected", "Open connections to a robot.", None),
            is_connected: None,
        }
    }
}

impl<P> State<P> {
    /// Records the changes since the last call.
    pub(super) fn tell(&mut self) {
        self.metrics.counters.feed(self.counters);
        let now = self.connection.now();
        let before = std::mem::replace(&mut self.metrics.counted, now.connects());
        self.metrics
            .connects
            .add(now.connects().saturating_sub(before));
        if !now.is_connected() {
            self.metrics.is_connected = None;
        } else if self.metrics.is_connected.is_none() {
            self.metrics.is_connected = Some(self.metrics.connected.hold());
        }
    }
}

#[derive(Debug)]
pub(super) struct Inner<P> {
    state: Mutex<State<P>>,
    /// Encoder of requests, used outside the lock of the state.
    encoder: Mutex<Encoder<P>>,
    pub(super) call_timeout: Duration,
    pub(super) limits: Limits,
    pub(super) config: ClientConfig,
    pub(super) operations: Operations,
    /// Number of calls in flight.
    pub(super) flying: Gauge,
    handles: AtomicUsize,
}

impl<P: Protocol> Inner<P> {
    pub(super) fn new(config: ClientConfig) -> Arc<Self> {
        let limits = config.connection.limits::<P>();
        Arc::new(Self {
            state: Mutex::new(State {
                connection: StateWatch::new(),
                out: Vec::new(),
                socket: None,
                alarm: None,
                encoder: config.encoder(),
                session: Session::new(
                    SessionRules::of::<P>(),
                    &limits,
                    P::DEFAULTS.ack,
                    config.connection.first_id(),
                ),
                slots: Slots::default(),
                reports: Queues::new(limits.queued_reports, config.connection.queued_bytes::<P>()),
                report_watchdog: ReportWatchdog::of::<P>(),
                driver: None,
                spare: Vec::new(),
                counters: ClientCounters::default(),
                metrics: FedMetrics::new(),
                limiters: LogLimiters::default(),
            }),
            operations: Operations::of::<P>(&CLIENT),
            flying: Gauge::new("fc_client_calls_in_flight", "Calls in flight.", None),
            encoder: Mutex::new(config.encoder()),
            call_timeout: config.call_timeout_or_default::<P>(),
            limits,
            config,
            handles: AtomicUsize::new(0),
        })
    }

    /// Every holder leaves a consistent state, even after a panic: the encoder removes an unfinished frame.
    pub(super) fn lock(&self) -> MutexGuard<'_, State<P>> {
        lock(&self.state)
    }

    /// Encodes a body and passes it to `then`. A caller that finds the encoder in use creates another one instead of
    /// waiting.
    pub(super) fn staged<T>(
        &self,
        write: &dyn Fn(&mut Vec<u8>),
        then: impl FnOnce(Staged<'_>) -> T,
    ) -> Result<T, FrameError> {
        match self.encoder.try_lock() {
            Ok(mut encoder) => encoder.stage(write).map(then),
            Err(TryLockError::Poisoned(encoder)) => encoder.into_inner().stage(write).map(then),
            Err(TryLockError::WouldBlock) => self.config.encoder::<P>().stage(write).map(then),
        }
    }

    /// Wakes the driver.
    pub(super) fn wake(&self) {
        let driver = self.lock().driver.take();
        if let Some(driver) = driver {
            driver.wake();
        }
    }

    /// Closes the connection, if it has not ended.
    pub(super) fn close(&self) {
        self.lock().connection.close(Loss::Here);
        self.wake();
    }
}

/// Keeps the connection open while at least one handle exists.
#[derive(Debug)]
pub(super) struct Handle<P: Protocol>(Arc<Inner<P>>);

impl<P: Protocol> Handle<P> {
    pub(super) fn new(inner: Arc<Inner<P>>) -> Self {
        inner.handles.fetch_add(1, Ordering::Relaxed);
        Self(inner)
    }
}

impl<P: Protocol> Clone for Handle<P> {
    fn clone(&self) -> Self {
        Self::new(Arc::clone(&self.0))
    }
}

impl<P: Protocol> Drop for Handle<P> {
    fn drop(&mut self) {
        if self.0.handles.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.0.close();
        }
    }
}

impl<P: Protocol> std::ops::Deref for Handle<P> {
    type Target = Inner<P>;

    fn deref(&self) -> &Inner<P> {
        &self.0
    }
}
