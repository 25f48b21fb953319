//! Recordings in MCAP: the messages as JSON for viewers, the frames as bytes, and the spec.
//!
//! | Topic | Content |
//! |---|---|
//! | `/fc/frames` | Each frame as sent, in a channel for each direction of a connection |
//! | `/NAME/request`, `/NAME/response` | Messages as JSON, with a JSON Schema |
//! | `/NAME/picture` | PNG and JPEG pictures in messages, as `foxglove.CompressedImage` |
//! | `/errors` | Errors in frames and messages, as `foxglove.Log` |

mod picture;
mod read;
mod schema;
mod write;

pub use read::{ReadError, Receiver, read};
pub use write::{Origin, Recorder};

/// The size of a chunk. A recording that ends early loses one chunk at most.
const CHUNK: usize = 64 << 10;

/// The topic of the frames.
const FRAMES: &str = "/fc/frames";

/// The metadata of a channel of frames: the addresses of sender and receiver.
const FROM: &str = "from";
const TO: &str = "to";
