//! JSON text, read with its places by the rules that all products share.
//!
//! A text is looked through once for its grammar and its limits ([`check`]), and then read as the types of the spec
//! want it. So what is not JSON is `bad_json` (or past a limit) whatever else is wrong before that place, as in the
//! typed runtime.

mod number;
mod path;
mod reader;
mod write;

pub(crate) use number::{Integral, float, integral};
pub(crate) use path::path;
pub(crate) use reader::Reader;
pub(crate) use write::{write_f32, write_f64, write_string};

use crate::error::BodyError;

/// The deepest nesting that is entered, whatever the limit: it bounds the stack.
pub(crate) const MAX_DEPTH: usize = 127;

/// Checks that a text is one JSON value, nested no deeper than `depth`, with no more keys and items than `values`.
pub(crate) fn check(text: &str, depth: usize, values: usize) -> Result<(), BodyError> {
    let mut reader = Reader::within(text, depth, values);
    reader.skip_value()?;
    reader.end()
}
