//! The implementation of the algorithms, in one place so that their crates can be exchanged.

use super::{Crc32, Md5, NoDigest, Sum};

/// The implementation of an algorithm.
pub trait Compute: Sized {
    /// State after a part of the data.
    type State: Send + 'static;
    /// State after a part of the data, which can be continued any number of times.
    #[cfg(feature = "server")]
    type Midstate: Send + Sync + 'static;

    /// Returns the digest of `data`.
    fn of(data: &[u8]) -> Sum;
    /// Returns the state before any data.
    fn begin() -> Self::State;
    /// Adds data to the state.
    fn update(state: &mut Self::State, data: &[u8]);
    /// Returns the digest of all data added to the state.
    fn end(state: Self::State) -> Sum;
    /// Returns the state after `first`.
    #[cfg(feature = "server")]
    fn after(first: &[u8]) -> Self::Midstate;
    /// Returns the digest of the first part followed by `last`.
    #[cfg(feature = "server")]
    fn resume(first: &Self::Midstate, last: &[u8]) -> Sum;

    /// Returns a value that distinguishes data under equal headers: the received digest, if the protocol has one.
    fn fingerprint(sum: Sum, _data: &[u8]) -> Sum {
        sum
    }
}

impl Compute for Md5 {
    type State = fast_md5::Md5;
    #[cfg(feature = "server")]
    type Midstate = Md5Midstate;

    fn of(data: &[u8]) -> Sum {
        fast_md5::digest(data)
    }

    fn begin() -> Self::State {
        fast_md5::Md5::new()
    }

    fn update(state: &mut Self::State, data: &[u8]) {
        state.update(data);
    }

    fn end(state: Self::State) -> Sum {
        state.finalize()
    }

    #[cfg(feature = "server")]
    fn after(first: &[u8]) -> Md5Midstate {
        Md5Midstate::after(first)
    }

    #[cfg(feature = "server")]
    fn resume(first: &Md5Midstate, last: &[u8]) -> Sum {
        first.digest(last)
    }
}

impl Compute for Crc32 {
    type State = crc32fast::Hasher;
    #[cfg(feature = "server")]
    type Midstate = crc32fast::Hasher;

    fn of(data: &[u8]) -> Sum {
        crc_sum(crc32fast::hash(data))
    }

    fn begin() -> Self::State {
        crc32fast::Hasher::new()
    }

    fn update(state: &mut Self::State, data: &[u8]) {
        state.update(data);
    }

    fn end(state: Self::State) -> Sum {
        crc_sum(state.finalize())
    }

    #[cfg(feature = "server")]
    fn after(first: &[u8]) -> Self::Midstate {
        let mut state = crc32fast::Hasher::new();
        state.update(first);
        state
    }

    #[cfg(feature = "server")]
    fn resume(first: &Self::Midstate, last: &[u8]) -> Sum {
        let mut state = first.clone();
        state.update(last);
        crc_sum(state.finalize())
    }
}

fn crc_sum(crc: u32) -> Sum {
    let mut sum = Sum::default();
    if let Some(first) = sum.first_chunk_mut() {
        *first = crc.to_be_bytes();
    }
    sum
}

impl Compute for NoDigest {
    type State = ();
    #[cfg(feature = "server")]
    type Midstate = ();

    fn of(_: &[u8]) -> Sum {
        Sum::default()
    }

    fn begin() {}

    fn update((): &mut (), _: &[u8]) {}

    fn end((): ()) -> Sum {
        Sum::default()
    }

    #[cfg(feature = "server")]
    fn after(_: &[u8]) {}

    #[cfg(feature = "server")]
    fn resume((): &(), _: &[u8]) -> Sum {
        Sum::default()
    }

    /// The header contains no digest, so this computes one.
    fn fingerprint(_: Sum, data: &[u8]) -> Sum {
        Md5::of(data)
    }
}

/// The state of MD5 (RFC 1321) after a first part, which can be continued any number of times. The crate's state
/// cannot be copied.
#[cfg(feature = "server")]
pub struct Md5Midstate {
    state: [u32; 4],
    /// Bytes after the last whole block.
    rest: Vec<u8>,
    /// Length of the first part, in bytes.
    length: u64,
}

#[cfg(feature = "server")]
impl Md5Midstate {
    /// RFC 1321, section 3.3.
    const BEGINNING: [u32; 4] = [0x6745_2301, 0xEFCD_AB89, 0x98BA_DCFE, 0x1032_5476];
    const BLOCK: usize = 64;

    fn after(first: &[u8]) -> Self {
        let mut state = Self::BEGINNING;
        let rest = Self::blocks(&mut state, first).to_vec();
        Self {
            state,
            rest,
            length: first.len() as u64,
        }
    }

    /// Returns the digest of the first part followed by `last`.
    fn digest(&self, last: &[u8]) -> Sum {
        let mut state = self.state;
        let mut end = [&self.rest, last, &[0x80]].concat();
        // Sections 3.1 and 3.2: pad to a whole block that ends with the length in bits.
        let whole = (end.len() + 8).next_multiple_of(Self::BLOCK);
        end.resize(whole - 8, 0);
        let bits = (self.length + last.len() as u64).wrapping_mul(8);
        end.extend_from_slice(&bits.to_le_bytes());
        Self::blocks(&mut state, &end);
        let mut digest = Sum::default();
        for (bytes, word) in digest.chunks_exact_mut(4).zip(state) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        digest
    }

    /// Adds all whole blocks to the state and returns the remaining bytes.
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
    use super::Compute;
    use crate::digest::{Crc32, Md5, NoDigest, Sum};
    use crate::frame::Digesting;
    use md5::Digest as _;

    fn data(length: u16) -> Vec<u8> {
        (0..length).map(|n| n.to_le_bytes()[0]).collect()
    }

    #[fc_test::test]
    fn agrees_with_another_implementation_around_blocks() {
        let data = data(300);
        for length in 0..data.len() {
            let (data, _) = data.split_at(length);
            let expected: [u8; 16] = md5::Md5::digest(data).into();
            assert_eq!(Md5::of(data), expected, "of {length} bytes");
            let mut crc = flate2::Crc::new();
            crc.update(data);
            assert_eq!(
                Crc32::of(data).split_at(4),
                (&crc.sum().to_be_bytes()[..], &[0; 12][..]),
                "of {length} bytes"
            );
        }
        // The check value of the catalogue of parametrised CRC algorithms.
        assert_eq!(Crc32::of(b"123456789")[..4], [0xCB, 0xF4, 0x39, 0x26]);
    }

    #[fc_test::test]
    fn goes_on_from_every_place_as_if_it_had_not_stopped() {
        goes_on::<Md5>();
        goes_on::<Crc32>();
        goes_on::<NoDigest>();
    }

    fn goes_on<A: Compute>() {
        let data = data(200);
        for length in 0..data.len() {
            let (data, _) = data.split_at(length);
            let expected = A::of(data);
            for first in 0..=length {
                let mut digesting = Digesting::<A>::default();
                digesting.go_on(data, first);
                assert_eq!(digesting.finish(data), expected, "{first} of {length}");
                let (first, last) = data.split_at(first);
                let midstate = A::after(first);
                assert_eq!(
                    A::resume(&midstate, last),
                    expected,
                    "{first:?} of {length}"
                );
                assert_eq!(A::resume(&midstate, last), expected, "once more");
            }
        }
    }

    /// The session uses it to distinguish reports.
    #[fc_test::test]
    fn each_algorithm_distinguishes_data() {
        fn of<A: Compute>(data: &[u8]) -> Sum {
            A::fingerprint(A::of(data), data)
        }
        assert_ne!(of::<Md5>(b"one"), of::<Md5>(b"two"));
        assert_ne!(of::<Crc32>(b"one"), of::<Crc32>(b"two"));
        assert_ne!(of::<NoDigest>(b"one"), of::<NoDigest>(b"two"));
        assert_eq!(of::<NoDigest>(b"one"), of::<NoDigest>(b"one"));
    }
}
