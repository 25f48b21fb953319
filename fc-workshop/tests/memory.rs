//! The memory of `decode` is bounded, however long and hostile the input is.
//!
//! It is a separate program, because it measures the allocations of the whole process. Its only test runs each input in
//! turn.

#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used,
    missing_docs,
    reason = "tests"
)]

#[allow(dead_code, reason = "other tests need more")]
#[path = "it/support/mod.rs"]
mod support;

use fc_reflect::{Direction, Packing, Reflector};
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, Format, Source};
use peak_alloc::PeakAlloc;
use std::io::Read;
use support::Numbers;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The bytes of each input, and the limit of memory. The protocol has frames of at most 4 KiB.
const LONG: usize = 2 << 20;
const MOST: usize = 1 << 20;

/// The same for captures, which have many connections.
const LONG_CAPTURE: usize = 16 << 20;
const MOST_OF_CAPTURE: usize = 6 << 20;

/// An input that repeats the pieces that a function makes.
struct Endless<F> {
    make: F,
    piece: Vec<u8>,
    at: usize,
    rest: usize,
}

impl<F: FnMut() -> Vec<u8>> Read for Endless<F> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.at == self.piece.len() {
            (self.piece, self.at) = ((self.make)(), 0);
        }
        let count = buffer.len().min(self.piece.len() - self.at).min(self.rest);
        buffer[..count].copy_from_slice(&self.piece[self.at..self.at + count]);
        self.at += count;
        self.rest -= count;
        Ok(count)
    }
}

fn endless(make: impl FnMut() -> Vec<u8> + Send) -> impl Read + Send {
    Endless {
        make,
        piece: Vec::new(),
        at: 0,
        rest: usize::MAX,
    }
}

/// A pcap packet whose TCP segment never continues the one before.
fn stray_packet(numbers: &mut Numbers) -> Vec<u8> {
    let ether = etherparse::PacketBuilder::ethernet2([1; 6], [2; 6]);
    let host = [10, 0, 0, u8::try_from(numbers.below(20)).unwrap()];
    let port = u16::try_from(numbers.below(60_000)).unwrap();
    let sequence = u32::try_from(numbers.next() >> 32).unwrap();
    let packet = ether
        .ipv4(host, [10, 0, 0, 1], 64)
        .tcp(port, 7001, sequence, 9);
    let mut bytes = Vec::new();
    packet.write(&mut bytes, &[0x4C; 1000]).unwrap();
    let length = u32::try_from(bytes.len()).unwrap().to_le_bytes();
    [&[0; 8][..], &length, &length, &bytes].concat()
}

#[test]
fn endless_input_takes_bounded_memory() {
    let model = support::small();
    let reflector = Reflector::new(&model);
    let operation = model.operation("dimmed").unwrap();
    let frame = reflector.sample(operation, Direction::Request, 7, Packing::Plain);
    let frame = frame.unwrap().unwrap();
    let mut long = frame.clone();
    // It claims 4,000 bytes, the digest is wrong, and another head follows soon.
    long[3..5].copy_from_slice(&4000_u16.to_le_bytes());
    let mut numbers = Numbers(1);
    let noise = move || (0..4096).map(|_| numbers.next().to_le_bytes()[0]).collect();
    let mut numbers = Numbers(2);
    let mut header = Some(support::unhex(
        "d4c3b2a1020004000000000000000000ffff000001000000",
    ));
    let packets = move || header.take().unwrap_or_else(|| stray_packet(&mut numbers));
    let heads = frame[..3].to_vec();
    let inputs: Vec<(&str, Format, Box<dyn Read + Send>)> = vec![
        (
            "frames",
            Format::Binary,
            Box::new(endless(move || frame.clone())),
        ),
        (
            "long frames",
            Format::Binary,
            Box::new(endless(move || long.clone())),
        ),
        (
            "heads",
            Format::Binary,
            Box::new(endless(move || heads.clone())),
        ),
        ("zeros", Format::Binary, Box::new(endless(|| vec![0; 4096]))),
        ("noise", Format::Binary, Box::new(endless(noise))),
        (
            "one line of hex",
            Format::Hex,
            Box::new(endless(|| vec![b'4'; 4096])),
        ),
        (
            "one line of base64",
            Format::Base64,
            Box::new(endless(|| vec![b'T'; 4096])),
        ),
        (
            "one line of tcpdump",
            Format::Tcpdump,
            Box::new(endless(|| vec![b'4'; 4096])),
        ),
        (
            "stray segments",
            Format::Capture,
            Box::new(endless(packets)),
        ),
    ];
    for (name, format, input) in inputs {
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let (length, most) = match format {
            Format::Capture => (LONG_CAPTURE, MOST_OF_CAPTURE),
            _ => (LONG, MOST),
        };
        let source = Source {
            input: input.take(length as u64),
            format: Some(format),
            ports: Ports::new(&model, &[]),
        };
        let mut count = 0;
        // A capture ends inside a packet.
        let _ = decode::read(&reflector, source, &mut |_| {
            count += 1;
            Ok(())
        });
        let peak = MEMORY.peak_usage() - before;
        assert!(count > 0 || format == Format::Tcpdump, "{name}");
        assert!(peak < most, "{name}: {peak} bytes");
    }
}
