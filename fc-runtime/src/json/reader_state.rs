//! The state of a reader while fields are named to it; see [`fields`](super::fields).

use super::error::BodyError;
use std::borrow::Cow;

/// The state of a reader.
#[derive(Clone, Debug)]
pub(super) enum ReaderState<'a> {
    /// Reads fields at its position.
    Reading,
    /// Stopped, because a value could not be read.
    Failed(BodyError),
    /// Stopped, to find the field of this key. No field name matched the text: the key may be unknown or spelled with
    /// escapes.
    KeySearch {
        key: Cow<'a, str>,
        /// Offset of its value.
        value: usize,
        /// `true` if it may be kept as an unknown key.
        keep: bool,
    },
    /// Stopped, to collect the required fields that are not among these keys.
    LackingKeys {
        present: &'a [Cow<'a, str>],
        lacking: Vec<&'static str>,
    },
}
