//! The client without `async`, for tools and tests. Each call blocks its thread.
//!
//! A connection has its own thread, which reads, acknowledges and reconnects even between calls. The thread ends with
//! the last handle of the connection and the last of its reports.
//!
//! These types need no tokio runtime, and they do not panic inside one. There, connecting, calling and dropping are
//! allowed but block the thread, and with it the tasks of a single-threaded runtime. Use [`client`] there instead.

use crate::client::{
    self, CallError, ClientConfig, ConnectError, FollowError, Followed, RawReports,
};
use crate::json::BodyError;
use crate::operation::{Command, Report, SetsOff};
use crate::protocol::Protocol;
use crate::raw::RawReport;
use std::fmt;
use std::io;
use std::pin::pin;
use std::sync::{Arc, mpsc};
use std::task::{Context, Poll, Wake, Waker};
use std::thread::{self, Thread};
use std::time::Duration;
use tokio::runtime::{Builder, Handle};
use tokio::sync::oneshot;
use tokio::task::unconstrained;

/// A connection to a robot's command port, like [`client::Connection`], with blocking methods.
///
/// Clones are handles of the same connection.
#[derive(Clone)]
pub struct Connection<P: Protocol> {
    // Dropped before the thread that drives the connection.
    connection: client::Connection<P>,
    driver: Arc<Driver>,
}

impl<P: Protocol> Connection<P> {
    /// Connects over TCP.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails, or if the system cannot create a thread. Later losses are handled
    /// in the background.
    pub fn connect(config: ClientConfig) -> Result<Self, ConnectError> {
        let driver = Driver::start().map_err(|source| {
            let (host, port) = config.command_address::<P>();
            let address = format!("{host}:{port}");
            ConnectError::Io { address, source }
        })?;
        let connection = driver.wait(client::Connection::connect(config))?;
        let driver = Arc::new(driver);
        Ok(Self { connection, driver })
    }

    /// Calls a command and waits for its response.
    ///
    /// # Errors
    ///
    /// [`CallError`] if there is no such response in time.
    pub fn call<C: Command>(&self, request: &C) -> Result<C::Response, CallError> {
        self.wait(self.connection.call(request))
    }

    /// Calls a command, waits for its response and follows the reports that the command sets off, like
    /// [`client::Call::follow`].
    ///
    /// # Errors
    ///
    /// [`CallError`] if there is no such response in time. In that case no reports are followed.
    pub fn follow<C: SetsOff<R>, R: Report>(
        &self,
        request: &C,
    ) -> Result<Following<P, C, R>, CallError> {
        let following = self.wait(self.connection.call(request).follow())?;
        Ok(Following {
            following,
            driver: Arc::clone(&self.driver),
        })
    }

    /// Returns a receiver of all reports from now on. Each receiver has its own queue.
    ///
    /// A report is acknowledged once it is in the queue of a receiver, even before the app receives it.
    #[must_use]
    pub fn reports(&self) -> Reports<P> {
        Reports {
            reports: self.connection.reports(),
            driver: Arc::clone(&self.driver),
        }
    }

    /// Returns the connection with `async` methods: state and counters, call options, raw commands, the data port.
    /// [`wait`](Self::wait) waits for them.
    #[must_use]
    pub fn connection(&self) -> &client::Connection<P> {
        &self.connection
    }

    /// Blocks this thread until a future is ready, such as one of a method of [`connection`](Self::connection). The
    /// future may use the I/O and timers of tokio.
    pub fn wait<F: Future>(&self, future: F) -> F::Output {
        self.driver.wait(future)
    }
}

impl<P: Protocol> fmt::Debug for Connection<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.connection.fmt(f)
    }
}

/// The reports of a connection, like [`RawReports`], with blocking methods.
///
/// The iterator waits for each report without a limit, and ends when the connection is closed.
pub struct Reports<P: Protocol> {
    // Dropped before the thread that drives the connection.
    reports: RawReports<P>,
    driver: Arc<Driver>,
}

impl<P: Protocol> Reports<P> {
    /// Returns the next report, or `None` if the connection is closed and the queue is empty.
    pub fn recv(&mut self) -> Option<RawReport> {
        self.driver.wait(self.reports.recv())
    }

    /// Returns the next report if it comes within `timeout`. A later report is not lost.
    ///
    /// # Errors
    ///
    /// [`ReportError::Timeout`] and [`ReportError::Closed`].
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<RawReport, ReportError> {
        let report = async { tokio::time::timeout(timeout, self.reports.recv()).await };
        match self.driver.wait(report) {
            Ok(Some(report)) => Ok(report),
            Ok(None) => Err(ReportError::Closed),
            Err(_) => Err(ReportError::Timeout),
        }
    }

    /// Returns the number of reports this receiver has missed since the last call. It misses a report if its queue is
    /// full while another receiver takes the report.
    pub fn missed(&mut self) -> u64 {
        self.reports.missed()
    }
}

impl<P: Protocol> Iterator for Reports<P> {
    type Item = RawReport;

    fn next(&mut self) -> Option<RawReport> {
        self.recv()
    }
}

impl<P: Protocol> fmt::Debug for Reports<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reports.fmt(f)
    }
}

/// An answered command and the reports `R` that it sets off, like [`client::Following`], with blocking methods.
///
/// The iterator waits for each event without a limit.
pub struct Following<P: Protocol, C: SetsOff<R>, R: Report> {
    // Dropped before the thread that drives the connection.
    following: client::Following<P, C, R>,
    driver: Arc<Driver>,
}

impl<P: Protocol, C: SetsOff<R>, R: Report> Following<P, C, R> {
    /// Returns the robot's response to the command.
    #[must_use]
    pub fn answer(&self) -> &C::Response {
        self.following.answer()
    }

    /// Returns the next event, or `None` after the end.
    pub fn recv(&mut self) -> Option<Result<Followed<R>, FollowError>> {
        self.driver.wait(self.following.recv())
    }

    /// Returns the next event if it comes within `timeout`, `Some(None)` after the end, or `None` after the timeout. A
    /// later event is not lost.
    pub fn recv_timeout(
        &mut self,
        timeout: Duration,
    ) -> Option<Option<Result<Followed<R>, FollowError>>> {
        let next = async { tokio::time::timeout(timeout, self.following.recv()).await };
        self.driver.wait(next).ok()
    }
}

impl<P: Protocol, C: SetsOff<R>, R: Report> Iterator for Following<P, C, R> {
    type Item = Result<Followed<R>, FollowError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.recv()
    }
}

impl<P: Protocol, C: SetsOff<R>, R: Report> fmt::Debug for Following<P, C, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.following.fmt(f)
    }
}

/// The reason why there is no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// No report came in time.
    #[error("no report in time")]
    Timeout,
    /// The connection is closed.
    #[error("the connection is closed; no more reports will come")]
    Closed,
    /// The report cannot be read as its type. Only connections of another protocol's types have such reports, because
    /// reports are checked before they are acknowledged.
    #[error(transparent)]
    Invalid(#[from] BodyError),
}

/// The thread that drives a connection. It ends when this is dropped.
struct Driver {
    runtime: Handle,
    _ends: oneshot::Sender<()>,
}

impl Driver {
    fn start() -> io::Result<Self> {
        let (started, is_started) = mpsc::sync_channel(1);
        let (ends, is_over) = oneshot::channel::<()>();
        // The runtime must not be dropped on a thread of another runtime, so it is built, run and dropped on its own
        // thread.
        let drive = move || {
            let runtime = Builder::new_current_thread().enable_all().build();
            let runtime = match runtime {
                Ok(runtime) => runtime,
                Err(error) => {
                    let _ = started.send(Err(error));
                    return;
                }
            };
            if started.send(Ok(runtime.handle().clone())).is_ok() {
                // The dropped sender signals the end.
                let _ = runtime.block_on(is_over);
            }
        };
        thread::Builder::new()
            .name("fc-client".to_owned())
            .spawn(drive)?;
        let runtime = is_started.recv().map_err(io::Error::other)??;
        Ok(Self {
            runtime,
            _ends: ends,
        })
    }

    /// Polls a future on this thread until it is ready. The thread sleeps in between.
    ///
    /// `Handle::block_on` would panic on a thread of another runtime.
    fn wait<F: Future>(&self, future: F) -> F::Output {
        let _entered = self.runtime.enter();
        // In a task of another runtime, the budget of that task would run out and never be renewed.
        let mut future = pin!(unconstrained(future));
        let waker = Waker::from(Arc::new(Unpark(thread::current())));
        let mut context = Context::from_waker(&waker);
        loop {
            match future.as_mut().poll(&mut context) {
                Poll::Ready(output) => return output,
                Poll::Pending => thread::park(),
            }
        }
    }
}

/// Wakes a thread that waits for a future.
struct Unpark(Thread);

impl Wake for Unpark {
    fn wake(self: Arc<Self>) {
        self.0.unpark();
    }

    fn wake_by_ref(self: &Arc<Self>) {
        self.0.unpark();
    }
}
