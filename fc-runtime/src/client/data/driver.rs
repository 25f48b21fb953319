//! The task of a data connection: it connects, reads and writes.

use super::error::DataError;
use super::shared::Shared;
use crate::client::config::ClientConfig;
use crate::client::connecting::{Dial, Reconnect};
use crate::client::connection_log::ConnectionLog;
use crate::client::loss::Loss;
use crate::client::state_watch::{ConnectionState, closed};
use crate::link::{CLOSING, Transport};
use crate::protocol::Protocol;
use crate::rate::MinimumRate;
use crate::stream::{Patience, Receiver, Sender, StreamError};
use crate::wire::Header;
use std::sync::Arc;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::watch;
use tokio::time::{sleep, timeout};

pub(super) struct Driver<P, D> {
    pub(super) shared: Arc<Shared>,
    /// The state of the command connection.
    pub(super) commands: watch::Receiver<ConnectionState>,
    pub(super) config: ClientConfig,
    pub(super) dial: D,
    pub(super) log: ConnectionLog,
    /// Reason why there is no connection.
    pub(super) why: Loss,
    pub(super) protocol: std::marker::PhantomData<fn() -> P>,
}

impl<P: Protocol, D: Dial> Driver<P, D> {
    /// Keeps a connection up until it is closed.
    pub(super) async fn run(mut self) {
        let mut reconnect = Reconnect::new(self.config.reconnect);
        while let Some((stream, commands)) = self.connect(&mut reconnect).await {
            self.serve(stream, commands).await;
            if self.shared.lock().connection.now().is_closed() {
                return;
            }
            // A sent frame counts as well, because a robot may have nothing to send.
            reconnect.connected(self.shared.is_used() || self.why == Loss::Renewed);
            self.shared.lost(self.why);
        }
    }

    /// Returns a connection and the number of its command connection, or `None` if there will be none.
    async fn connect(&mut self, reconnect: &mut Reconnect) -> Option<(D::Transport, u64)> {
        loop {
            let Some(wait) = reconnect.next() else {
                self.log.given_up(self.why);
                return None;
            };
            let mut commands = self.commands.clone();
            let shared = &self.shared;
            let attempt = async {
                sleep(wait).await;
                let number = up(&mut commands, shared).await;
                (self.dial.dial().await, number)
            };
            let (dialled, commands) = tokio::select! {
                biased;
                () = self.shared.closing.notified() => return None,
                why = closed(self.commands.clone()) => {
                    self.why = why;
                    return None;
                }
                attempted = attempt => attempted,
            };
            match dialled {
                Ok(stream) => return Some((stream, commands)),
                Err(error) => {
                    self.why = Loss::from(&error);
                    reconnect.failed();
                    self.shared.not_connected(self.why);
                    self.log.not_connected(self.why);
                }
            }
        }
    }

    /// Serves a connection until it ends.
    async fn serve<S: Transport>(&mut self, stream: S, commands: u64) {
        // The reason if the task ends before the connection.
        self.why = Loss::Ended;
        let (read, write) = tokio::io::split(stream);
        let patience = Patience {
            header: None,
            stall: Some(MinimumRate::new(0, self.config.connection.stall_timeout)),
        };
        let mut receiver = Receiver::new(read, self.config.decoder::<P>(), patience);
        let mut sender = Sender::new(write, patience);
        self.log.connected(self.shared.connected());
        let shared = &*self.shared;
        let mut for_good = false;
        self.why = tokio::select! {
            biased;
            () = shared.closing.notified() => {
                for_good = true;
                Loss::Here
            }
            why = parted(self.commands.clone(), commands) => {
                for_good = why != Loss::Renewed;
                why
            }
            why = receive(shared, &mut receiver) => why,
            why = send(shared, &mut sender) => why,
        };
        self.log.ended(self.why);
        if for_good {
            let goodbye = async {
                sender.close().await?;
                shared.sent();
                receiver.skip_to_end().await?;
                Ok::<(), StreamError>(())
            };
            // The wait is limited, because the robot may neither read nor stop sending.
            let _ = timeout(CLOSING, goodbye).await;
            shared.close(self.why);
        }
    }
}

/// Waits for the command connection and returns its number. The caller handles its end.
async fn up(commands: &mut watch::Receiver<ConnectionState>, shared: &Shared) -> u64 {
    loop {
        let state = *commands.borrow_and_update();
        if state.is_connected() {
            return state.connects();
        }
        if let ConnectionState::Connecting { why, .. } = state {
            shared.not_connected(why);
        }
        if commands.changed().await.is_err() {
            std::future::pending::<()>().await;
        }
    }
}

/// Waits until the command connection with this number is no longer the latest one.
async fn parted(mut commands: watch::Receiver<ConnectionState>, number: u64) -> Loss {
    let parted = |state: &ConnectionState| state.is_closed() || state.connects() != number;
    match commands.wait_for(parted).await {
        Ok(state) if state.is_closed() => state.why().unwrap_or(Loss::Ended),
        Ok(_) => Loss::Renewed,
        Err(_) => Loss::Ended,
    }
}

/// Delivers received frames until the connection ends.
async fn receive<R: AsyncRead + Unpin, P: Protocol>(
    shared: &Shared,
    receiver: &mut Receiver<R, P>,
) -> Loss {
    loop {
        let arrived = match receiver.recv().await {
            Ok(Some(stream)) => Ok(stream),
            Ok(None) if shared.is_heard() => return Loss::Closed,
            Ok(None) => return Loss::Unheard,
            Err(StreamError::Io(error)) => return Loss::broken(&error, shared.is_heard()),
            Err(StreamError::Frame(error)) if error.is_fatal() => return Loss::Frame(error),
            Err(StreamError::Stalled) => {
                let (come, total) = receiver.arriving();
                return Loss::Stalled {
                    received: come,
                    total: total.unwrap_or(P::Header::LEN),
                };
            }
            Err(StreamError::Frame(error)) => Err(DataError::Frame(error)),
            Err(StreamError::Unexpected(frame)) => Err(DataError::Unexpected(frame)),
            Err(StreamError::Refused { frame, refusal }) => {
                Err(DataError::Refused { frame, refusal })
            }
        };
        shared.hear();
        shared.put(arrived).await;
    }
}

/// Sends frames until the connection ends.
async fn send<W: AsyncWrite + Unpin>(shared: &Shared, sender: &mut Sender<W>) -> Loss {
    loop {
        let frame = shared.next().await;
        match sender.send(frame).await {
            Ok(()) => shared.sent(),
            Err(StreamError::Io(error)) => return Loss::broken(&error, shared.is_heard()),
            Err(_) => return Loss::Unread,
        }
    }
}

/// Ends all waits, even if the runtime ends.
impl<P, D> Drop for Driver<P, D> {
    fn drop(&mut self) {
        if self.why == Loss::NotYet {
            self.why = Loss::Ended;
        }
        self.shared.close(self.why);
    }
}
