//! The header fields that identify the message of a frame.

use fc_spec::model::Direction;
use std::fmt;

/// Identifies the message of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameId {
    /// The head that the frame begins with.
    pub direction: Direction,
    /// The kind of the data.
    pub kind: u8,
    /// The command code.
    pub code: u16,
    /// The message id.
    pub id: u32,
}

impl FrameId {
    /// Returns the id of a response to this frame. Only the head differs.
    #[must_use]
    pub fn answer(self) -> Self {
        Self {
            direction: Direction::Response,
            ..self
        }
    }
}

impl fmt::Display for FrameId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of kind 0x{:02X}, code 0x{:04X}, id {}",
            self.direction.name(),
            self.kind,
            self.code,
            self.id
        )
    }
}
