//! What reading one text may cost.

use super::MAX_DEPTH;

/// What reading one text may cost. [`Limits::json`](crate::Limits::json) makes it of a protocol's limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowance {
    /// Levels of nesting; more than [`MAX_DEPTH`] count as that.
    pub depth: usize,
    /// Keys of objects and items of lists, those of all levels together.
    pub values: usize,
    /// Memory for the items of lists, those of all levels together, in bytes: `{}` is short, and a
    /// message without required keys that is read from it may be large.
    pub list_bytes: usize,
}

impl Allowance {
    /// What no message that people have thought of needs: the deepest nesting, a million keys and
    /// items (1,048,576), and 32 MiB for the items of lists.
    pub const DEFAULT: Self = Self {
        depth: MAX_DEPTH,
        values: 1 << 20,
        list_bytes: 32 << 20,
    };

    /// Whatever the text holds: for one that is trusted, or of which nothing is kept but the text.
    pub const ANY: Self = Self {
        depth: MAX_DEPTH,
        values: usize::MAX,
        list_bytes: usize::MAX,
    };

    /// The default, but no deeper than this.
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
