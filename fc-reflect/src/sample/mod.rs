//! Messages made up from the examples of the spec, and frames of them.
//!
//! One source for the docs' JSON, the golden frames and the answers of a robot that is not there: all of them show the
//! same. [`Samples`] composes the JSON of a body or of a whole message; the [`Reflector`](crate::Reflector) puts it into
//! a frame, or answers a frame with it. What a field takes, and the edges of it, is in [`constraint`].

mod compose;
pub mod constraint;

pub use compose::{Profile, Samples};

/// A message id for samples: what the clock-based ids of an app are at 09:08:42.323.
pub const SAMPLE_ID: u32 = 90_842_323;

/// What the sample of a stream carries: bytes that are neither text nor JSON.
pub const STREAM_BYTES: &[u8] = &[0x00, 0x01, 0x7B, 0x22, 0x0D, 0x0A, 0xFE, 0xFF];
