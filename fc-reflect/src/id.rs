//! What a frame belongs to.

use fc_spec::model::Direction;
use std::fmt;

/// Which message a frame belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameId {
    /// Which head the frame opens with.
    pub direction: Direction,
    /// Kind of the data.
    pub kind: u8,
    /// Command code.
    pub code: u16,
    /// Message id.
    pub id: u32,
}

impl FrameId {
    /// The id of an answer to this frame: it echoes everything but the head.
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
