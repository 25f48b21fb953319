//! MAVLink 2, the peer for the cost per byte on the wire. Its messages are packed structs.

use mavlink::dialects::common::{MavMessage, ODOMETRY_DATA};
use mavlink::{MavHeader, MavlinkReader, MavlinkVersion, write_v2_msg};
use std::io::Read;

/// Returns a message about as long as a small frame.
pub fn message() -> MavMessage {
    let mut data = ODOMETRY_DATA { time_usec: 1_667_823_500_544, x: 0.5, y: 0.6, z: 0.2, ..ODOMETRY_DATA::default() };
    for (index, value) in data.pose_covariance.iter_mut().chain(&mut data.velocity_covariance).enumerate() {
        *value = index as f32 + 0.5;
    }
    MavMessage::ODOMETRY(data)
}

/// Appends a message to `out`.
pub fn write(message: &MavMessage, out: &mut Vec<u8>) {
    write_v2_msg(out, MavHeader::default(), message).expect("a message can be written");
}

/// A reader that repeats its bytes endlessly.
pub struct Endless {
    bytes: Vec<u8>,
    at: usize,
}

impl Endless {
    /// Creates a reader that repeats `bytes`.
    pub fn new(bytes: Vec<u8>) -> Self {
        Self { bytes, at: 0 }
    }
}

impl Read for Endless {
    fn read(&mut self, target: &mut [u8]) -> std::io::Result<usize> {
        let rest = &self.bytes[self.at..];
        let length = rest.len().min(target.len());
        target[..length].copy_from_slice(&rest[..length]);
        self.at = (self.at + length) % self.bytes.len();
        Ok(length)
    }
}

/// Reads the next message.
pub fn read(reader: &mut MavlinkReader<Endless>) -> MavMessage {
    reader.read_message::<MavMessage>(MavlinkVersion::V2).expect("a message can be read").1
}
