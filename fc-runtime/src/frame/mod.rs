//! The frame codec, which converts bytes to frames and back, without I/O.
//!
//! ```text
//! bytes ──► Decoder ──► Frame (borrowed body) │ FrameError
//! body  ──► Encoder ──► bytes behind whatever the buffer already holds
//! ```
//!
//! **Architecture invariant:** layout and numbers of the header come from [`Protocol`]. This module only assumes that a
//! frame is a header of fixed length followed by the data, and that the head is the first field of the header.

mod buffer;
mod decoder;
mod digesting;
mod encoder;
mod error;
mod gzip;
#[cfg(feature = "server")]
mod prepared_response;

pub use buffer::Body;
pub use decoder::Decoder;
#[cfg(feature = "server")]
pub(crate) use decoder::Work;
#[cfg(test)]
pub(crate) use digesting::Digesting;
#[cfg(any(feature = "client", feature = "server"))]
pub(crate) use digesting::LONG;
#[cfg(feature = "client")]
pub(crate) use encoder::Staged;
#[cfg(feature = "server")]
pub(crate) use encoder::Unsealed;
pub use encoder::{Encoder, Gzip, Prepared};
pub use error::{FrameError, FrameId};
#[doc(hidden)]
pub use gzip::{Deflater, InflateError, Inflater};
#[cfg(feature = "server")]
pub(crate) use prepared_response::PreparedBody;
#[cfg(feature = "server")]
pub use prepared_response::PreparedResponse;

use crate::protocol::Protocol;
use buffer::Buffer;
use std::fmt;
use std::ops::Range;

/// A frame. Its body is in the buffer of the decoder.
pub struct Frame<'a, P: Protocol> {
    /// The header as received.
    pub header: P::Header,
    buffer: &'a mut Buffer,
    range: Range<usize>,
}

impl<'a, P: Protocol> Frame<'a, P> {
    fn new(header: P::Header, buffer: &'a mut Buffer, range: Range<usize>) -> Self {
        Self {
            header,
            buffer,
            range,
        }
    }

    /// Returns the id of the frame.
    #[must_use]
    pub fn id(&self) -> FrameId {
        FrameId::of::<P>(&self.header)
    }

    /// Returns the decompressed data.
    #[must_use]
    pub fn body(&self) -> &[u8] {
        self.buffer.get(&self.range)
    }

    /// Takes the data out of the decoder.
    #[must_use]
    pub fn into_body(self) -> Body {
        self.buffer.take(self.range, &mut Vec::new())
    }

    /// Takes the data out of the decoder. The decoder may continue with the memory of `spare`.
    #[cfg(feature = "client")]
    pub(crate) fn into_body_for(self, spare: &mut Vec<u8>) -> Body {
        self.buffer.take(self.range, spare)
    }
}

/// Does not show the data, because bodies may contain data that must not be logged.
impl<P: Protocol> fmt::Debug for Frame<'_, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Frame({}, {} bytes)", self.id(), self.range.len())
    }
}
