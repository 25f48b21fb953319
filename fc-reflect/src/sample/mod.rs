//! Composes messages and frames from the examples of the spec.
//!
//! The JSON in docs, the golden frames and the simulated answers of a robot agree, because all come from here.
//! [`Samples`] composes the JSON of a body or a message. The [`Reflector`](crate::Reflector) puts it into a frame or
//! answers a frame with it. [`constraint`] has the limits of a field's values.

mod compose;
pub mod constraint;

pub use compose::{Profile, Samples};

/// A message id for samples. An app with clock-based ids has it at 09:08:42.323.
pub const SAMPLE_ID: u32 = 90_842_323;

/// The sample data of a stream: bytes that are neither text nor JSON.
pub const STREAM_BYTES: &[u8] = &[0x00, 0x01, 0x7B, 0x22, 0x0D, 0x0A, 0xFE, 0xFF];
