//! Limits for reading.

use fc_spec::model::Model;

/// The limits of a frame and its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The maximum length of a frame with its header, in bytes.
    pub frame_bytes: u32,
    /// The maximum length of decompressed data, in bytes.
    pub inflated_bytes: u32,
    /// The maximum compression ratio of JSON. It applies if the data is larger than one mebibyte.
    pub inflate_ratio: u32,
    /// The maximum nesting of a body. Values above 127 count as 127.
    pub json_depth: usize,
    /// The maximum number of keys and items in a body, on all levels together. Each takes up to 192 bytes as a
    /// [`Node`](crate::Node), in addition to its text.
    pub json_values: usize,
}

impl Limits {
    /// Returns the limits of the spec. The spec defines neither `inflate_ratio` nor `json_values`. They are 256 and
    /// 2^20, as in the generated packages.
    #[must_use]
    pub fn of(model: &Model) -> Self {
        Self {
            frame_bytes: model.limits.frame_bytes,
            inflated_bytes: model.limits.inflated_bytes,
            inflate_ratio: 256,
            json_depth: usize::try_from(model.limits.json_depth).unwrap_or(usize::MAX),
            json_values: 1 << 20,
        }
    }
}
