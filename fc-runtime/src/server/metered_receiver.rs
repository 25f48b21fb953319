//! The receiving half of a robot's data connection, with limits on memory and large frames.

use super::budget::ConnectionMemory;
use super::gate::{Gate, LARGE, process_frame};
use crate::frame::LONG;
use crate::protocol::Protocol;
use crate::stream::{Receiver, StreamError, StreamFrame};
use std::future::poll_fn;
use std::io;
use std::sync::Arc;
use tokio::io::AsyncRead;

/// A receiver that reserves memory, and passes the gate for large frames.
pub(super) struct MeteredReceiver<R, P: Protocol> {
    receiver: Receiver<R, P>,
    gate: Gate,
    memory: Arc<ConnectionMemory>,
}

impl<R: AsyncRead + Unpin, P: Protocol> MeteredReceiver<R, P> {
    pub(super) fn new(receiver: Receiver<R, P>, gate: Gate, memory: Arc<ConnectionMemory>) -> Self {
        Self {
            receiver,
            gate,
            memory,
        }
    }

    /// Returns the next frame, or `None` at the end. Cancellation safe.
    pub(super) async fn recv(&mut self) -> Result<Option<StreamFrame>, StreamError> {
        loop {
            if let Some(frame) = self.pass().await? {
                return Ok(Some(frame));
            }
            if self.read_on().await? == 0 {
                self.receiver.decoder().finish()?;
                return Ok(None);
            }
        }
    }

    /// Returns the next complete frame, after the gate if it is large.
    async fn pass(&mut self) -> Result<Option<StreamFrame>, StreamError> {
        let receiver = &mut self.receiver;
        let taken = if let Some(work) = receiver.decoder().work(LARGE) {
            let _inflated = poll_fn(|cx| self.memory.poll_lend(cx, work.inflated)).await;
            let pass = self.gate.clone().pass().await;
            process_frame(Some(&pass), || receiver.take())
        } else {
            receiver.take()
        };
        let decoder = receiver.decoder();
        if decoder.idle() > LONG {
            decoder.tidy();
        }
        self.memory.update(decoder.capacity(), 0);
        taken
    }

    /// Reads once. Returns 0 at the end of the stream. Memory is reserved only after bytes have arrived.
    async fn read_on(&mut self) -> Result<usize, StreamError> {
        let decoder = self.receiver.decoder();
        if decoder.is_bare() {
            return Ok(self.receiver.begin().await?);
        }
        let bytes = decoder.growth();
        if bytes > 0 {
            poll_fn(|cx| self.memory.poll_grow(cx, bytes)).await;
        }
        self.receiver.fill().await
    }

    /// Reads and drops everything up to the end of the stream.
    pub(super) async fn skip_to_end(&mut self) -> io::Result<()> {
        self.receiver.skip_to_end().await
    }

    /// Returns the number of bytes received since the last call.
    pub(super) fn take_received(&mut self) -> usize {
        self.receiver.take_received()
    }

    /// Calls [`Decoder::take_surplus`](crate::frame::Decoder::take_surplus).
    pub(super) fn take_surplus(&mut self) -> u64 {
        self.receiver.decoder().take_surplus()
    }
}
