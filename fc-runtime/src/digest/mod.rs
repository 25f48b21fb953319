//! Digest algorithms, by which a header detects damaged data.
//!
//! A header names its algorithm as a type. So unused algorithms are not compiled, and frames need no choice at run time.
//! The algorithms detect accidental damage, not attacks.

#[cfg(feature = "frames")]
mod compute;

#[cfg(feature = "frames")]
pub(crate) use compute::Compute;
#[cfg(not(feature = "frames"))]
pub(crate) use sealed::Compute;
use std::fmt::Debug;

/// A digest. Shorter digests take the first bytes, followed by zeros.
pub type Sum = [u8; 16];

/// A digest algorithm for the data area of a frame. Only the types of this module implement it.
#[allow(private_bounds, reason = "sealed: no other type implements it")]
pub trait DigestAlgorithm: Compute + Copy + Debug + Default + Send + Sync + 'static {
    /// Returns the digest of `data`.
    #[cfg(feature = "frames")]
    #[must_use]
    fn digest(data: &[u8]) -> Sum {
        Self::of(data)
    }
}

/// MD5 (RFC 1321).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Md5;

/// CRC-32 as in gzip, zlib and Ethernet (ISO-HDLC); most significant byte first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Crc32;

/// No digest: only the checksum of TCP and the parser detect damage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct NoDigest;

impl DigestAlgorithm for Md5 {}
impl DigestAlgorithm for Crc32 {}
impl DigestAlgorithm for NoDigest {}

#[cfg(not(feature = "frames"))]
mod sealed {
    /// Empty, because messages without frames have no digest.
    pub trait Compute {}

    impl Compute for super::Md5 {}
    impl Compute for super::Crc32 {}
    impl Compute for super::NoDigest {}
}
