//! The decoder's long-lived buffer, and bodies that leave it.

use std::fmt;
use std::ops::{Deref, Range};

/// Room that a read finds at least, in bytes.
const READ: usize = 64 * 1024;
/// Memory an empty buffer may keep for the next frame, in bytes.
const KEEP: usize = 2 * 1024 * 1024;
/// From this length on, taking the buffer along is cheaper than copying the body out of it.
const TAKE: usize = 32 * 1024;

/// Room for a rest of a frame of which so many bytes are there.
fn room(missing: usize, held: usize) -> usize {
    missing.min(held).max(READ)
}

/// Bytes of which a first part has been consumed.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    start: usize,
}

impl Buffer {
    /// Where the bytes not yet consumed begin.
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// The bytes not yet consumed.
    pub(super) fn unread(&self) -> &[u8] {
        self.bytes.get(self.start..).unwrap_or_default()
    }

    pub(super) fn get(&self, range: &Range<usize>) -> &[u8] {
        self.bytes.get(range.clone()).unwrap_or_default()
    }

    pub(super) fn capacity(&self) -> usize {
        self.bytes.capacity()
    }

    /// Consumes up to the place `end`; the bytes stay readable until the next change.
    pub(super) fn consume(&mut self, end: usize) {
        self.start = end.min(self.bytes.len());
    }

    /// The bytes to append to, with room for a good part of the `missing` rest of a frame.
    ///
    /// A rest that has only been announced gets as much room as there are bytes already: a peer
    /// pays for memory with what it sends.
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

    /// How much memory [`room`](Self::room) would take beyond what there is, in bytes.
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

    /// Begins with these bytes and takes no more memory than they do. Nothing unread must be there.
    #[cfg(feature = "server")]
    pub(super) fn begin(&mut self, bytes: &[u8]) {
        *self = Self {
            bytes: bytes.to_vec(),
            start: 0,
        };
    }

    /// Gives back the memory of bytes that have all been consumed.
    #[cfg(feature = "server")]
    pub(super) fn tidy(&mut self) {
        if self.unread().is_empty() {
            *self = Self::default();
        }
    }

    /// The emptied bytes, to be filled with something new.
    pub(super) fn replace(&mut self) -> &mut Vec<u8> {
        self.start = 0;
        if self.bytes.capacity() > KEEP {
            self.bytes = Vec::new();
        }
        self.bytes.clear();
        &mut self.bytes
    }

    /// Empties the bytes if they take more memory than may be kept.
    pub(super) fn release(&mut self) {
        if self.bytes.capacity() > KEEP {
            *self = Self::default();
        }
    }

    /// Lets the bytes of `range` leave: small ones as a copy, large ones by giving the whole buffer
    /// away and going on in `spare`.
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

/// A body that has left the decoder. Reads as `[u8]`.
#[derive(Clone, Default)]
pub struct Body {
    bytes: Vec<u8>,
    range: Range<usize>,
}

impl Body {
    /// The bytes alone. Moves them to the front if they are not there.
    #[must_use]
    pub fn into_vec(mut self) -> Vec<u8> {
        self.bytes.truncate(self.range.end);
        self.bytes.drain(..self.range.start);
        self.bytes
    }

    /// The memory that it takes, in bytes.
    #[cfg(feature = "server")]
    pub(crate) fn memory(&self) -> usize {
        self.bytes.capacity()
    }

    /// The memory behind a large body, of use as the next buffer; `None` for a small one.
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

/// Shows the length alone: bodies may hold what must not be logged.
impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Body({} bytes)", self.range.len())
    }
}
