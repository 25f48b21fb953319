//! What a reader is asked where it has come to a halt; see [`fields`](super::fields).

use super::error::BodyError;
use std::borrow::Cow;

/// Why a reader is at the end of the text while fields are named to it.
#[derive(Clone, Debug)]
pub(super) enum Halt<'a> {
    /// It does not.
    No,
    /// A value could not be read.
    Fault(BodyError),
    /// Whose is this key, of which a field's name was not found in the text? It may be unknown, or
    /// spelled in an unusual way.
    Key {
        key: Cow<'a, str>,
        /// Where its value stands.
        value: usize,
        /// Whether it may be kept as an unknown one.
        keep: bool,
    },
    /// Which required fields are not among these keys?
    Lacking {
        present: &'a [Cow<'a, str>],
        lacking: Vec<&'static str>,
    },
}
