//! The buffer of the decoder, and bodies that have left it.

use std::fmt;
use std::ops::{Deref, Range};

/// Minimum room for a read, in bytes.
const READ: usize = 64 * 1024;
/// Memory that an empty buffer may keep for the next frame, in bytes.
const KEEP: usize = 2 * 1024 * 1024;
/// Length from which moving the buffer is cheaper than copying the body, in bytes.
const TAKE: usize = 32 * 1024;

/// Returns the room for the rest of a frame. `missing` bytes are announced and `held` bytes have arrived.
fn room(missing: usize, held: usize) -> usize {
    missing.min(held).max(READ)
}

/// Bytes with a consumed part at the front.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    start: usize,
}

impl Buffer {
    /// Returns the offset of the first unconsumed byte.
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// Returns the unconsumed bytes.
    pub(super) fn unread(&self) -> &[u8] {
        self.bytes.get(self.start..).unwrap_or_default()
    }

    pub(super) fn get(&self, range: &Range<usize>) -> &[u8] {
        self.bytes.get(range.clone()).unwrap_or_default()
    }

    pub(super) fn capacity(&self) -> usize {
        self.bytes.capacity()
    }

    /// Consumes the bytes up to `end`. They stay readable until the next change.
    pub(super) fn consume(&mut self, end: usize) {
        self.start = end.min(self.bytes.len());
    }

    /// Returns the buffer for appending received bytes, with room for a part of the `missing` bytes of a frame.
    ///
    /// A frame gets room for at most as many bytes as have arrived. So a peer must send bytes before it gets memory.
    pub(super) fn room(&mut self, missing: usize) -> &mut Vec<u8> {
        if self.start == self.bytes.len() {
            self.bytes.clear();
            self.start = 0;
            if self.bytes.capacity() > KEEP {
                self.bytes = Vec::new();
            }
        }
        if self.bytes.capacity() - self.bytes.len() < READ / 2 {
            self.bytes.drain(..self.start);
            self.start = 0;
            self.bytes.reserve_exact(room(missing, self.bytes.len()));
        }
        &mut self.bytes
    }

    /// Returns the memory that [`room`](Self::room) would add, in bytes.
    #[cfg(feature = "server")]
    pub(super) fn growth(&self, missing: usize) -> usize {
        let unread = self.unread().len();
        let (kept, used) = match unread {
            0 if self.bytes.capacity() > KEEP => (0, 0),
            0 => (self.bytes.capacity(), 0),
            _ => (self.bytes.capacity(), self.bytes.len()),
        };
        if kept - used >= READ / 2 {
            return 0;
        }
        (unread + room(missing, unread)).saturating_sub(kept)
    }

    /// Starts with these bytes and takes only as much memory. The buffer must have no unread bytes.
    #[cfg(feature = "server")]
    pub(super) fn begin(&mut self, bytes: &[u8]) {
        *self = Self {
            bytes: bytes.to_vec(),
            start: 0,
        };
    }

    /// Releases the memory if all bytes have been consumed.
    #[cfg(feature = "server")]
    pub(super) fn tidy(&mut self) {
        if self.unread().is_empty() {
            *self = Self::default();
        }
    }

    /// Empties the buffer and returns it for new bytes.
    pub(super) fn replace(&mut self) -> &mut Vec<u8> {
        self.start = 0;
        if self.bytes.capacity() > KEEP {
            self.bytes = Vec::new();
        }
        self.bytes.clear();
        &mut self.bytes
    }

    /// Releases the memory if it is more than may be kept.
    pub(super) fn release(&mut self) {
        if self.bytes.capacity() > KEEP {
            *self = Self::default();
        }
    }

    /// Takes the bytes of `range` out of the buffer. Small bodies are copied. For a large body the whole buffer is
    /// given away, and the decoder continues in `spare`.
    pub(super) fn take(&mut self, range: Range<usize>, spare: &mut Vec<u8>) -> Body {
        if range.len() < TAKE {
            let bytes = self.get(&range).to_vec();
            return Body {
                range: 0..bytes.len(),
                bytes,
            };
        }
        let mut next = std::mem::take(spare);
        next.clear();
        next.extend_from_slice(self.unread());
        self.start = 0;
        Body {
            bytes: std::mem::replace(&mut self.bytes, next),
            range,
        }
    }
}

/// A body outside the decoder. Dereferences to `[u8]`.
#[derive(Clone, Default)]
pub struct Body {
    bytes: Vec<u8>,
    range: Range<usize>,
}

impl Body {
    /// Returns the bytes as a vector. Moves them to its front if necessary.
    #[must_use]
    pub fn into_vec(mut self) -> Vec<u8> {
        self.bytes.truncate(self.range.end);
        self.bytes.drain(..self.range.start);
        self.bytes
    }

    /// Returns the memory of the body, in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn memory(&self) -> usize {
        self.bytes.capacity()
    }

    /// Returns the memory of a large body for use as the next buffer, or `None` for a small one.
    #[cfg(feature = "client")]
    pub(crate) fn into_spare(self) -> Option<Vec<u8>> {
        (TAKE..=KEEP)
            .contains(&self.bytes.capacity())
            .then_some(self.bytes)
    }
}

impl Deref for Body {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.bytes.get(self.range.clone()).unwrap_or_default()
    }
}

impl From<Vec<u8>> for Body {
    fn from(bytes: Vec<u8>) -> Self {
        Self {
            range: 0..bytes.len(),
            bytes,
        }
    }
}

impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for Body {}

/// Shows only the length, because bodies may contain data that must not be logged.
impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Body({} bytes)", self.range.len())
    }
}
