//! Example messages and frames, composed from the examples of the fields.
//!
//! One source for the docs' JSON, the mock's answers and the golden frames: all of them show the
//! same bytes, on every machine.
//!
//! - [`Samples`] composes the JSON of a body or of a whole message.
//! - [`sites`] says which type each place of such a JSON has.
//! - [`Path`] and [`edit`] change one place of it.
//! - [`json_cases`] are bodies at the edges of JSON, the same for every model.
//! - [`frame`] puts bytes into a frame laid out as the model says.
//!
//! **Architecture invariant.** Nothing here knows a wire fact: head bytes, offsets, byte order,
//! kinds, encodings and envelope keys all come from the model.

mod compose;
pub(crate) mod constraint;
pub mod edit;
pub mod frame;
mod gzip;
mod json_cases;
mod sites;
mod unknown;

pub use compose::{Profile, Samples};
pub use edit::{Path, Step};
pub use frame::{FrameBytes, FrameInput, SAMPLE_ID};
pub use gzip::gzip;
pub use json_cases::{JsonCase, json_cases};
pub use sites::{Site, sites};
pub use unknown::{UNKNOWN_KEY, unknown_enum_value, with_unknown_keys, with_unknown_values};

use fc_spec::model::{Model, Value};

/// What the frames of a stream carry: bytes that are neither text nor JSON.
pub const STREAM_BYTES: &[u8] = &[0x00, 0x01, 0x7B, 0x22, 0x0D, 0x0A, 0xFE, 0xFF];

/// The example of a named type: an object for a struct, a scalar for an enum. Own keys only, no
/// envelope. For many types make one [`Samples`] and ask it: this looks through all types each time.
#[must_use]
pub fn body(model: &Model, type_name: &str) -> Value {
    Samples::new(model).named(type_name, Profile::Example)
}
