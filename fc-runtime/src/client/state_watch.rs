//! The state of a connection, as a value and as a stream of changes.

use super::loss::Loss;
use futures_core::Stream;
use futures_util::StreamExt as _;
use futures_util::stream::unfold;
use std::fmt;
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::watch;

/// The state of a connection, with the reason if there is none.
///
/// `connects` is the number of connections made so far. The robot may have restarted between two of them, so an app
/// queries the robot's state when the number changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConnectionState {
    /// There is a connection.
    Connected {
        /// Number of the connection, counted from 1.
        connects: u64,
    },
    /// There is no connection, and one is being made: the first, or another one after a loss. Calls wait for it.
    Connecting {
        /// Number of connections so far; 0 before the first.
        connects: u64,
        /// The loss, or the error of the last attempt.
        why: Loss,
    },
    /// There will be no further connection.
    Closed {
        /// Number of connections.
        connects: u64,
        /// The loss of the last connection, or the error of the last attempt.
        why: Loss,
    },
}

impl ConnectionState {
    /// Returns `true` if there is a connection.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        matches!(self, Self::Connected { .. })
    }

    /// Returns `true` if there will be no further connection.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Closed { .. })
    }

    /// Returns the number of connections so far, the present one included.
    #[must_use]
    pub fn connects(&self) -> u64 {
        match *self {
            Self::Connected { connects }
            | Self::Connecting { connects, .. }
            | Self::Closed { connects, .. } => connects,
        }
    }

    /// Returns the reason why there is no connection, or `None` if there is one.
    #[must_use]
    pub fn why(&self) -> Option<Loss> {
        match *self {
            Self::Connected { .. } => None,
            Self::Connecting { why, .. } | Self::Closed { why, .. } => Some(why),
        }
    }
}

/// The state of a connection, and its watchers.
#[derive(Debug)]
pub(super) struct StateWatch {
    /// Copy of the state for the watchers. A call reads it here at no cost.
    now: ConnectionState,
    told: watch::Sender<ConnectionState>,
}

impl StateWatch {
    /// Creates the state before the first connection.
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

    /// Notes a new connection.
    pub(super) fn connected(&mut self) {
        let connects = self.now.connects() + 1;
        self.turn(ConnectionState::Connected { connects });
    }

    /// Notes that there is no connection and another one is being made.
    pub(super) fn lost(&mut self, why: Loss) {
        let connects = self.now.connects();
        self.turn(ConnectionState::Connecting { connects, why });
    }

    /// Notes the end. The first reason is kept.
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

/// The states of a connection: the present one, then each new one, up to [`ConnectionState::Closed`].
///
/// States are not queued. A late caller gets the latest state, and `connects` reveals connections in between. It does
/// not keep the connection open.
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

    /// Returns the next state, or `None` after [`ConnectionState::Closed`].
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

/// Waits until a connection has ended for good, and returns the reason.
pub(super) async fn closed(mut states: watch::Receiver<ConnectionState>) -> Loss {
    let closed = states.wait_for(ConnectionState::is_closed).await;
    closed.map_or(Loss::Ended, |state| state.why().unwrap_or(Loss::Ended))
}
