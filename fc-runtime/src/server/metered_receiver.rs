//! The receiving half of a robot's data connection: large frames pass the gate, and memory is asked for.

use super::budget::ConnectionMemory;
use super::gate::{Gate, LARGE, through};
use crate::frame::LONG;
use crate::protocol::Protocol;
use crate::stream::{Receiver, StreamError, StreamFrame};
use std::future::poll_fn;
use std::io;
use std::sync::Arc;
use tokio::io::AsyncRead;

/// A receiver within the bounds of a robot.
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

    /// The next frame; `None` at the end. Cancellation safe.
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

    /// The next frame that has arrived, as soon as it may be dealt with.
    async fn pass(&mut self) -> Result<Option<StreamFrame>, StreamError> {
        let receiver = &mut self.receiver;
        let taken = if let Some(work) = receiver.decoder().work(LARGE) {
            let _inflated = poll_fn(|cx| self.memory.poll_lend(cx, work.inflated)).await;
            let pass = self.gate.clone().pass().await;
            through(Some(&pass), || receiver.take())
        } else {
            receiver.take()
        };
        let decoder = receiver.decoder();
        if decoder.idle() > LONG {
            decoder.tidy();
        }
        self.memory.hold(decoder.capacity(), 0);
        taken
    }

    /// Reads once; 0 at the end of the stream. Without memory until something has come, and then with
    /// as much as there is for it.
    async fn read_on(&mut self) -> Result<usize, StreamError> {
        let decoder = self.receiver.decoder();
        if decoder.is_bare() {
            return Ok(self.receiver.begin().await?);
        }
        let bytes = decoder.growth();
        if bytes > 0 {
            poll_fn(|cx| self.memory.poll_more(cx, bytes)).await;
        }
        self.receiver.fill().await
    }

    /// Reads on to the end of the stream, and looks at nothing.
    pub(super) async fn skip_to_end(&mut self) -> io::Result<()> {
        self.receiver.skip_to_end().await
    }

    /// Bytes received since this was last asked.
    pub(super) fn take_received(&mut self) -> usize {
        self.receiver.take_received()
    }

    /// What [`Decoder::take_surplus`](crate::frame::Decoder::take_surplus) says.
    pub(super) fn take_surplus(&mut self) -> u64 {
        self.receiver.decoder().take_surplus()
    }
}
