//! What the handle of a data connection and its driver share: room for one frame either way.

use super::error::DataError;
use super::subscription::Takers;
use crate::client::loss::Loss;
use crate::client::state_watch::{ConnectionState, StateWatch};
use crate::stream::StreamFrame;
use crate::sync::lock;
use std::sync::{Mutex, MutexGuard};
use tokio::sync::Notify;

/// The frame that is to be sent.
#[derive(Debug)]
pub(super) enum Outbox {
    Empty,
    /// Not begun: it can be taken back.
    Waiting(Vec<u8>),
    /// Begun, and the driver's.
    Sending {
        /// Nobody waits for it any more.
        orphan: bool,
    },
    /// For its sender to know.
    Done(Result<(), Loss>),
}

/// Behind the lock.
#[derive(Debug)]
pub(super) struct State {
    pub(super) connection: StateWatch,
    /// What has arrived and not been taken.
    inbox: Option<Result<StreamFrame, DataError>>,
    /// A loss that the receiver has not been told, after what is in the inbox.
    gap: Option<Loss>,
    /// Those who have subscribed to a stream.
    pub(super) takers: Takers,
    pub(super) outbox: Outbox,
    /// A loss that the sender has not been told, after frames were sent.
    pub(super) unsure: Option<Loss>,
    /// Something has been sent over this connection.
    sent: bool,
    /// Something has been received over it.
    heard: bool,
}

#[derive(Debug)]
pub(super) struct Shared {
    state: Mutex<State>,
    /// Something has arrived, or the connection has another state.
    pub(super) came: Notify,
    /// The outbox, or the state of the connection, has changed.
    pub(super) went: Notify,
    /// For the driver: the inbox is empty.
    room: Notify,
    /// For the driver: there is something to be sent.
    work: Notify,
    /// For the driver: this side closes the connection.
    pub(super) end: Notify,
}

impl Shared {
    pub(super) fn new() -> Self {
        Self {
            state: Mutex::new(State {
                connection: StateWatch::new(),
                inbox: None,
                gap: None,
                takers: Takers::default(),
                outbox: Outbox::Empty,
                unsure: None,
                sent: false,
                heard: false,
            }),
            came: Notify::new(),
            went: Notify::new(),
            room: Notify::new(),
            work: Notify::new(),
            end: Notify::new(),
        }
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Tells all that wait to look again.
    pub(super) fn tell(&self) {
        self.came.notify_waiters();
        self.went.notify_waiters();
    }

    /// What comes next for the receiver, if it is there.
    pub(super) fn take(&self) -> Option<Result<StreamFrame, DataError>> {
        let mut state = self.lock();
        let taken = match state.inbox.take() {
            Some(arrived) => Some(arrived),
            None => state.gap.take().map(|loss| Err(DataError::Lost(loss))),
        };
        if taken.is_some() {
            drop(state);
            self.room.notify_one();
            return taken;
        }
        match state.connection.now() {
            ConnectionState::Closed { why, .. } => Some(Err(DataError::Closed(why))),
            _ => None,
        }
    }

    /// Leaves what has arrived for those who have subscribed to it, or for the receiver as soon as there is room.
    pub(super) async fn put(&self, mut arrived: Result<StreamFrame, DataError>) {
        loop {
            let room = self.room.notified();
            // Apart, for the lock must not be held while waiting.
            let placed = self.lock().place(arrived);
            match placed {
                Ok(()) => break,
                Err(back) => arrived = back,
            }
            room.await;
        }
        self.came.notify_waiters();
    }

    /// Subscribes to the frames of a code. Says who is to ask for them.
    pub(super) fn enter(&self, code: u16) -> u64 {
        let id = self.lock().takers.enter(code);
        // What waits for room need not wait any more.
        self.room.notify_one();
        id
    }

    /// What comes next for a subscriber, if it is there.
    pub(super) fn take_of(&self, id: u64) -> Option<Result<StreamFrame, DataError>> {
        let mut state = self.lock();
        let taken = state.takers.take(id);
        if taken.is_some() {
            return taken;
        }
        match state.connection.now() {
            ConnectionState::Closed { why, .. } => Some(Err(DataError::Closed(why))),
            _ => None,
        }
    }

    /// Something has been received.
    pub(super) fn hear(&self) {
        self.lock().heard = true;
    }

    pub(super) fn is_heard(&self) -> bool {
        self.lock().heard
    }

    /// Whether the connection has been of use.
    pub(super) fn is_used(&self) -> bool {
        let state = self.lock();
        state.heard || state.sent
    }

    /// Takes a frame to be sent into the empty outbox.
    pub(super) fn begin(&self, state: &mut State, bytes: Vec<u8>) {
        state.outbox = Outbox::Waiting(bytes);
        self.work.notify_one();
    }

    /// The next frame to be sent.
    pub(super) async fn next(&self) -> Vec<u8> {
        loop {
            let work = self.work.notified();
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

    /// The frame that was being sent has been.
    pub(super) fn sent(&self) {
        let mut state = self.lock();
        match state.outbox {
            Outbox::Sending { orphan: true } => state.outbox = Outbox::Empty,
            Outbox::Sending { orphan: false } => state.outbox = Outbox::Done(Ok(())),
            Outbox::Empty | Outbox::Waiting(_) | Outbox::Done(_) => {}
        }
        drop(state);
        self.went.notify_waiters();
    }

    /// There is a connection. Says which.
    pub(super) fn connected(&self) -> u64 {
        let mut state = self.lock();
        state.heard = false;
        state.sent = false;
        state.connection.connected();
        let connects = state.connection.now().connects();
        drop(state);
        self.tell();
        connects
    }

    /// There is none yet.
    pub(super) fn not_connected(&self, why: Loss) {
        self.lock().connection.lost(why);
        self.tell();
    }

    /// The connection that there was is lost, and what was on its way with it.
    pub(super) fn lost(&self, why: Loss) {
        let mut state = self.lock();
        state.abandon(why);
        state.gap = Some(why);
        state.takers.lost(why);
        state.connection.lost(why);
        drop(state);
        self.tell();
    }

    /// There will be none any more.
    pub(super) fn close(&self, why: Loss) {
        let mut state = self.lock();
        state.abandon(why);
        state.connection.close(why);
        drop(state);
        self.tell();
    }
}

impl State {
    /// Puts what has arrived where it is asked for; gives it back if there is no room.
    fn place(
        &mut self,
        arrived: Result<StreamFrame, DataError>,
    ) -> Result<(), Result<StreamFrame, DataError>> {
        let Err(arrived) = self.takers.offer(arrived) else {
            return Ok(());
        };
        if self.inbox.is_none() && self.gap.is_none() {
            self.inbox = Some(arrived);
            return Ok(());
        }
        if self.takers.is_empty() {
            return Err(arrived);
        }
        // Subscribers do not wait for a receiver that there may not be.
        self.takers.skipped += 1;
        Ok(())
    }

    /// Notes that nobody knows what has become of the frames that were sent.
    fn abandon(&mut self, why: Loss) {
        let sent = std::mem::take(&mut self.sent);
        match self.outbox {
            Outbox::Sending { orphan: false } => self.outbox = Outbox::Done(Err(why)),
            Outbox::Sending { orphan: true } => {
                self.outbox = Outbox::Empty;
                self.unsure = Some(why);
            }
            // It must not go on where the one before it may be missing.
            Outbox::Waiting(_) if sent => self.outbox = Outbox::Done(Err(why)),
            Outbox::Empty | Outbox::Done(Ok(())) if sent => self.unsure = Some(why),
            Outbox::Empty | Outbox::Waiting(_) | Outbox::Done(_) => {}
        }
    }
}
