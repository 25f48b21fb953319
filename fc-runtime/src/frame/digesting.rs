//! The digest of a long frame, computed in pieces.

use crate::digest::{Compute, Sum};
use std::fmt;
use std::marker::PhantomData;

/// Data of at least this many bytes is digested in pieces: while it arrives, or with pauses for other tasks.
pub(crate) const LONG: usize = 64 * 1024;

/// A digest that is computed piece by piece.
pub(crate) struct Digesting<A: Compute> {
    /// Set for long frames only. Boxed, because most frames are short and this struct is moved with each of them.
    state: Option<Box<A::State>>,
    /// Digested bytes.
    done: usize,
    algorithm: PhantomData<A>,
}

impl<A: Compute> Default for Digesting<A> {
    fn default() -> Self {
        Self {
            state: None,
            done: 0,
            algorithm: PhantomData,
        }
    }
}

impl<A: Compute> Digesting<A> {
    /// Digests up to `most` further bytes of `data` and returns their number. `data` begins with the bytes digested
    /// before.
    pub(crate) fn go_on(&mut self, data: &[u8], most: usize) -> usize {
        let rest = data.get(self.done..).unwrap_or_default();
        let piece = rest.get(..most).unwrap_or(rest);
        let state = self.state.get_or_insert_with(|| Box::new(A::begin()));
        A::update(state, piece);
        self.done += piece.len();
        piece.len()
    }

    /// Returns `true` if at least `length` bytes have been digested.
    #[cfg(feature = "server")]
    pub(crate) fn is_done(&self, length: usize) -> bool {
        self.done >= length
    }

    /// Returns the digest of all of `data`.
    #[inline]
    pub(crate) fn finish(self, data: &[u8]) -> Sum {
        match (self.state, data.get(self.done..)) {
            (Some(mut state), Some(rest)) => {
                A::update(&mut state, rest);
                A::end(*state)
            }
            _ => A::of(data),
        }
    }
}

/// Shows the number of digested bytes only.
impl<A: Compute> fmt::Debug for Digesting<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digesting({} bytes)", self.done)
    }
}
