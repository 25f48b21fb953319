//! The limits of one text that is read.

use super::MAX_DEPTH;

/// The limits of one text that is read. [`Limits::json`](crate::Limits::json) creates it from the limits of a protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowance {
    /// Levels of nesting. Values above [`MAX_DEPTH`] count as [`MAX_DEPTH`].
    pub depth: usize,
    /// Number of object keys and list items on all levels together.
    pub values: usize,
    /// Memory for the items of all lists, in bytes. The text `{}` is short, but a message without required keys that is
    /// read from it may be large.
    pub list_bytes: usize,
}

impl Allowance {
    /// The default: the deepest nesting, 1,048,576 keys and items, and 32 MiB for the items of lists. No known message
    /// needs more.
    pub const DEFAULT: Self = Self {
        depth: MAX_DEPTH,
        values: 1 << 20,
        list_bytes: 32 << 20,
    };

    /// No limits but the nesting, for trusted texts and for values that are kept as text.
    pub const ANY: Self = Self {
        depth: MAX_DEPTH,
        values: usize::MAX,
        list_bytes: usize::MAX,
    };

    /// Returns the default with this depth.
    #[must_use]
    pub const fn depth(depth: usize) -> Self {
        Self {
            depth,
            ..Self::DEFAULT
        }
    }
}

impl Default for Allowance {
    fn default() -> Self {
        Self::DEFAULT
    }
}
