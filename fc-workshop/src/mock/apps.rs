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

/// The queues of reports, one for each connected app.
pub(super) struct Apps {
    queues: RefCell<Vec<Sender<Report>>>,
    /// The maximum number of reports that wait for one app.
    most: usize,
}

impl Apps {
    pub(super) fn new(most: usize) -> Self {
        Self {
            queues: RefCell::default(),
            most: most.max(1),
        }
    }

    /// Adds an app, which leaves when it drops the receiver.
    pub(super) fn join(&self) -> Receiver<Report> {
        let (sender, receiver) = channel(self.most);
        let mut queues = self.queues.borrow_mut();
        queues.retain(|queue| !queue.is_closed());
        queues.push(sender);
        receiver
    }

    /// Sends a report to all apps. An app with a full queue misses it.
    pub(super) fn send(&self, report: &Report) {
        for queue in self.queues.borrow().iter() {
            let _ = queue.try_send(report.clone());
        }
    }
}
