//! The digest over a frame's data area, in one place so that its crate can be exchanged.

use std::fmt;

/// MD5 of `data`: a checksum against damage on the way, not against anybody's intent.
#[must_use]
pub fn digest(data: &[u8]) -> [u8; 16] {
    fast_md5::digest(data)
}

/// From this length on, in bytes, data is digested in pieces: while it arrives, or while others have their
/// turn in between.
pub(crate) const LONG: usize = 64 * 1024;

/// The digest of data as far as it has come.
#[derive(Default)]
pub(crate) struct Digesting {
    state: Option<fast_md5::Md5>,
    /// Bytes.
    done: usize,
}

impl Digesting {
    /// Goes on with at most `most` bytes of `data`, of which a first part has been digested before. Gives
    /// how many it were.
    pub(crate) fn go_on(&mut self, data: &[u8], most: usize) -> usize {
        let rest = data.get(self.done..).unwrap_or_default();
        let piece = rest.get(..most).unwrap_or(rest);
        self.state
            .get_or_insert_with(fast_md5::Md5::new)
            .update(piece);
        self.done += piece.len();
        piece.len()
    }

    /// Whether all of so much data has been digested.
    #[cfg(feature = "server")]
    pub(crate) fn is_done(&self, length: usize) -> bool {
        self.done >= length
    }

    /// The digest of all of `data`.
    pub(crate) fn finish(self, data: &[u8]) -> [u8; 16] {
        match (self.state, data.get(self.done..)) {
            (Some(mut state), Some(rest)) => {
                state.update(rest);
                state.finalize()
            }
            _ => digest(data),
        }
    }
}

/// Shows how far it is: what has been digested says nothing to anybody.
impl fmt::Debug for Digesting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digesting({} bytes)", self.done)
    }
}

/// What MD5 knows after a first part, to be gone on with any number of times. The crate's own state
/// cannot be copied; RFC 1321 says what it is.
#[cfg(feature = "server")]
pub(crate) struct Midstate {
    state: [u32; 4],
    /// Behind the last whole block.
    rest: Vec<u8>,
    /// Of the first part, in bytes.
    length: u64,
}

#[cfg(feature = "server")]
impl Midstate {
    /// RFC 1321, section 3.3.
    const BEGINNING: [u32; 4] = [0x6745_2301, 0xEFCD_AB89, 0x98BA_DCFE, 0x1032_5476];
    const BLOCK: usize = 64;

    /// After `first`.
    pub(crate) fn after(first: &[u8]) -> Self {
        let mut state = Self::BEGINNING;
        let rest = Self::blocks(&mut state, first).to_vec();
        Self {
            state,
            rest,
            length: first.len() as u64,
        }
    }

    /// The digest of the first part and `last` behind it.
    pub(crate) fn digest(&self, last: &[u8]) -> [u8; 16] {
        let mut state = self.state;
        let mut end = [&self.rest, last, &[0x80]].concat();
        // Sections 3.1 and 3.2: up to a whole block with the length in bits at its end.
        let whole = (end.len() + 8).next_multiple_of(Self::BLOCK);
        end.resize(whole - 8, 0);
        let bits = (self.length + last.len() as u64).wrapping_mul(8);
        end.extend_from_slice(&bits.to_le_bytes());
        Self::blocks(&mut state, &end);
        let mut digest = [0; 16];
        for (bytes, word) in digest.chunks_exact_mut(4).zip(state) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        digest
    }

    /// Takes in all whole blocks and gives what is left.
    fn blocks<'a>(state: &mut [u32; 4], bytes: &'a [u8]) -> &'a [u8] {
        let (blocks, rest) = bytes.as_chunks::<{ Self::BLOCK }>();
        for block in blocks {
            fast_md5::transform(state, block);
        }
        rest
    }
}

#[cfg(test)]
mod tests {
    use super::{Midstate, digest};
    use md5::{Digest, Md5};

    #[fc_test::test]
    fn agrees_with_another_implementation_at_every_length_around_block_ends() {
        let data: Vec<u8> = (0..300_u16).map(|n| n.to_le_bytes()[0]).collect();
        for length in 0..data.len() {
            let (data, _) = data.split_at(length);
            let expected: [u8; 16] = Md5::digest(data).into();
            assert_eq!(digest(data), expected, "of {length} bytes");
        }
    }

    #[fc_test::test]
    fn goes_on_from_every_place_as_if_it_had_not_stopped() {
        let data: Vec<u8> = (0..200_u16).map(|n| n.to_le_bytes()[0]).collect();
        for length in 0..data.len() {
            let (data, _) = data.split_at(length);
            for first in 0..=length {
                let (first, last) = data.split_at(first);
                let midstate = Midstate::after(first);
                assert_eq!(midstate.digest(last), digest(data), "{first:?} of {length}");
                assert_eq!(midstate.digest(last), digest(data), "once more");
            }
        }
    }
}
