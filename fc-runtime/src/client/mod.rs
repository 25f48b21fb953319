//! The tokio client: a connection of an app to a robot.
//!
//! A connection is one task with the socket, and a state behind a lock that is held briefly. Callers write their
//! requests into the shared buffer. The task sends all gathered requests with one write, and wakes the callers whose
//! responses have arrived. A call has no task, channel or timer.
//!
//! ```no_run
//! use fc_runtime::{ClientConfig, Command, Connection, Protocol};
//! use std::error::Error;
//!
//! async fn ask<P: Protocol, C: Command>(request: &C) -> Result<C::Response, Box<dyn Error>> {
//!     let robot = Connection::<P>::connect(ClientConfig::new().host("robot.local")).await?;
//!     Ok(robot.call(request).await?)
//! }
//! ```

mod arrivals;
mod call;
mod config;
mod connecting;
mod connection_log;
mod data;
mod driver;
mod error;
mod following;
mod loss;
mod queues;
mod report_watchdog;
mod reports;
mod socket;
mod state;
mod state_watch;

pub use call::{Call, CallOptions};
pub use config::{Backoff, ClientConfig};
pub use data::{DataConnection, DataError, StreamItem, Subscription};
pub use error::{CallError, ConnectError};
pub use following::{FollowError, Followed, Following};
pub use loss::Loss;
pub use reports::RawReports;
pub use state::ClientCounters;
pub use state_watch::{ConnectionState, ConnectionStates};

use crate::link::Transport;
use crate::operation::Command;
use crate::protocol::Protocol;
use crate::raw::RawResponse;
use connecting::{Dial, Dialer, tcp};
use state::{Handle, Inner};
use std::fmt;
use std::io;
use std::sync::Arc;

/// A connection to a robot's command port.
///
/// Clones are handles of the same connection. It is closed when the last handle, [`RawReports`] and [`Following`] is
/// dropped.
///
/// After a loss the connection is made again, unless configured otherwise. Calls in the meantime wait within their
/// timeout. Calls in flight with [`Effect::Read`](crate::Effect::Read) are sent again with the same id. Other calls in
/// flight end with [`CallError::Lost`], because the robot may have acted.
#[derive(Clone)]
pub struct Connection<P: Protocol> {
    handle: Handle<P>,
}

impl<P: Protocol> Connection<P> {
    /// Connects over TCP. Needs a tokio runtime with I/O and time.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails. Later losses are handled in the background.
    pub async fn connect(config: ClientConfig) -> Result<Self, ConnectError> {
        Self::dialled(tcp(config.command_address::<P>(), &config), config).await
    }

    /// Connects over streams that `dial` creates, such as TLS or a tunnel. `dial` is called again after a loss, as
    /// configured. One attempt may take the connect timeout. Needs a tokio runtime with time.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails. Later losses are handled in the background.
    pub async fn connect_by<D, F, S>(dial: D, config: ClientConfig) -> Result<Self, ConnectError>
    where
        D: FnMut() -> F + Send + 'static,
        F: Future<Output = io::Result<S>> + Send,
        S: Transport,
    {
        Self::dialled(
            Dialer::new(dial, config.command_address::<P>(), &config),
            config,
        )
        .await
    }

    /// Connects over TCP in the background and returns at once. The first connection is attempted like one after a
    /// loss, with the same [`Backoff`]. Calls in the meantime wait within their timeout, and their error contains the
    /// reason. Needs a tokio runtime with I/O and time.
    ///
    /// The first attempt starts at once and counts for `Backoff::attempts`. It is the only one if
    /// [`ClientConfig::reconnect`] is `None`.
    #[must_use]
    pub fn connect_lazy(config: ClientConfig) -> Self {
        let dial = tcp(config.command_address::<P>(), &config);
        Self::driven(None, dial, config)
    }

    /// Connects like [`connect_lazy`](Self::connect_lazy), over streams that `dial` creates. Needs a tokio runtime with
    /// time.
    #[must_use]
    pub fn connect_lazy_by<D, F, S>(dial: D, config: ClientConfig) -> Self
    where
        D: FnMut() -> F + Send + 'static,
        F: Future<Output = io::Result<S>> + Send,
        S: Transport,
    {
        Self::driven(
            None,
            Dialer::new(dial, config.command_address::<P>(), &config),
            config,
        )
    }

    async fn dialled<D: Dial>(mut dial: D, config: ClientConfig) -> Result<Self, ConnectError> {
        let stream = dial.dial().await?;
        Ok(Self::driven(Some(stream), dial, config))
    }

    fn driven<D: Dial>(stream: Option<D::Transport>, dial: D, config: ClientConfig) -> Self {
        let inner = Inner::new(config);
        if stream.is_some() {
            inner.lock().connection.connected();
        }
        let connection = Self::of(&inner);
        tokio::spawn(driver::drive_dialled(inner, stream, dial));
        connection
    }

    /// Creates a connection over an existing stream, such as TLS or a pipe in a test. It is not made again after a
    /// loss. Needs a tokio runtime with time.
    #[must_use]
    pub fn over<S: Transport>(stream: S, config: ClientConfig) -> Self {
        let inner = Inner::new(config);
        inner.lock().connection.connected();
        let connection = Self::of(&inner);
        tokio::spawn(driver::drive(inner, stream));
        connection
    }

    fn of(inner: &Arc<Inner<P>>) -> Self {
        Self {
            handle: Handle::new(Arc::clone(inner)),
        }
    }

    /// Calls a command and waits for its response.
    ///
    /// The future resolves to a [`CallError`] if there is no such response in time. [`Call::with_options`] sets the
    /// options of this call.
    pub fn call<'a, C: Command>(&'a self, request: &'a C) -> Call<'a, P, C> {
        Call::new(&self.handle, request, CallOptions::default())
    }

    /// Calls `code` with a JSON object of the request's keys. The envelope is added, unless `body` contains one. The
    /// call is not sent again after a loss.
    ///
    /// The result is not checked: a refusal is a response as well.
    ///
    /// # Errors
    ///
    /// Any [`CallError`] except [`CallError::Refused`].
    pub async fn call_raw(&self, code: u16, body: &[u8]) -> Result<RawResponse<P>, CallError> {
        call::raw(&self.handle, code, body, CallOptions::default()).await
    }

    /// Calls like [`call_raw`](Self::call_raw), with these options.
    ///
    /// # Errors
    ///
    /// Any [`CallError`] except [`CallError::Refused`].
    pub async fn call_raw_with(
        &self,
        code: u16,
        body: &[u8],
        options: CallOptions,
    ) -> Result<RawResponse<P>, CallError> {
        call::raw(&self.handle, code, body, options).await
    }

    /// Returns a receiver of all reports from now on. Each receiver has its own queue.
    ///
    /// A report is acknowledged only when a receiver has it. Without a receiver, the robot sends each report again
    /// until it gives up.
    #[must_use]
    pub fn reports(&self) -> RawReports<P> {
        RawReports::new(self.handle.clone())
    }

    /// Returns a connection to the robot's data port, which ends with this command connection. It is made in the
    /// background over TCP. Each call creates another one. Needs a tokio runtime with I/O and time.
    #[must_use]
    pub fn data(&self) -> DataConnection<P> {
        let config = &self.handle.config;
        let dial = tcp(config.data_address::<P>(), config);
        DataConnection::new(self.handle.clone(), dial)
    }

    /// Connects like [`data`](Self::data), over streams that `dial` creates, such as TLS or a tunnel. One attempt may
    /// take the connect timeout. Needs a tokio runtime with time.
    #[must_use]
    pub fn data_by<D, F, S>(&self, dial: D) -> DataConnection<P>
    where
        D: FnMut() -> F + Send + 'static,
        F: Future<Output = io::Result<S>> + Send,
        S: Transport,
    {
        let config = &self.handle.config;
        let by = Dialer::new(dial, config.data_address::<P>(), config);
        DataConnection::new(self.handle.clone(), by)
    }

    /// Returns the state of the connection, with the reason if there is none.
    #[must_use]
    pub fn state(&self) -> ConnectionState {
        self.handle.lock().connection.now()
    }

    /// Returns the states of the connection: the present one, then each new one.
    ///
    /// An app that queries the robot's state after each [`ConnectionState::Connected`] has the right state even after a
    /// restart of the robot.
    #[must_use]
    pub fn states(&self) -> ConnectionStates {
        ConnectionStates::new(self.handle.lock().connection.subscribe())
    }

    /// Waits until the connection has ended for good, and returns the reason: it was [closed](Self::close), given up as
    /// configured by [`ClientConfig::reconnect`], or its runtime has ended.
    ///
    /// Cancellation safe.
    pub async fn closed(&self) -> Loss {
        let states = self.handle.lock().connection.subscribe();
        state_watch::closed(states).await
    }

    /// Returns the number of calls in flight.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.handle.lock().session.in_flight()
    }

    /// Returns the counters of the connection.
    #[must_use]
    pub fn counters(&self) -> ClientCounters {
        self.handle.lock().counters
    }

    /// Closes the connection for all handles. Calls in flight end with [`CallError::Lost`], and report receivers end
    /// when their queue is empty.
    pub fn close(&self) {
        self.handle.close();
    }
}

impl<P: Protocol> fmt::Debug for Connection<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Connection")
            .field("protocol", &P::NAME)
            .field("state", &self.state())
            .finish_non_exhaustive()
    }
}
