//! The tokio client: an app's connection to a robot.
//!
//! A connection is one task that owns the socket and a state behind a short lock. Callers write
//! their requests into the shared buffer themselves; the task sends all that has gathered with one
//! write, and wakes the callers whose answers have come. No call has a task, a channel or a timer of
//! its own.
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
use connecting::{CustomDial, Dial, TcpDial};
use state::{Handle, Inner};
use std::fmt;
use std::io;
use std::sync::Arc;

/// A connection to a robot's command port.
///
/// Clones are handles of the same connection. It is closed when the last of them, and the last
/// [`RawReports`] and [`Following`], is dropped.
///
/// After a loss it reconnects, unless told otherwise. Calls made meanwhile wait within their
/// timeout. Of the calls that were on their way, those with [`Effect::Read`](crate::Effect::Read)
/// are sent again with the same id; the others end with [`CallError::Lost`], because nobody knows
/// whether the robot has acted.
pub struct Connection<P: Protocol> {
    handle: Handle<P>,
}

impl<P: Protocol> Connection<P> {
    /// Connects over TCP. Needs a tokio runtime with I/O and time.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails; later losses are handled in the background.
    pub async fn connect(config: ClientConfig) -> Result<Self, ConnectError> {
        let (host, port) = config.command_address::<P>();
        let tcp = TcpDial::new(host, port, &config);
        Self::dialled(tcp, config).await
    }

    /// Connects over streams that `dial` makes, such as TLS or a tunnel, and reconnects with it
    /// after a loss, as configured. One attempt may take the connect timeout. Needs a tokio runtime
    /// with time.
    ///
    /// # Errors
    ///
    /// [`ConnectError`] if the first attempt fails; later losses are handled in the background.
    pub async fn connect_by<D, F, S>(dial: D, config: ClientConfig) -> Result<Self, ConnectError>
    where
        D: FnMut() -> F + Send + 'static,
        F: Future<Output = io::Result<S>> + Send,
        S: Transport,
    {
        Self::dialled(
            CustomDial::new(dial, config.command_address::<P>(), &config),
            config,
        )
        .await
    }

    /// Connects over TCP in the background, and returns at once: the first connection is waited for
    /// like another one after a loss, with the same [`Backoff`]. Calls made meanwhile wait within their
    /// timeout, and their error says why there was no connection. Needs a tokio runtime with I/O and
    /// time.
    ///
    /// The first attempt begins at once. It counts among `Backoff::attempts`, and is the only one where
    /// [`ClientConfig::reconnect`] is `None`.
    #[must_use]
    pub fn connect_lazy(config: ClientConfig) -> Self {
        let (host, port) = config.command_address::<P>();
        let tcp = TcpDial::new(host, port, &config);
        Self::driven(None, tcp, config)
    }

    /// [`connect_lazy`](Self::connect_lazy) over streams that `dial` makes. Needs a tokio runtime with
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
            CustomDial::new(dial, config.command_address::<P>(), &config),
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

    /// A connection over a stream that exists already, such as TLS or a pipe in a test. It is not
    /// made again after a loss. Needs a tokio runtime with time.
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
    /// The future resolves to a [`CallError`] if there is no such response in time.
    pub fn call<'a, C: Command>(&'a self, request: &'a C) -> Call<'a, P, C> {
        self.call_with(request, CallOptions::default())
    }

    /// Calls a command with options of its own.
    ///
    /// The future resolves to a [`CallError`] if there is no such response in time.
    pub fn call_with<'a, C: Command>(
        &'a self,
        request: &'a C,
        options: CallOptions,
    ) -> Call<'a, P, C> {
        Call::new(&self.handle, request, options)
    }

    /// Calls `code` with a JSON object of the request's own keys. The envelope is added, unless
    /// `body` has one. It is not sent again after a loss.
    ///
    /// The result is not judged: a refusal is a response, too.
    ///
    /// # Errors
    ///
    /// Any [`CallError`] but [`CallError::Refused`].
    pub async fn call_raw(&self, code: u16, body: &[u8]) -> Result<RawResponse<P>, CallError> {
        call::raw(&self.handle, code, body, CallOptions::default()).await
    }

    /// [`call_raw`](Self::call_raw) with options of its own.
    ///
    /// # Errors
    ///
    /// Any [`CallError`] but [`CallError::Refused`].
    pub async fn call_raw_with(
        &self,
        code: u16,
        body: &[u8],
        options: CallOptions,
    ) -> Result<RawResponse<P>, CallError> {
        call::raw(&self.handle, code, body, options).await
    }

    /// The robot's reports from here on. Each receiver gets all of them, and has a queue of its own.
    ///
    /// Reports are acknowledged only when a receiver has them: without one, the robot sends each
    /// again until it gives up.
    #[must_use]
    pub fn reports(&self) -> RawReports<P> {
        RawReports::new(self.handle.clone())
    }

    /// A connection to the robot's data port, of this command connection and as long as it. Returns at
    /// once; the connection is made in the background, over TCP. Each call makes another one. Needs a
    /// tokio runtime with I/O and time.
    #[must_use]
    pub fn data(&self) -> DataConnection<P> {
        let config = &self.handle.config;
        let (host, port) = config.data_address::<P>();
        DataConnection::new(self.handle.clone(), TcpDial::new(host, port, config))
    }

    /// [`data`](Self::data) over streams that `dial` makes, such as TLS or a tunnel. One attempt may
    /// take the connect timeout. Needs a tokio runtime with time.
    #[must_use]
    pub fn data_by<D, F, S>(&self, dial: D) -> DataConnection<P>
    where
        D: FnMut() -> F + Send + 'static,
        F: Future<Output = io::Result<S>> + Send,
        S: Transport,
    {
        let config = &self.handle.config;
        let by = CustomDial::new(dial, config.data_address::<P>(), config);
        DataConnection::new(self.handle.clone(), by)
    }

    /// Whether there is a connection at this moment, and why not.
    #[must_use]
    pub fn state(&self) -> ConnectionState {
        self.handle.lock().connection.now()
    }

    /// The states of the connection: the present one first, and then each that it comes to.
    ///
    /// An app that asks the robot for its state each time that this says
    /// [`ConnectionState::Connected`] knows it also after the robot has been restarted.
    #[must_use]
    pub fn states(&self) -> ConnectionStates {
        ConnectionStates::new(self.handle.lock().connection.subscribe())
    }

    /// Waits until the connection has ended for good, and says why: it was [closed](Self::close), was
    /// given up as [`ClientConfig::reconnect`] says, or its runtime has ended.
    ///
    /// Cancellation safe.
    pub async fn closed(&self) -> Loss {
        let states = self.handle.lock().connection.subscribe();
        state_watch::closed(states).await
    }

    /// How many calls are in flight.
    #[must_use]
    pub fn in_flight(&self) -> usize {
        self.handle.lock().session.in_flight()
    }

    /// What the connection has seen so far.
    #[must_use]
    pub fn counters(&self) -> ClientCounters {
        self.handle.lock().counters
    }

    /// Closes the connection for all its handles. Calls in flight end with [`CallError::Lost`], and
    /// reports end once the queue is empty.
    pub fn close(&self) {
        self.handle.close();
    }
}

impl<P: Protocol> Clone for Connection<P> {
    fn clone(&self) -> Self {
        Self {
            handle: self.handle.clone(),
        }
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
