//! Damaged bytes: the next whole frame is found, and time and memory are bounded.

use super::{error, lines, read, sampled};
use crate::support::{small, small_with};
use fc_reflect::{Direction, Packing, Reflector};
use fc_workshop::capture::Flow;
use fc_workshop::decode::{Decoder, Format, Record};
use proptest::prelude::*;
use serde_json::Value;
use std::convert::Infallible;
use std::io::Read;
use std::net::SocketAddr;

fn shown(lines: &[Value]) -> Vec<(u64, u64, &str)> {
    let number = |line: &Value, key: &str| line[key].as_u64().unwrap();
    let line = |line| (number(line, "offset"), number(line, "length"), error(line));
    lines.iter().map(line).collect()
}

#[test]
fn the_next_frame_is_found_after_damage() {
    let model = small();
    let frame = sampled(&model, "dimmed", 7);
    let length = frame.len();
    let changed = |at: usize, to: u8| {
        let mut changed = frame.clone();
        changed[at] = to;
        changed
    };
    let whole = length as u64;
    // Byte 3 is the lowest byte of the total length, byte 45 the first one of the body.
    for (name, damaged, expected) in [
        ("head", changed(0, 0), (0, whole, "bad_head")),
        ("body", changed(45, b' '), (0, whole, "bad_digest")),
        ("longer", changed(3, 200), (0, whole, "bad_digest")),
        ("shorter", changed(3, 46), (0, 46, "bad_digest")),
        ("too short", changed(3, 1), (0, whole, "short_frame")),
        ("too long", changed(6, 1), (0, whole, "frame_too_long")),
        ("cut", frame[..20].to_vec(), (0, 20, "unknown_kind")),
        ("noise", vec![b'L'; 50], (0, 50, "bad_head")),
    ] {
        let input = [damaged.clone(), frame.repeat(4)].concat();
        let found = lines(&model, &input, Some(Format::Binary));
        let found = shown(&found);
        assert_eq!(found[0], expected, "{name}: {found:?}");
        let frames: Vec<_> = found[1..].iter().filter(|line| line.2.is_empty()).collect();
        assert_eq!(frames.len(), 4, "{name}: {found:?}");
    }
}

#[test]
fn frames_inside_an_incomplete_frame_are_found() {
    let model = small();
    let frame = sampled(&model, "dimmed", 7);
    let mut long = frame.clone();
    // The frame claims 4,000 bytes.
    long[3..5].copy_from_slice(&4000_u16.to_le_bytes());
    let input = [long, frame.clone(), frame[..30].to_vec()].concat();
    let found = lines(&model, &input, Some(Format::Binary));
    let length = frame.len() as u64;
    let expected = [
        (0, length, "truncated"),
        (length, length, ""),
        (2 * length, 30, "truncated"),
    ];
    assert_eq!(shown(&found), expected);
}

#[test]
fn the_memory_of_long_frames_is_freed() {
    let model = small_with(|text| text.replace("frame_bytes: 4096", "frame_bytes: 65536"));
    let reflector = Reflector::new(&model);
    let operation = model.operation("dimmed").unwrap();
    let id = reflector.id(operation, Direction::Request, 7).unwrap();
    let long = reflector
        .seal(id, &vec![b' '; 60_000], Packing::Plain)
        .unwrap();
    let mut decoder = Decoder::new(&reflector);
    let mut frames = 0;
    for port in 1..100 {
        let from = SocketAddr::from(([127, 0, 0, 1], port));
        let to = SocketAddr::from(([127, 0, 0, 2], 1));
        let count = &mut |_: &Record<'_>| {
            frames += 1;
            Ok::<_, Infallible>(())
        };
        // The beginning of the next frame follows.
        for part in [&long[..50_000], &[&long[50_000..], &long[..9]].concat()] {
            let flow = Some(Flow { from, to });
            let Ok(()) = decoder.push(flow, None, part, count);
        }
    }
    assert_eq!(frames, 99);
    assert!(decoder.memory() < 99 * 10_000, "{}", decoder.memory());
}

/// Pieces of valid frames and noise, so that random input reaches the deeper checks.
fn pieces() -> impl Strategy<Value = Vec<u8>> {
    let model = small();
    let frame = sampled(&model, "dimmed", 7);
    let end = frame.len();
    let part = (0..end, 0..=end).prop_map(move |(from, to)| {
        let (from, to) = (from.min(to), to.max(from));
        frame[from..to].to_vec()
    });
    let piece = prop_oneof![part, proptest::collection::vec(any::<u8>(), 0..80)];
    proptest::collection::vec(piece, 0..12).prop_map(|pieces| pieces.concat())
}

const FORMATS: [Option<Format>; 6] = [
    None,
    Some(Format::Binary),
    Some(Format::Hex),
    Some(Format::Base64),
    Some(Format::Capture),
    Some(Format::Tcpdump),
];

/// An input that arrives in small parts.
struct Parts<'b> {
    rest: &'b [u8],
}

impl Read for Parts<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(self.rest.len()).min(7);
        let (part, rest) = self.rest.split_at(count);
        buffer[..count].copy_from_slice(part);
        self.rest = rest;
        Ok(count)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(
        std::env::var("FC_FRAMES").ok().and_then(|count| count.parse().ok()).unwrap_or(200),
    ))]

    /// Each byte of the input is in exactly one record, however the input arrives.
    #[test]
    fn random_bytes_are_covered_once(input in pieces()) {
        let model = small();
        for format in FORMATS {
            let (found, _) = read(&model, &*input, format, &[]);
            if format == Some(Format::Binary) {
                let mut next = 0;
                for (offset, length, _) in shown(&found) {
                    prop_assert_eq!(offset, next);
                    next += length;
                }
                prop_assert_eq!(next, input.len() as u64);
                let parts = Parts { rest: &input };
                let (parted, _) = read(&model, parts, format, &[]);
                prop_assert_eq!(parted, found);
            }
        }
    }
}
