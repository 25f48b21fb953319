//! The bytes in front of every frame, and the limits of its data. This module knows no messages.

use crate::digest::{DigestAlgorithm, Sum};
use crate::json::Allowance;

/// The fixed bytes in front of the data area of every frame.
///
/// `#[derive(Header)]` implements it from the fields of a struct.
pub trait Header: Copy + Send + Sync + 'static {
    /// Digest algorithm of the data.
    type Digest: DigestAlgorithm;

    /// Length in bytes.
    const LEN: usize;
    /// Number of bytes that [`peek_total_length`](Self::peek_total_length) needs.
    const TOTAL_LENGTH_END: usize;
    /// Largest message id: `u16::MAX` or `u32::MAX`.
    const ID_MAX: u32;

    /// Reads a header from the start of `bytes`. Returns `None` if there are fewer than [`LEN`](Self::LEN) bytes.
    fn read(bytes: &[u8]) -> Option<Self>;
    /// Writes [`LEN`](Self::LEN) bytes to the start of `out`. If `out` is shorter, writes nothing and returns `false`.
    fn write(&self, out: &mut [u8]) -> bool;
    /// Returns the total length of the frame at the start of `bytes`, or `None` if that field is incomplete.
    fn peek_total_length(bytes: &[u8]) -> Option<u32>;

    /// Creates a header. All other fields have their constant value; lengths and digest are zero until
    /// [`seal`](Self::seal).
    ///
    /// A value without a field is dropped. An id above [`ID_MAX`](Self::ID_MAX) is cut to its low bits.
    fn new(head: &'static [u8], kind: u8, code: u16, id: u32, encoding: u8) -> Self;
    /// Sets the length of the whole frame, the length of the data before compression, and the digest of the data as
    /// sent.
    fn seal(&mut self, total_length: u32, plain_length: u32, digest: Sum);

    /// Returns the first bytes of the frame.
    fn head(&self) -> &[u8];
    /// Returns the kind of the data.
    fn kind(&self) -> u8;
    /// Returns the command code.
    fn code(&self) -> u16;
    /// Returns the message id.
    fn id(&self) -> u32;
    /// Returns the encoding of the data, or 0 if the header has no field for it.
    fn encoding(&self) -> u8;
    /// Returns the length of the whole frame in bytes, header included.
    fn total_length(&self) -> u32;
    /// Returns the length of the data before compression, in bytes. Without a field for it, returns the length of the
    /// data as sent.
    fn plain_length(&self) -> u32;
    /// Returns the digest of the data as sent, or zeros if the header has no field for it.
    fn digest(&self) -> Sum;
}

/// Limits of everything that grows with the data of a peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Longest frame in bytes, header included.
    pub frame_bytes: u32,
    /// Longest data after decompression, in bytes.
    pub inflated_bytes: u32,
    /// Largest ratio of decompressed to compressed bytes. It applies only to JSON, and only above
    /// [`INFLATE_FREE`](Self::INFLATE_FREE) decompressed bytes; a picture may be blank.
    pub inflate_ratio: u32,
    /// Deepest nesting of a JSON body.
    pub json_depth: usize,
    /// Largest number of object keys and list items in a JSON body, on all levels together.
    pub json_values: usize,
    /// Largest memory for the items of all lists in a JSON body, in bytes.
    pub json_list_bytes: usize,
    /// Calls in flight on one connection.
    pub in_flight: usize,
    /// Reports waiting for one connection.
    pub queued_reports: usize,
    /// Connections of one server.
    pub connections: usize,
}

impl Limits {
    /// Default of `inflate_ratio`: 256. Deflate reaches 1,030 with endless repetition. Lists of objects that differ
    /// only in a number reach 20 to 250.
    pub const INFLATE_RATIO: u32 = 256;
    /// Decompressed size up to which any ratio is accepted: 1 MiB. A scan or grid of zeros is not longer.
    pub const INFLATE_FREE: u32 = 1 << 20;
    /// Default of `json_values`: 1,048,576.
    pub const JSON_VALUES: usize = Allowance::DEFAULT.values;
    /// Default of `json_list_bytes`: 32 MiB.
    pub const JSON_LIST_BYTES: usize = Allowance::DEFAULT.list_bytes;

    /// Returns the allowance for one JSON body.
    #[must_use]
    pub const fn json(&self) -> Allowance {
        Allowance {
            depth: self.json_depth,
            values: self.json_values,
            list_bytes: self.json_list_bytes,
        }
    }
}
