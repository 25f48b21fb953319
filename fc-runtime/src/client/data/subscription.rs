//! Receivers of one stream each, with their own queues.

use super::error::DataError;
use super::shared::Shared;
use crate::client::loss::Loss;
use crate::content::StreamContent;
use crate::json::Allowance;
use crate::stream::StreamFrame;
use std::collections::VecDeque;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// Frames in the queue of one receiver.
const QUEUE: usize = 4;

/// The frames of one stream from the creation of the receiver on, in the order received, each read as a `T`.
///
/// Each receiver has a queue of four frames. When it is full, a new frame replaces the oldest one, and
/// [`missed`](Self::missed) counts that. This suits live data: only the latest frame matters, and a slow app delays
/// neither the robot nor other receivers. Use [`DataConnection::recv`](super::DataConnection::recv) to get every frame;
/// it makes the robot wait.
///
/// It continues after reconnections, and ends with its [`DataConnection`](super::DataConnection).
pub struct Subscription<T> {
    shared: Arc<Shared>,
    id: u64,
    allowance: Allowance,
    content: PhantomData<fn() -> T>,
}

/// A frame of a stream with its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamItem<T> {
    /// Message id of the request that it belongs to.
    pub id: u32,
    /// Content.
    pub content: T,
}

impl<T: StreamContent> Subscription<T> {
    pub(super) fn new(shared: Arc<Shared>, code: u16, allowance: Allowance) -> Self {
        let id = shared.enter(code);
        Self {
            shared,
            id,
            allowance,
            content: PhantomData,
        }
    }

    /// Returns the next frame.
    ///
    /// Cancellation safe: a frame is taken from the queue only when it is returned.
    ///
    /// # Errors
    ///
    /// [`DataError::Lost`] if frames may be missing because the connection was lost; [`DataError::Frame`] and
    /// [`DataError::Invalid`] for a frame that cannot be read. After any error except [`DataError::Closed`], the next
    /// call continues with the next frame.
    pub async fn recv(&mut self) -> Result<StreamItem<T>, DataError> {
        let frame = loop {
            let came = self.shared.inbox_changed.notified();
            if let Some(taken) = self.shared.take_of(self.id) {
                break taken?;
            }
            came.await;
        };
        let content = T::read(frame.data, self.allowance).map_err(DataError::Invalid)?;
        Ok(StreamItem {
            id: frame.id,
            content,
        })
    }
}

impl<T> Subscription<T> {
    /// Returns the number of replaced frames since the last call.
    pub fn missed(&mut self) -> u64 {
        self.shared.lock().subscriptions.missed_of(self.id)
    }
}

impl<T> Drop for Subscription<T> {
    fn drop(&mut self) {
        self.shared.lock().subscriptions.leave(self.id);
    }
}

impl<T> fmt::Debug for Subscription<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Subscription").finish_non_exhaustive()
    }
}

/// The queues of all receivers of a data connection.
#[derive(Debug, Default)]
pub(super) struct SubscriptionQueues {
    last: u64,
    all: Vec<SubscriptionQueue>,
    /// Dropped frames of other streams.
    pub(super) skipped: u64,
}

#[derive(Debug)]
struct SubscriptionQueue {
    id: u64,
    code: u16,
    waiting: VecDeque<Result<StreamFrame, DataError>>,
    missed: u64,
}

impl SubscriptionQueue {
    fn push(&mut self, arrived: Result<StreamFrame, DataError>) {
        if self.waiting.len() >= QUEUE {
            let oldest = self.waiting.iter().position(Result::is_ok);
            self.waiting.remove(oldest.unwrap_or_default());
            self.missed += 1;
        }
        self.waiting.push_back(arrived);
    }
}

impl SubscriptionQueues {
    pub(super) fn enter(&mut self, code: u16) -> u64 {
        self.last += 1;
        self.all.push(SubscriptionQueue {
            id: self.last,
            code,
            waiting: VecDeque::new(),
            missed: 0,
        });
        self.last
    }

    fn leave(&mut self, id: u64) {
        self.all.retain(|queue| queue.id != id);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Delivers a frame to its receivers, or returns it if there are none.
    pub(super) fn offer(
        &mut self,
        arrived: Result<StreamFrame, DataError>,
    ) -> Result<(), Result<StreamFrame, DataError>> {
        let code = match &arrived {
            Ok(frame) => Some(frame.code),
            Err(DataError::Frame(error)) => error.frame().map(|frame| frame.code),
            Err(_) => None,
        };
        let mut subscriptions = self.all.iter_mut().filter(|it| Some(it.code) == code);
        let Some(first) = subscriptions.next() else {
            return Err(arrived);
        };
        for other in subscriptions {
            other.push(arrived.clone());
        }
        first.push(arrived);
        Ok(())
    }

    /// Adds a loss to all queues, because frames may be missing.
    pub(super) fn lost(&mut self, why: Loss) {
        for queue in &mut self.all {
            if !matches!(queue.waiting.back(), Some(Err(DataError::Lost(_)))) {
                queue.push(Err(DataError::Lost(why)));
            }
        }
    }

    pub(super) fn take(&mut self, id: u64) -> Option<Result<StreamFrame, DataError>> {
        self.all
            .iter_mut()
            .find(|queue| queue.id == id)?
            .waiting
            .pop_front()
    }

    fn missed_of(&mut self, id: u64) -> u64 {
        let queue = self.all.iter_mut().find(|queue| queue.id == id);
        queue.map_or(0, |queue| std::mem::take(&mut queue.missed))
    }
}
