//! The connected apps of a mock.

use fc_runtime::AckPolicy;
use std::cell::RefCell;
use std::sync::Arc;
use tokio::sync::mpsc::{Receiver, Sender, channel};

/// A report for all apps.
#[derive(Clone, Debug)]
pub(super) struct Report {
    pub(super) code: u16,
    pub(super) data: Arc<[u8]>,
    pub(super) ack: AckPolicy,
}

/// The queues of the connected apps.
pub(super) struct Apps<T> {
    queues: RefCell<Vec<Sender<T>>>,
    /// The maximum number of items that wait for one app.
    most: usize,
}

impl<T: Clone> Apps<T> {
    pub(super) fn new(most: usize) -> Self {
        Self {
            queues: RefCell::new(Vec::new()),
            most: most.max(1),
        }
    }

    /// Adds an app, which leaves when it drops the receiver.
    pub(super) fn join(&self) -> Receiver<T> {
        let (sender, receiver) = channel(self.most);
        let mut queues = self.queues.borrow_mut();
        queues.retain(|queue| !queue.is_closed());
        queues.push(sender);
        receiver
    }

    /// Sends an item to all apps. An app with a full queue misses it.
    pub(super) fn send(&self, item: &T) {
        for queue in self.queues.borrow().iter() {
            let _ = queue.try_send(item.clone());
        }
    }
}
