//! The events of the main loop.

use crate::snapshot::Snapshot;
use lsp_server::{Message, Response};
use std::sync::Arc;

/// An event of the loop.
pub(crate) enum Event {
    /// A message of the client.
    Message(Message),
    /// The worker has checked a snapshot.
    Checked(Arc<Snapshot>),
    /// The worker has also compared the snapshot with the last release.
    Compared(Arc<Snapshot>),
    /// The worker has answered a request.
    Answered(Response),
    /// The client is gone, or the worker thread has ended.
    End,
}
