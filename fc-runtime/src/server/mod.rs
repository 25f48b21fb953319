//! The tokio server: a robot's side of the protocol.
//!
//! Each connection is one task. A request is read from the receive buffer, handled there, and answered into the send
//! buffer. Only handlers that have to wait are stored.
//!
//! ```no_run
//! use fc_runtime::{Command, Message, Protocol, Request, Server, ServerConfig};
//!
//! /// A robot that answers one command, always with its example.
//! async fn serve<P: Protocol, C: Command>() -> std::io::Result<()> {
//!     let service = |request: Request<'_, P>| match request.code() {
//!         code if code == C::CODE => {
//!             request.handle(|_, _: C| async { Ok(C::Response::example()) })
//!         }
//!         _ => request.unknown(),
//!     };
//!     Server::<P>::bind(ServerConfig::new(), service).await?.run().await;
//!     Ok(())
//! }
//! ```

mod allow;
mod answer;
mod budget;
mod config;
mod connection_id;
mod context;
mod counters;
mod data;
mod detached;
mod driver;
mod gate;
mod handle;
mod handlers;
mod handshake;
mod network;
mod output;
mod peer;
mod penalty;
mod push;
mod running_handler;
mod service;
mod shared;
mod table;
mod watch;

pub use config::ServerConfig;
pub use connection_id::ConnectionId;
pub use context::Context;
pub use counters::ServerCounters;
pub use data::{AppStream, AppStreams};
pub use handle::ServerHandle;
pub use network::{Network, NetworkError};
pub use push::{AckOutcome, Acknowledgement, Audience, PushError};
pub use service::{Handling, Request, Service};

use crate::link::prepare;
use crate::protocol::Protocol;
use shared::Shared;
use std::fmt;
use std::future::{poll_fn, ready};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::task::yield_now;
use tokio::time::sleep;

/// Wait after a failed accept, such as without free file handles.
const ACCEPT_AGAIN: Duration = Duration::from_millis(50);

/// A robot that listens for apps.
pub struct Server<P: Protocol> {
    command: TcpListener,
    data: TcpListener,
    command_address: SocketAddr,
    data_address: SocketAddr,
    shared: Arc<Shared<P>>,
}

impl<P: Protocol> Server<P> {
    /// Listens at both ports. Connections are accepted only by [`run`](Self::run).
    ///
    /// # Errors
    ///
    /// An error of the network, such as a port that is in use.
    pub async fn bind(config: ServerConfig, service: impl Service<P>) -> io::Result<Self> {
        let command =
            TcpListener::bind((config.address, config.connection.command_port::<P>())).await?;
        let data = TcpListener::bind((config.address, config.connection.data_port::<P>())).await?;
        Ok(Self {
            command_address: command.local_addr()?,
            data_address: data.local_addr()?,
            command,
            data,
            shared: Shared::new(config.settings::<P>(), Arc::new(service)),
        })
    }

    /// Returns the address of the command port.
    #[must_use]
    pub fn command_addr(&self) -> SocketAddr {
        self.command_address
    }

    /// Returns the address of the data port.
    #[must_use]
    pub fn data_addr(&self) -> SocketAddr {
        self.data_address
    }

    /// Returns a handle for reports, counters and shutdown.
    #[must_use]
    pub fn handle(&self) -> ServerHandle<P> {
        ServerHandle::new(Arc::clone(&self.shared))
    }

    /// Serves until [`ServerHandle::shutdown`]. Dropping the future closes all connections at once.
    pub async fn run(self) {
        let (command, data) = (self.command_address, self.data_address);
        tracing::info!(protocol = P::NAME, %command, %data, "listening");
        loop {
            tokio::select! {
                accepted = self.command.accept() => match accepted {
                    Ok((stream, address)) => self.accept(stream, address, false),
                    Err(error) => failed(&error).await,
                },
                accepted = self.data.accept() => match accepted {
                    Ok((stream, address)) => {
                        self.accept_commands().await;
                        self.accept(stream, address, true);
                    }
                    Err(error) => failed(&error).await,
                },
                () = self.shared.stop_requested() => break,
            }
            // Existing connections run between two accepted ones.
            yield_now().await;
        }
        self.shared.drain().await;
    }

    /// Accepts all waiting connections of the command port. An app connects there first. If its data connection were
    /// accepted before, it might be assigned to another app at the same address.
    async fn accept_commands(&self) {
        for _ in 0..self.shared.settings.limits.connections {
            let waiting = poll_fn(|cx| Poll::Ready(self.command.poll_accept(cx))).await;
            let Poll::Ready(Ok((stream, address))) = waiting else {
                return;
            };
            self.accept(stream, address, false);
            yield_now().await;
        }
    }

    fn accept(&self, stream: TcpStream, address: SocketAddr, data: bool) {
        if let Err(error) = prepare(&stream, self.shared.settings.connection.keepalive) {
            tracing::debug!(protocol = P::NAME, %error, "the connection was gone at once");
            return;
        }
        if data {
            self.shared.serve_data(ready(Ok(stream)), address);
        } else {
            self.shared.serve(ready(Ok(stream)), address);
        }
    }
}

async fn failed(error: &io::Error) {
    tracing::warn!(%error, "cannot accept");
    sleep(ACCEPT_AGAIN).await;
}

/// Ends all connections with the server.
impl<P: Protocol> Drop for Server<P> {
    fn drop(&mut self) {
        self.shared.abort();
    }
}

impl<P: Protocol> fmt::Debug for Server<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Server")
            .field("protocol", &P::NAME)
            .field("command", &self.command_address)
            .field("data", &self.data_address)
            .finish_non_exhaustive()
    }
}
