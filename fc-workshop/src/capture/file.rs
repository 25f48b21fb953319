//! Reads pcap and pcapng.

use super::packet::{Link, Ports, segment};
use super::tcp::{Flows, Seen};
use super::{CaptureError, Receiver};
use pcap_parser::{Block, PcapBlockOwned, PcapError, create_reader};
use std::io::{Cursor, ErrorKind, Read};
use std::time::Duration;

/// The bytes that are read at a time.
const BUFFER: usize = 256 << 10;

/// The maximum size of a block. Packets are far smaller, and other blocks can contain a list of names.
const LARGEST: usize = 64 << 20;

/// Interfaces of a section that are known.
const INTERFACES: usize = 4096;

/// The length of the header of pcap. A section header of pcapng is longer.
const PCAP_HEADER: u64 = 24;

/// The type of a section header, and the mark of big-endian numbers in it.
const SECTION: [u8; 4] = [0x0A, 0x0D, 0x0D, 0x0A];
const BIG_ENDIAN: [u8; 4] = [0x1A, 0x2B, 0x3C, 0x4D];

/// An interface of a pcapng section.
struct Interface {
    link: Option<Link>,
    offset: u64,
    resolution: u64,
}

/// Passes the bytes of the connections with these ports to `receiver`. Returns the numbers of segments.
///
/// # Errors
/// The reason why reading ended early. All bytes before it are passed on.
pub fn read(
    input: impl Read + Send,
    ports: &Ports,
    receiver: &mut Receiver<'_>,
) -> Result<Seen, CaptureError> {
    let mut reading = Reading {
        flows: Flows::new(ports),
        link: None,
        is_nano: false,
        interfaces: Vec::new(),
    };
    let read = reading.blocks(input, receiver);
    let seen = reading.flows.finish(receiver);
    let seen = seen.map_err(CaptureError::Receiver)?;
    read.map(|()| seen)
}

struct Reading<'p> {
    flows: Flows<'p>,
    /// The link of a pcap file.
    link: Option<Link>,
    /// `true` if a pcap file has times in nanoseconds.
    is_nano: bool,
    interfaces: Vec<Interface>,
}

impl Reading<'_> {
    fn blocks(
        &mut self,
        input: impl Read + Send,
        receiver: &mut Receiver<'_>,
    ) -> Result<(), CaptureError> {
        let mut capacity = BUFFER;
        let mut input = input;
        let first = first_block(&mut input).map_err(CaptureError::Read)?;
        let input = Cursor::new(first).chain(input);
        let mut reader = create_reader(capacity, input).map_err(|error| reason(&error))?;
        loop {
            match reader.next() {
                Ok((length, block)) => {
                    self.block(&block, receiver)
                        .map_err(CaptureError::Receiver)?;
                    reader.consume(length);
                }
                Err(PcapError::Eof) => return Ok(()),
                Err(PcapError::Incomplete(_)) => {
                    reader.refill().map_err(|error| reason(&error))?;
                }
                Err(PcapError::BufferTooSmall) if capacity < LARGEST => {
                    capacity *= 2;
                    if !reader.grow(capacity) {
                        return Err(CaptureError::TooLarge);
                    }
                    reader.refill().map_err(|error| reason(&error))?;
                }
                Err(error) => return Err(reason(&error)),
            }
        }
    }

    fn block(
        &mut self,
        block: &PcapBlockOwned<'_>,
        receiver: &mut Receiver<'_>,
    ) -> std::io::Result<()> {
        match block {
            PcapBlockOwned::LegacyHeader(header) => {
                self.link = Link::numbered(header.network.0);
                self.is_nano = header.is_nanosecond_precision();
            }
            PcapBlockOwned::Legacy(packet) => {
                let fraction = packet.ts_usec;
                let nanos = if self.is_nano {
                    fraction
                } else {
                    fraction.saturating_mul(1000)
                };
                let time = time(packet.ts_sec.into(), nanos.into());
                return self.packet(self.link, time, packet.data, receiver);
            }
            PcapBlockOwned::NG(Block::SectionHeader(_)) => self.interfaces.clear(),
            PcapBlockOwned::NG(Block::InterfaceDescription(interface)) => {
                if self.interfaces.len() < INTERFACES {
                    self.interfaces.push(Interface {
                        link: Link::numbered(interface.linktype.0),
                        offset: interface.if_tsoffset.try_into().unwrap_or(0),
                        resolution: interface.ts_resolution().unwrap_or(1_000_000).max(1),
                    });
                }
            }
            PcapBlockOwned::NG(Block::EnhancedPacket(packet)) => {
                let number = usize::try_from(packet.if_id).unwrap_or(usize::MAX);
                let Some(interface) = self.interfaces.get(number) else {
                    return Ok(());
                };
                let ticks = u64::from(packet.ts_high) << 32 | u64::from(packet.ts_low);
                let (seconds, rest) = (ticks / interface.resolution, ticks % interface.resolution);
                let nanos = u128::from(rest) * 1_000_000_000 / u128::from(interface.resolution);
                let seconds = seconds.saturating_add(interface.offset);
                let time = time(seconds, u64::try_from(nanos).unwrap_or(0));
                let length = usize::try_from(packet.caplen).unwrap_or(usize::MAX);
                let data = packet.data.get(..length).unwrap_or(packet.data);
                return self.packet(interface.link, time, data, receiver);
            }
            PcapBlockOwned::NG(Block::SimplePacket(packet)) => {
                let link = self.interfaces.first().and_then(|interface| interface.link);
                return self.packet(link, Duration::ZERO, packet.data, receiver);
            }
            PcapBlockOwned::NG(_) => {}
        }
        Ok(())
    }

    fn packet(
        &mut self,
        link: Option<Link>,
        time: Duration,
        packet: &[u8],
        receiver: &mut Receiver<'_>,
    ) -> std::io::Result<()> {
        match link.and_then(|link| segment(link, packet)) {
            Some(segment) => self.flows.add(&segment, time, receiver),
            None => Ok(()),
        }
    }
}

/// Reads the first block of pcapng, or the header of pcap. The parser needs it whole, however the input arrives.
fn first_block(input: &mut impl Read) -> std::io::Result<Vec<u8>> {
    let mut block = Vec::new();
    input.take(PCAP_HEADER).read_to_end(&mut block)?;
    let word = |at: usize| block.get(at..).and_then(<[u8]>::first_chunk::<4>).copied();
    let (Some(SECTION), Some(length)) = (word(0), word(4)) else {
        return Ok(block);
    };
    let length = if word(8) == Some(BIG_ENDIAN) {
        u32::from_be_bytes(length)
    } else {
        u32::from_le_bytes(length)
    };
    // The parser refuses a longer one.
    let rest = u64::from(length)
        .min(BUFFER as u64)
        .saturating_sub(PCAP_HEADER);
    input.take(rest).read_to_end(&mut block)?;
    Ok(block)
}

fn time(seconds: u64, nanos: u64) -> Duration {
    Duration::from_secs(seconds).saturating_add(Duration::from_nanos(nanos))
}

fn reason<I>(error: &PcapError<I>) -> CaptureError {
    match error {
        PcapError::Eof | PcapError::UnexpectedEof | PcapError::Incomplete(_) => CaptureError::Cut,
        PcapError::BufferTooSmall => CaptureError::TooLarge,
        // The parser keeps no more of the error.
        PcapError::ReadError => CaptureError::Read(ErrorKind::Other.into()),
        PcapError::HeaderNotRecognized | PcapError::NomError(..) | PcapError::OwnedNomError(..) => {
            CaptureError::Damaged
        }
    }
}
