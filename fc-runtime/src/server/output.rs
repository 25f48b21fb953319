//! Frames to be sent to an app.

use crate::frame::{Encoder, FrameError, FrameId, Unsealed};
use crate::message::{Message, write_enveloped};
use crate::protocol::Protocol;
use std::collections::VecDeque;

/// The send buffer. Only the driver's task locks it, so no task waits while a large response is encoded.
pub(super) struct Output<P: Protocol> {
    /// Frames to be written.
    pub(super) out: Vec<u8>,
    pub(super) encoder: Encoder<P>,
    /// Long frames in `out` that are not digested yet, in order.
    unsealed: VecDeque<Unsealed<P>>,
    /// The envelope of success of a certain millisecond, which many responses share.
    pub(super) success: Option<(i64, P::Response)>,
}

impl<P: Protocol> Output<P> {
    /// Creates an empty buffer.
    pub(super) fn new(encoder: Encoder<P>) -> Self {
        Self {
            out: Vec::new(),
            encoder,
            unsealed: VecDeque::new(),
            success: None,
        }
    }

    /// Appends a frame. A long frame is digested in pieces.
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

    /// Digests up to `most` further bytes of long frames, and returns their number.
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

    /// Returns `true` if all frames are complete.
    pub(super) fn is_sealed(&self) -> bool {
        self.unsealed.is_empty()
    }
}
