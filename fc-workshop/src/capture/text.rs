//! Reads the text of `tcpdump -x` and `tcpdump -X`.

use super::packet::{Link, Ports, segment};
use super::tcp::{Flows, Seen};
use super::{CaptureError, Receiver};
use crate::dump::{columns, positioned};
use std::io::{BufRead, BufReader, Read};
use std::time::Duration;

/// The maximum length of a line that is read.
const LONGEST: u64 = 64 << 10;

/// The maximum length of a packet.
const LARGEST: usize = 256 << 10;

/// Passes the bytes of the connections with these ports to `receiver`.
///
/// # Errors
/// The reason why reading ended early. All bytes before it are passed on.
pub fn read(
    input: impl Read,
    ports: &Ports,
    receiver: &mut Receiver<'_>,
) -> Result<Seen, CaptureError> {
    let mut input = BufReader::new(input);
    let mut packets = Packets {
        flows: Flows::new(ports),
        time: Duration::ZERO,
        packet: Vec::new(),
    };
    let mut line = Vec::new();
    let read = loop {
        line.clear();
        let mut limited = (&mut input).take(LONGEST);
        match limited.read_until(b'\n', &mut line) {
            Ok(0) => break Ok(()),
            Ok(_) => packets
                .line(&line, receiver)
                .map_err(CaptureError::Receiver)?,
            Err(error) => break Err(CaptureError::Read(error)),
        }
    };
    let ended = packets.end(receiver);
    let seen = ended
        .and_then(|()| packets.flows.finish(receiver))
        .map_err(CaptureError::Receiver)?;
    read.map(|()| seen)
}

struct Packets<'p> {
    flows: Flows<'p>,
    time: Duration,
    packet: Vec<u8>,
}

impl Packets<'_> {
    fn line(&mut self, line: &[u8], receiver: &mut Receiver<'_>) -> std::io::Result<()> {
        let is_indented = line.first().is_some_and(u8::is_ascii_whitespace);
        let line = line.trim_ascii();
        match positioned(line) {
            Some(rest) if is_indented => {
                if self.packet.len() < LARGEST {
                    let digits = columns(rest).iter();
                    let digits: Vec<_> = digits
                        .filter_map(|digit| char::from(*digit).to_digit(16))
                        .collect();
                    let pairs = digits.chunks_exact(2);
                    let byte = |pair: &[u32]| pair.iter().fold(0, |byte, digit| byte << 4 | digit);
                    let bytes = pairs.filter_map(|pair| u8::try_from(byte(pair)).ok());
                    self.packet.extend(bytes);
                }
                Ok(())
            }
            _ => {
                self.end(receiver)?;
                if let Some(time) = std::str::from_utf8(line).ok().and_then(time) {
                    self.time = time;
                }
                Ok(())
            }
        }
    }

    /// Ends the packet before the current line.
    fn end(&mut self, receiver: &mut Receiver<'_>) -> std::io::Result<()> {
        let packet = std::mem::take(&mut self.packet);
        // `-x` leaves out the link, `-xx` does not.
        let links = [Link::Ip, Link::Ethernet];
        let mut segments = links.into_iter().filter_map(|link| segment(link, &packet));
        match segments.next() {
            Some(segment) => self.flows.add(&segment, self.time, receiver),
            None => Ok(()),
        }
    }
}

/// Returns the time at the start of a line, such as `12:00:01.5 IP …` or `1700000000.5 IP …`. A date before the time of
/// day is ignored.
fn time(line: &str) -> Option<Duration> {
    let mut words = line.split_ascii_whitespace().take(2);
    words.find_map(|word| {
        let mut seconds: f64 = 0.0;
        for part in word.split(':') {
            seconds = seconds * 60.0 + part.parse::<f64>().ok().filter(|part| *part >= 0.0)?;
        }
        let has_fraction = word.contains('.');
        Duration::try_from_secs_f64(seconds)
            .ok()
            .filter(|_| has_fraction)
    })
}
