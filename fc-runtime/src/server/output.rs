//! The frames that are to be written to an app.

use crate::frame::{Encoder, FrameError, FrameId, Unsealed};
use crate::message::{Message, write_enveloped};
use crate::protocol::Protocol;
use std::collections::VecDeque;

/// What is to be sent. Only the driver's task locks it: nobody waits while a large answer is encoded.
pub(super) struct Output<P: Protocol> {
    /// Frames to be written.
    pub(super) out: Vec<u8>,
    pub(super) encoder: Encoder<P>,
    /// Long frames in `out` that are not digested yet, in their order.
    unsealed: VecDeque<Unsealed<P>>,
    /// The envelope of success as of a certain millisecond: many answers share one.
    pub(super) success: Option<(i64, P::Response)>,
}

impl<P: Protocol> Output<P> {
    /// With nothing to be sent.
    pub(super) fn new(encoder: Encoder<P>) -> Self {
        Self {
            out: Vec::new(),
            encoder,
            unsealed: VecDeque::new(),
            success: None,
        }
    }

    /// Appends a frame; a long one is digested bit by bit.
    pub(super) fn append<E: Message, B: Message>(
        &mut self,
        id: FrameId,
        envelope: &E,
        body: &B,
    ) -> Result<(), FrameError> {
        let write = |out: &mut Vec<u8>| write_enveloped(envelope, body, out);
        let unsealed = self.encoder.unsealed(&mut self.out, id, write)?;
        self.unsealed.extend(unsealed);
        Ok(())
    }

    /// Digests at most so many bytes more of what is long, and gives how many it were.
    pub(super) fn seal(&mut self, most: usize) -> usize {
        let mut done = 0;
        while let Some(first) = self.unsealed.front_mut() {
            done += first.go_on(&self.out, most - done);
            if !first.is_digested() {
                break;
            }
            if let Some(first) = self.unsealed.pop_front() {
                first.seal(&mut self.out);
            }
        }
        done
    }

    /// Whether all of it may be sent.
    pub(super) fn is_sealed(&self) -> bool {
        self.unsealed.is_empty()
    }
}
