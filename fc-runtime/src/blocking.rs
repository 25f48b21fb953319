//! The client without `async`, for tools and tests: each call waits on the thread that makes it.
//!
//! A connection has a thread of its own, which reads, acknowledges and reconnects also while nobody
//! calls anything. It ends with the last handle of the connection and the last of its reports.
//!
//! Nothing here needs a tokio runtime, and nothing panics within one: connecting, calling and dropping
//! are allowed there too, but they hold up the thread that they are on, and with it the tasks of a
//! runtime that has only this one. There, use [`client`] instead.

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

/// A connection to a robot's command port, as [`client::Connection`] is, that is waited for.
///
/// Clones are handles of the same connection.
pub struct Connection<P: Protocol> {
    // Dropped before the thread that drives it.
    connection: client::Connection<P>,
    driver: Arc<Driver>,
}

impl<P: Protocol> Connection<P> {
    /// Connects over TCP.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails, or if the system has no thread to give; later
    /// losses are handled in the background.
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

    /// Calls a command, waits for its response and follows what the command has set off, as
    /// [`client::Call::follow`] does.
    ///
    /// # Errors
    ///
    /// [`CallError`] if there is no such response in time; nothing is followed then.
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

    /// The robot's reports from here on. Each receiver gets all of them, and has a queue of its own.
    ///
    /// Reports are acknowledged as soon as a receiver has them in its queue, whether or not it is
    /// asked for them.
    #[must_use]
    pub fn reports(&self) -> Reports<P> {
        Reports {
            reports: self.connection.reports(),
            driver: Arc::clone(&self.driver),
        }
    }

    /// The same connection with `async` methods: its state and counters, options of a call, raw
    /// commands, the data port. [`wait`](Self::wait) waits for them.
    #[must_use]
    pub fn connection(&self) -> &client::Connection<P> {
        &self.connection
    }

    /// Waits on this thread for a future, such as that of a method of [`connection`](Self::connection).
    /// It may use what tokio has for I/O and time.
    pub fn wait<F: Future>(&self, future: F) -> F::Output {
        self.driver.wait(future)
    }
}

impl<P: Protocol> Clone for Connection<P> {
    fn clone(&self) -> Self {
        Self {
            connection: self.connection.clone(),
            driver: Arc::clone(&self.driver),
        }
    }
}

impl<P: Protocol> fmt::Debug for Connection<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.connection.fmt(f)
    }
}

/// The reports of a connection, as [`RawReports`] has them, that are waited for.
///
/// As an iterator it waits for each as long as it takes, and ends when the connection is closed for
/// good.
pub struct Reports<P: Protocol> {
    // Dropped before the thread that drives its connection.
    reports: RawReports<P>,
    driver: Arc<Driver>,
}

impl<P: Protocol> Reports<P> {
    /// The next report; `None` once the connection is closed and no report is left.
    pub fn recv(&mut self) -> Option<RawReport> {
        self.driver.wait(self.reports.recv())
    }

    /// The next report, if there is one within `timeout`. What comes later is not lost.
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

    /// How many reports this receiver has missed since this was last asked, because its queue was
    /// full while another receiver took them.
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

/// A command that has been answered, and the reports `R` that it sets off, as [`client::Following`] has them, that
/// are waited for.
///
/// As an iterator it waits for each as long as it takes.
pub struct Following<P: Protocol, C: SetsOff<R>, R: Report> {
    // Dropped before the thread that drives its connection.
    following: client::Following<P, C, R>,
    driver: Arc<Driver>,
}

impl<P: Protocol, C: SetsOff<R>, R: Report> Following<P, C, R> {
    /// What the robot has answered to the command.
    #[must_use]
    pub fn answer(&self) -> &C::Response {
        self.following.answer()
    }

    /// What comes next; `None` after the end.
    pub fn recv(&mut self) -> Option<Result<Followed<R>, FollowError>> {
        self.driver.wait(self.following.recv())
    }

    /// What comes next, if it comes within `timeout`: `Some(None)` after the end, `None` if nothing has come in
    /// time. What comes later is not lost.
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

/// Why there is no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// None has come in time.
    #[error("no report in time")]
    Timeout,
    /// The connection is closed for good.
    #[error("the connection is closed; no more reports will come")]
    Closed,
    /// It does not read as its type says. Only a connection to a protocol of other types has such
    /// reports, for they are read before they are acknowledged.
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
        // The runtime is built, run and dropped there: it must not be dropped on a thread of another.
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
                // An error is how the end is told.
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

    /// Polls a future on this thread until it is ready, asleep in between.
    ///
    /// `Handle::block_on` would panic on a thread of another runtime.
    fn wait<F: Future>(&self, future: F) -> F::Output {
        let _entered = self.runtime.enter();
        // Within a task of another runtime its budget would be used up, and never come back.
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
