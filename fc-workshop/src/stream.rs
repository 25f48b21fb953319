//! Cuts received bytes into frames.

use fc_reflect::{Frame, FrameError, Reflector};

/// Room for one read, in bytes.
const READ: usize = 16 * 1024;

/// The received bytes of one direction of a connection.
///
/// It holds at most one frame of the maximum length and one read, because a longer frame is an error at once.
#[derive(Debug, Default)]
pub struct FrameStream {
    received: Vec<u8>,
    /// The number of bytes of returned frames at the start of `received`.
    taken: usize,
}

/// The next piece of a stream.
#[derive(Debug)]
pub struct Piece<'m> {
    /// The bytes of the frame.
    pub bytes: Vec<u8>,
    /// The frame, or the error in it. The next frame begins after its bytes.
    pub frame: Result<Frame<'m>, FrameError>,
}

impl FrameStream {
    /// Returns the buffer for appending received bytes, with room for a read. Only append to it.
    pub fn room(&mut self) -> &mut Vec<u8> {
        self.received.drain(..self.taken);
        self.taken = 0;
        self.received.reserve(READ);
        &mut self.received
    }

    /// Returns the bytes that are not part of a returned frame.
    #[must_use]
    pub fn rest(&self) -> &[u8] {
        self.received.get(self.taken..).unwrap_or_default()
    }

    /// Takes the next frame. Returns `None` until all of its bytes have arrived.
    ///
    /// # Errors
    /// `bad_head`, `frame_too_long` or `short_frame`. The start of the next frame is then unknown.
    pub fn next<'m>(&mut self, reflector: &Reflector<'m>) -> Result<Option<Piece<'m>>, FrameError> {
        let rest = self.rest();
        if rest.is_empty() {
            return Ok(None);
        }
        let length = reflector.length(rest)?;
        let Some(bytes) = length.and_then(|length| rest.get(..length)) else {
            return Ok(None);
        };
        let piece = Piece {
            bytes: bytes.to_vec(),
            frame: reflector.frame(bytes),
        };
        self.taken += piece.bytes.len();
        Ok(Some(piece))
    }
}
