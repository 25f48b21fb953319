//! What may be read.

use fc_spec::model::Model;

/// What a frame and its body may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Longest frame, header included, in bytes.
    pub frame_bytes: u32,
    /// Longest data after decompression, in bytes.
    pub inflated_bytes: u32,
    /// Most bytes that one byte of compressed JSON may become, where more than a mebibyte comes out.
    pub inflate_ratio: u32,
    /// Deepest nesting of a body; more than 127 counts as that.
    pub json_depth: usize,
    /// Most keys and items in a body, those of all levels together. Each takes up to 192 bytes as a [`Node`](crate::Node), beside
    /// its text.
    pub json_values: usize,
}

impl Limits {
    /// Those of the spec. Where it says nothing, they are those of the generated packages: a ratio of 256, and 2^20 keys
    /// and items.
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
