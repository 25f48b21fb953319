//! Reads the TCP connections in captures of network packets, and the frames in recordings.
//!
//! ```text
//! pcap, pcapng ──file──►
//!                        packets ──packet──► segments ──tcp──► bytes of each direction
//! tcpdump text ──text──►
//! MCAP ──mcap──► frames of each direction
//! ```

mod file;
#[cfg(feature = "record")]
pub mod mcap;
mod packet;
mod tcp;
mod text;

pub use file::read as read_file;
pub use packet::Ports;
pub use tcp::Seen;
pub use text::read as read_text;

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;

/// A direction of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Flow {
    /// The sender.
    pub from: SocketAddr,
    /// The receiver.
    pub to: SocketAddr,
}

impl Flow {
    /// Returns the other direction of the connection.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self {
            from: self.to,
            to: self.from,
        }
    }
}

impl fmt::Display for Flow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} > {}", self.from, self.to)
    }
}

/// A part of a flow, in the order in which the sender wrote it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'b> {
    /// The next bytes, with the time of their packet.
    Bytes(Duration, &'b [u8]),
    /// The capture lacks this number of bytes.
    Missing(u64),
    /// The sender has closed the connection.
    End,
}

/// Receives the parts of all flows.
pub type Receiver<'o> = dyn FnMut(Flow, Event<'_>) -> io::Result<()> + 'o;

/// The reason why reading a capture ended early.
#[derive(Debug)]
pub enum CaptureError {
    /// The input cannot be read.
    Read(io::Error),
    /// The input is not a capture, or is damaged.
    Damaged,
    /// The capture ends inside a packet.
    Cut,
    /// A block of the capture exceeds the limit.
    TooLarge,
    /// The receiver has failed.
    Receiver(io::Error),
}
