//! Whether there is a connection: as a value, and as a stream of its changes.

use super::loss::Loss;
use futures_core::Stream;
use futures_util::StreamExt as _;
use futures_util::stream::unfold;
use std::fmt;
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::watch;

/// Whether there is a connection at this moment, and why not.
///
/// `connects` is the number of connections made so far. A robot may have restarted in between, so
/// that an app that sees another number than before asks for the robot's state again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConnectionState {
    /// There is a connection.
    Connected {
        /// Which one it is, counted from 1.
        connects: u64,
    },
    /// There is none, and one is being made: the first, or another one after a loss. What can wait
    /// for it does.
    Connecting {
        /// Connections so far; 0 before the first.
        connects: u64,
        /// Why there is none: the loss, and from then on what the last attempt failed with.
        why: Loss,
    },
    /// There will be none any more.
    Closed {
        /// Connections there have been.
        connects: u64,
        /// What ended the last one, or what the last attempt failed with.
        why: Loss,
    },
}

impl ConnectionState {
    /// Whether there is a connection.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        matches!(self, Self::Connected { .. })
    }

    /// Whether there will be no connection any more.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Closed { .. })
    }

    /// How many connections have been made, the present one included.
    #[must_use]
    pub fn connects(&self) -> u64 {
        match *self {
            Self::Connected { connects }
            | Self::Connecting { connects, .. }
            | Self::Closed { connects, .. } => connects,
        }
    }

    /// Why there is no connection; `None` while there is one.
    #[must_use]
    pub fn why(&self) -> Option<Loss> {
        match *self {
            Self::Connected { .. } => None,
            Self::Connecting { why, .. } | Self::Closed { why, .. } => Some(why),
        }
    }
}

/// The state of a connection, and all who watch it.
#[derive(Debug)]
pub(super) struct StateWatch {
    /// What the watchers are told. Asked for here, it costs a call nothing.
    now: ConnectionState,
    told: watch::Sender<ConnectionState>,
}

impl StateWatch {
    /// Before the first connection.
    pub(super) fn new() -> Self {
        let now = ConnectionState::Connecting {
            connects: 0,
            why: Loss::NotYet,
        };
        Self {
            now,
            told: watch::Sender::new(now),
        }
    }

    pub(super) fn now(&self) -> ConnectionState {
        self.now
    }

    /// There is one more connection.
    pub(super) fn connected(&mut self) {
        let connects = self.now.connects() + 1;
        self.turn(ConnectionState::Connected { connects });
    }

    /// There is no connection, and another one is being made.
    pub(super) fn lost(&mut self, why: Loss) {
        let connects = self.now.connects();
        self.turn(ConnectionState::Connecting { connects, why });
    }

    /// There will be none. The first reason counts.
    pub(super) fn close(&mut self, why: Loss) {
        let connects = self.now.connects();
        self.turn(ConnectionState::Closed { connects, why });
    }

    fn turn(&mut self, state: ConnectionState) {
        if !self.now.is_closed() {
            self.now = state;
            self.told.send_replace(state);
        }
    }

    pub(super) fn subscribe(&self) -> watch::Receiver<ConnectionState> {
        self.told.subscribe()
    }
}

/// The states of a connection: first the one that it is in, then each that it comes to, and nothing
/// after [`ConnectionState::Closed`].
///
/// Nothing is queued. Who asks late gets the latest state, and from `connects` learns of
/// connections in between. It does not keep the connection open.
pub struct ConnectionStates(Pin<Box<dyn Stream<Item = ConnectionState> + Send + Sync>>);

impl ConnectionStates {
    pub(super) fn new(states: watch::Receiver<ConnectionState>) -> Self {
        let states = unfold((states, None), async |(mut states, seen)| {
            loop {
                let now = *states.borrow_and_update();
                if seen != Some(now) {
                    return Some((now, (states, Some(now))));
                }
                if now.is_closed() || states.changed().await.is_err() {
                    return None;
                }
            }
        });
        Self(Box::pin(states.fuse()))
    }

    /// The next state; `None` after [`ConnectionState::Closed`].
    ///
    /// Cancellation safe.
    pub async fn recv(&mut self) -> Option<ConnectionState> {
        self.0.next().await
    }
}

impl Stream for ConnectionStates {
    type Item = ConnectionState;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.0.as_mut().poll_next(cx)
    }
}

impl fmt::Debug for ConnectionStates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ConnectionStates").finish_non_exhaustive()
    }
}

/// Waits until a connection has ended for good, and says why.
pub(super) async fn closed(mut states: watch::Receiver<ConnectionState>) -> Loss {
    let closed = states.wait_for(ConnectionState::is_closed).await;
    closed.map_or(Loss::Ended, |state| state.why().unwrap_or(Loss::Ended))
}
