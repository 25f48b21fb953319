//! The state that the handle of a data connection shares with its driver: room for one frame in each direction.

use super::error::DataError;
use super::subscription::SubscriptionQueues;
use crate::client::loss::Loss;
use crate::client::state_watch::{ConnectionState, StateWatch};
use crate::stream::StreamFrame;
use crate::sync::lock;
use std::sync::{Mutex, MutexGuard};
use tokio::sync::Notify;

/// The frame to be sent.
#[derive(Debug)]
pub(super) enum Outbox {
    Empty,
    /// Not started, so it can be taken back.
    Waiting(Vec<u8>),
    /// Taken by the driver.
    Sending {
        /// `true` if the sender has given up.
        orphan: bool,
    },
    /// Result for the sender.
    Done(Result<(), Loss>),
}

/// The state behind the lock.
#[derive(Debug)]
pub(super) struct State {
    pub(super) connection: StateWatch,
    /// The received frame that has not been taken.
    inbox: Option<Result<StreamFrame, DataError>>,
    /// A loss to be reported to the receiver after the frame in the inbox.
    receiver_loss: Option<Loss>,
    /// Receivers of subscriptions.
    pub(super) subscriptions: SubscriptionQueues,
    pub(super) outbox: Outbox,
    /// A loss to be reported to the sender, after frames were sent.
    pub(super) sender_loss: Option<Loss>,
    /// `true` if something was sent over this connection.
    sent: bool,
    /// `true` if something was received over this connection.
    heard: bool,
}

#[derive(Debug)]
pub(super) struct Shared {
    state: Mutex<State>,
    /// A frame has arrived, or the state of the connection has changed.
    pub(super) inbox_changed: Notify,
    /// The outbox or the state of the connection has changed.
    pub(super) outbox_changed: Notify,
    /// For the driver: the inbox is empty.
    inbox_emptied: Notify,
    /// For the driver: there is a frame to be sent.
    outbox_filled: Notify,
    /// For the driver: this side closes the connection.
    pub(super) closing: Notify,
}

impl Shared {
    pub(super) fn new() -> Self {
        Self {
            state: Mutex::new(State {
                connection: StateWatch::new(),
                inbox: None,
                receiver_loss: None,
                subscriptions: SubscriptionQueues::default(),
                outbox: Outbox::Empty,
                sender_loss: None,
                sent: false,
                heard: false,
            }),
            inbox_changed: Notify::new(),
            outbox_changed: Notify::new(),
            inbox_emptied: Notify::new(),
            outbox_filled: Notify::new(),
            closing: Notify::new(),
        }
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Wakes all waiting tasks.
    pub(super) fn notify_all(&self) {
        self.inbox_changed.notify_waiters();
        self.outbox_changed.notify_waiters();
    }

    /// Takes the next result for the receiver, if there is one.
    pub(super) fn take(&self) -> Option<Result<StreamFrame, DataError>> {
        let mut state = self.lock();
        let taken = match state.inbox.take() {
            Some(arrived) => Some(arrived),
            None => state
                .receiver_loss
                .take()
                .map(|loss| Err(DataError::Lost(loss))),
        };
        if taken.is_some() {
            drop(state);
            self.inbox_emptied.notify_one();
            return taken;
        }
        state.closed()
    }

    /// Delivers a frame to its subscriptions, or waits until the receiver has room for it.
    pub(super) async fn put(&self, mut arrived: Result<StreamFrame, DataError>) {
        loop {
            let room = self.inbox_emptied.notified();
            // A separate statement, because the lock must not be held while waiting.
            let placed = self.lock().place(arrived);
            match placed {
                Ok(()) => break,
                Err(back) => arrived = back,
            }
            room.await;
        }
        self.inbox_changed.notify_waiters();
    }

    /// Adds a subscription to a code and returns its id.
    pub(super) fn enter(&self, code: u16) -> u64 {
        let id = self.lock().subscriptions.enter(code);
        // A frame that waits for room can be dropped now.
        self.inbox_emptied.notify_one();
        id
    }

    /// Takes the next result for a subscription, if there is one.
    pub(super) fn take_of(&self, id: u64) -> Option<Result<StreamFrame, DataError>> {
        let mut state = self.lock();
        let taken = state.subscriptions.take(id);
        if taken.is_some() {
            return taken;
        }
        state.closed()
    }

    /// Notes that a frame has been received.
    pub(super) fn hear(&self) {
        self.lock().heard = true;
    }

    pub(super) fn is_heard(&self) -> bool {
        self.lock().heard
    }

    /// Returns `true` if a frame has been sent or received.
    pub(super) fn is_used(&self) -> bool {
        let state = self.lock();
        state.heard || state.sent
    }

    /// Puts a frame into the empty outbox.
    pub(super) fn begin(&self, state: &mut State, bytes: Vec<u8>) {
        state.outbox = Outbox::Waiting(bytes);
        self.outbox_filled.notify_one();
    }

    /// Waits for the next frame to be sent.
    pub(super) async fn next(&self) -> Vec<u8> {
        loop {
            let work = self.outbox_filled.notified();
            {
                let mut state = self.lock();
                if let Outbox::Waiting(bytes) = &mut state.outbox {
                    let bytes = std::mem::take(bytes);
                    state.outbox = Outbox::Sending { orphan: false };
                    state.sent = true;
                    return bytes;
                }
            }
            work.await;
        }
    }

    /// Notes that the frame has been sent.
    pub(super) fn sent(&self) {
        let mut state = self.lock();
        match state.outbox {
            Outbox::Sending { orphan: true } => state.outbox = Outbox::Empty,
            Outbox::Sending { orphan: false } => state.outbox = Outbox::Done(Ok(())),
            Outbox::Empty | Outbox::Waiting(_) | Outbox::Done(_) => {}
        }
        drop(state);
        self.outbox_changed.notify_waiters();
    }

    /// Notes a new connection and returns its number.
    pub(super) fn connected(&self) -> u64 {
        let mut state = self.lock();
        state.heard = false;
        state.sent = false;
        state.connection.connected();
        let connects = state.connection.now().connects();
        drop(state);
        self.notify_all();
        connects
    }

    /// Notes that there is no connection yet.
    pub(super) fn not_connected(&self, why: Loss) {
        self.lock().connection.lost(why);
        self.notify_all();
    }

    /// Notes a loss of the connection and of the frames in flight.
    pub(super) fn lost(&self, why: Loss) {
        let mut state = self.lock();
        state.abandon(why);
        state.receiver_loss = Some(why);
        state.subscriptions.lost(why);
        state.connection.lost(why);
        drop(state);
        self.notify_all();
    }

    /// Notes the end of the connection.
    pub(super) fn close(&self, why: Loss) {
        let mut state = self.lock();
        state.abandon(why);
        state.connection.close(why);
        drop(state);
        self.notify_all();
    }
}

impl State {
    /// Returns the result for a receiver if the connection is closed.
    fn closed(&self) -> Option<Result<StreamFrame, DataError>> {
        match self.connection.now() {
            ConnectionState::Closed { why, .. } => Some(Err(DataError::Closed(why))),
            _ => None,
        }
    }

    /// Delivers a frame, or returns it if there is no room.
    fn place(
        &mut self,
        arrived: Result<StreamFrame, DataError>,
    ) -> Result<(), Result<StreamFrame, DataError>> {
        let Err(arrived) = self.subscriptions.offer(arrived) else {
            return Ok(());
        };
        if self.inbox.is_none() && self.receiver_loss.is_none() {
            self.inbox = Some(arrived);
            return Ok(());
        }
        if self.subscriptions.is_empty() {
            return Err(arrived);
        }
        // Subscriptions do not wait for a receiver that may not exist.
        self.subscriptions.skipped += 1;
        Ok(())
    }

    /// Notes that sent frames may be lost.
    fn abandon(&mut self, why: Loss) {
        let sent = std::mem::take(&mut self.sent);
        match self.outbox {
            Outbox::Sending { orphan: false } => self.outbox = Outbox::Done(Err(why)),
            Outbox::Sending { orphan: true } => {
                self.outbox = Outbox::Empty;
                self.sender_loss = Some(why);
            }
            // The next frame must not follow one that may be missing.
            Outbox::Waiting(_) if sent => self.outbox = Outbox::Done(Err(why)),
            Outbox::Empty | Outbox::Done(Ok(())) if sent => self.sender_loss = Some(why),
            Outbox::Empty | Outbox::Waiting(_) | Outbox::Done(_) => {}
        }
    }
}
