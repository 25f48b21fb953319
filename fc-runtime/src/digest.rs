//! The algorithms by which a header says that its data has arrived undamaged.
//!
//! A header names its algorithm as a type, so that what is not needed is not compiled and nothing is chosen while
//! frames go by. Each guards against damage on the way, none against anybody's intent.

#[cfg(feature = "frames")]
pub(crate) use crate::frame::Compute;
#[cfg(not(feature = "frames"))]
pub(crate) use sealed::Compute;
use std::fmt::Debug;

/// Room for the longest digest. A shorter one takes the first bytes, and zeros follow.
pub type Sum = [u8; 16];

/// How the data area of a frame is digested. The types of this module are all there are.
#[allow(private_bounds, reason = "nobody else implements it")]
pub trait DigestAlgorithm: Compute + Copy + Debug + Default + Send + Sync + 'static {
    /// The digest of `data`.
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

/// No digest: damage is left to be found by TCP's own checksum and by the parser.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct NoDigest;

impl DigestAlgorithm for Md5 {}
impl DigestAlgorithm for Crc32 {}
impl DigestAlgorithm for NoDigest {}

#[cfg(not(feature = "frames"))]
mod sealed {
    /// Messages alone need no digest.
    pub trait Compute {}

    impl Compute for super::Md5 {}
    impl Compute for super::Crc32 {}
    impl Compute for super::NoDigest {}
}
