//! Frames out of bytes: any split, every fault, bounded memory.

use crate::common::{self, LIMITS, Toy, ToyHeader, answer_to, command, frame, report};
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{Decoder, Encoder, FrameError, FrameId, Gzip, Header, Limits, Protocol};
use proptest::collection::vec;
use proptest::prelude::{Strategy, any, prop_oneof, proptest};
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// The rest of a frame after its decoder continues.
type Owned = (FrameId, Vec<u8>);

fn drain(decoder: &mut Decoder<Toy>, frames: &mut Vec<Result<Owned, FrameError>>) {
    loop {
        match decoder.next() {
            Ok(None) => return,
            Ok(Some(frame)) => frames.push(Ok((frame.id(), frame.body().to_vec()))),
            Err(error) => {
                frames.push(Err(error));
                if error.is_fatal() {
                    return;
                }
            }
        }
    }
}

fn decode(bytes: &[u8]) -> Vec<Result<Owned, FrameError>> {
    let mut decoder = Decoder::new();
    let mut frames = Vec::new();
    decoder.push(bytes);
    drain(&mut decoder, &mut frames);
    frames
}

fn one(bytes: &[u8]) -> Result<Owned, FrameError> {
    let frames = decode(bytes);
    assert_eq!(frames.len(), 1, "{frames:?}");
    frames[0].clone()
}

fn ids() -> impl Strategy<Value = FrameId> {
    let kinds = prop_oneof![
        proptest::strategy::Just(Toy::STREAM),
        proptest::strategy::Just(Toy::COMMAND),
        proptest::strategy::Just(Toy::REPORT)
    ];
    (any::<bool>(), kinds, any::<u16>(), any::<u32>()).prop_map(|(response, kind, code, id)| {
        FrameId {
            response,
            kind,
            code,
            id,
        }
    })
}

#[fc_test::test]
fn ten_thousand_frames_are_the_same_in_any_split() {
    let bodies = prop_oneof![
        vec(any::<u8>(), 0..60),
        (any::<u8>(), 0_usize..400).prop_map(|(byte, length)| vec![byte; length]),
    ];
    let case = (ids(), bodies, 1_usize..200);
    let mut runner = TestRunner::deterministic();
    let mut encoder = Encoder::<Toy>::new().gzip(Gzip {
        from_bytes: 64,
        level: 6,
    });
    let (mut stream, mut expected, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..10_000 {
        let (id, body, length) = case.new_tree(&mut runner).unwrap().current();
        encoder.bytes(&mut stream, id, &body).unwrap();
        expected.push(Ok((id, body)));
        lengths.push(length);
    }
    assert!(decode(&stream) == expected, "in one piece");

    let mut decoder = Decoder::new();
    let mut frames = Vec::new();
    for byte in &stream {
        decoder.push(std::slice::from_ref(byte));
        drain(&mut decoder, &mut frames);
    }
    assert!(frames == expected, "byte by byte");

    let mut decoder = Decoder::new();
    let mut frames = Vec::new();
    let mut rest = stream.as_slice();
    for length in lengths.iter().cycle() {
        let (piece, after) = rest.split_at(rest.len().min(*length));
        decoder.push(piece);
        drain(&mut decoder, &mut frames);
        rest = after;
        if rest.is_empty() {
            break;
        }
    }
    assert!(frames == expected, "in pieces");
    assert_eq!(decoder.finish(), Ok(()));
    assert!(decoder.capacity() < 300_000, "{}", decoder.capacity());
}

#[fc_test::test]
fn a_taken_body_keeps_the_next_frame() {
    let mut stream = Vec::new();
    let mut encoder = Encoder::<Toy>::new().gzip(Gzip {
        from_bytes: 100_000,
        level: 1,
    });
    let lengths = [0, 10, 50_000, 3, 200_000, 200_000, 7, 31 << 10, 33 << 10];
    for (id, length) in (0..).zip(lengths) {
        encoder
            .bytes(&mut stream, command(1, id), &vec![9; length])
            .unwrap();
    }
    for piece in [1_000_000, 60_000, 1000] {
        let mut decoder = Decoder::<Toy>::new();
        let mut taken = Vec::new();
        for piece in stream.chunks(piece) {
            decoder.push(piece);
            while let Some(frame) = decoder.next().unwrap() {
                taken.push(frame.into_body().into_vec());
            }
        }
        assert_eq!(taken.iter().map(Vec::len).collect::<Vec<_>>(), lengths);
        assert!(taken.iter().flatten().all(|byte| *byte == 9));
    }
}

/// A frame with one field of its header changed.
fn with(id: FrameId, body: &[u8], change: impl FnOnce(&mut ToyHeader)) -> Vec<u8> {
    let mut bytes = frame(id, body);
    let mut header = ToyHeader::read(&bytes).unwrap();
    change(&mut header);
    assert!(header.write(&mut bytes));
    bytes
}

fn gzipped(id: FrameId, body: &[u8], change: impl FnOnce(&mut ToyHeader, &mut [u8])) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::<Toy>::new().gzip(Gzip {
        from_bytes: 0,
        level: 9,
    });
    encoder.bytes(&mut bytes, id, body).unwrap();
    let (front, data) = bytes.split_at_mut(ToyHeader::LEN);
    let mut header = ToyHeader::read(front).unwrap();
    assert_eq!(Some(header.encoding), Toy::GZIP);
    change(&mut header, data);
    header.digest = Md5::digest(data);
    header.write(front);
    bytes
}

#[fc_test::test]
#[allow(clippy::too_many_lines, reason = "a table")]
fn each_kind_of_bad_frame_has_its_own_error() {
    let id = report(0x0B01, 77);
    let frame = id;
    let body = b"{}";
    let long = [b'a'; 500];
    let cases = [
        (
            with(id, body, |h| h.head = *b"<;>"),
            "bad_head",
            FrameError::BadHead,
        ),
        (
            with(id, body, |h| h.total = 36),
            "short_frame",
            FrameError::ShortFrame {
                total: 36,
                header: 37,
            },
        ),
        (
            with(id, body, |h| h.total = LIMITS.frame_bytes + 1),
            "frame_too_long",
            FrameError::FrameTooLong {
                total: u64::from(LIMITS.frame_bytes) + 1,
                limit: LIMITS.frame_bytes,
            },
        ),
        (
            with(id, body, |h| h.kind = 99),
            "unknown_kind",
            FrameError::UnknownKind {
                frame: FrameId { kind: 99, ..id },
            },
        ),
        (
            with(id, body, |h| h.kind = 44),
            "reserved_kind",
            FrameError::ReservedKind {
                frame: FrameId { kind: 44, ..id },
            },
        ),
        (
            with(id, body, |h| h.encoding = 9),
            "unknown_encoding",
            FrameError::UnknownEncoding { frame, encoding: 9 },
        ),
        (
            with(id, body, |h| h.digest[15] ^= 1),
            "bad_digest",
            FrameError::BadDigest { frame },
        ),
        (
            with(id, body, |h| h.encoding = Toy::GZIP.unwrap()),
            "bad_gzip",
            FrameError::BadGzip { frame },
        ),
        (
            gzipped(id, &long, |_, data| *data.last_mut().unwrap() ^= 1),
            "bad_gzip",
            FrameError::BadGzip { frame },
        ),
        (
            with(id, body, |h| h.plain = 3),
            "plain_length_mismatch",
            FrameError::PlainLengthMismatch { frame, plain: 3 },
        ),
        (
            gzipped(id, &long, |h, _| h.plain = 499),
            "plain_length_mismatch",
            FrameError::PlainLengthMismatch { frame, plain: 499 },
        ),
        (
            gzipped(id, &long, |h, _| h.plain = 501),
            "plain_length_mismatch",
            FrameError::PlainLengthMismatch { frame, plain: 501 },
        ),
        (
            gzipped(id, &long, |h, _| h.plain = LIMITS.inflated_bytes + 1),
            "inflated_too_long",
            FrameError::InflatedTooLong {
                frame,
                plain: LIMITS.inflated_bytes + 1,
                limit: LIMITS.inflated_bytes,
            },
        ),
    ];
    let good = common::frame(command(1, 1), b"after");
    for (mut bytes, name, error) in cases {
        assert_eq!(error.name(), name);
        bytes.extend_from_slice(&good);
        let frames = decode(&bytes);
        assert_eq!(frames[0], Err(error), "{name}");
        if error.is_fatal() {
            assert_eq!(frames.len(), 1, "{name}");
            assert_eq!(error.frame(), None);
        } else {
            assert_eq!(
                frames[1..],
                [Ok((command(1, 1), b"after".to_vec()))],
                "{name}"
            );
            assert_eq!(error.frame().unwrap().id, 77);
        }
    }
}

#[fc_test::test]
fn of_several_faults_the_first_in_order_is_told() {
    type Change = fn(&mut ToyHeader);
    let changes: [(Change, &str); 7] = [
        (|h| h.head[2] = 0, "bad_head"),
        (|h| h.total = 1, "short_frame"),
        (|h| h.kind = 99, "unknown_kind"),
        (|h| h.encoding = 9, "unknown_encoding"),
        (|h| h.digest[0] ^= 1, "bad_digest"),
        (|h| h.plain = 1, "plain_length_mismatch"),
        (|_| (), ""),
    ];
    for first in 0..changes.len() - 1 {
        let bytes = with(command(1, 2), b"body", |header| {
            changes[first..]
                .iter()
                .for_each(|(change, _)| change(header));
        });
        let error = decode(&bytes).remove(0).unwrap_err();
        assert_eq!(error.name(), changes[first].1);
    }
}

#[fc_test::test]
fn refusals_come_as_early_as_they_can() {
    let good = frame(command(1, 2), b"body");
    for wrong in 0..3 {
        let mut bytes = good.clone();
        bytes[wrong] = b'#';
        for end in 1..=wrong {
            assert_eq!(decode(&bytes[..end]), [], "{end} of {wrong}");
        }
        assert_eq!(one(&bytes[..=wrong]), Err(FrameError::BadHead), "{wrong}");
    }
    let long = with(command(1, 2), b"", |h| h.total = u32::MAX);
    assert_eq!(decode(&long[..6]), []);
    assert_eq!(one(&long[..7]).unwrap_err().name(), "frame_too_long");
    let short = with(command(1, 2), b"", |h| h.total = 0);
    assert_eq!(one(&short[..7]).unwrap_err().name(), "short_frame");
}

#[fc_test::test]
fn a_fatal_error_stays() {
    let mut decoder = Decoder::<Toy>::new();
    decoder.push(b"<;>");
    assert_eq!(decoder.next().unwrap_err(), FrameError::BadHead);
    decoder.push(&frame(command(1, 2), b""));
    assert_eq!(decoder.next().unwrap_err(), FrameError::BadHead);
    assert_eq!(decoder.finish(), Err(FrameError::BadHead));
}

#[fc_test::test]
fn an_end_inside_a_frame_is_told() {
    let bytes = frame(command(1, 2), b"body");
    for end in 1..bytes.len() {
        let mut decoder = Decoder::<Toy>::new();
        decoder.push(&bytes[..end]);
        assert!(decoder.next().unwrap().is_none());
        let error = decoder.finish().unwrap_err();
        assert_eq!(error, FrameError::Truncated { bytes: end });
        assert!(error.is_fatal());
        assert_eq!(error.name(), "truncated");
    }
}

#[fc_test::test]
fn the_quirk_of_a_zero_plain_length() {
    let bytes = with(command(1, 2), b"body", |h| h.plain = 0);
    assert_eq!(one(&bytes), Ok((command(1, 2), b"body".to_vec())));
    let bytes = gzipped(command(1, 2), &[b'a'; 500], |h, _| h.plain = 0);
    assert_eq!(one(&bytes).unwrap_err().name(), "plain_length_mismatch");
}

#[fc_test::test]
fn digests_can_be_left_unverified() {
    let bytes = with(command(1, 2), b"body", |h| h.digest[3] ^= 1);
    let mut decoder = Decoder::<Toy>::new().verify_digest(false);
    decoder.push(&bytes);
    assert_eq!(decoder.next().unwrap().unwrap().body(), b"body");
}

#[fc_test::test]
fn constant_header_fields_are_sent_and_not_judged() {
    let bytes = frame(command(1, 2), b"");
    assert_eq!(ToyHeader::read(&bytes).unwrap().spare, 0x77);
    let bytes = with(command(1, 2), b"", |h| h.spare = 3);
    assert!(one(&bytes).is_ok());
}

#[fc_test::test]
fn announced_length_reserves_received_bytes_only() {
    let announced = with(command(1, 2), b"", |h| h.total = LIMITS.frame_bytes);
    let mut decoder = Decoder::<Toy>::new();
    decoder.push(&announced);
    assert!(decoder.next().unwrap().is_none());
    let mut sent = announced.len();
    while sent < 1 << 20 {
        assert!(
            decoder.capacity() <= 2 * sent + (192 << 10),
            "{sent}: {}",
            decoder.capacity()
        );
        decoder.push(&[0; 10_000]);
        assert!(decoder.next().unwrap().is_none());
        sent += 10_000;
    }
}

#[fc_test::test]
fn a_bomb_costs_no_more_than_its_limit() {
    let limits = Limits {
        inflated_bytes: 100_000,
        ..LIMITS
    };
    let bomb = gzipped(command(1, 2), &vec![0; 10_000_000], |h, _| {
        h.plain = 100_000;
    });
    let mut decoder = Decoder::<Toy>::new().limits(&limits);
    for _ in 0..3 {
        decoder.push(&bomb);
        assert_eq!(decoder.next().unwrap_err().name(), "plain_length_mismatch");
        assert!(decoder.capacity() < 500_000, "{}", decoder.capacity());
    }
}

#[fc_test::test]
fn the_buffer_of_a_huge_frame_is_given_back() {
    let mut decoder = Decoder::<Toy>::new();
    decoder.push(&frame(command(1, 2), &vec![b'x'; 7 << 20]));
    assert!(decoder.next().unwrap().is_some());
    decoder.push(&frame(command(1, 3), b""));
    assert!(decoder.next().unwrap().is_some());
    assert!(decoder.capacity() < 1 << 20, "{}", decoder.capacity());
}

#[fc_test::test]
fn resynchronising_finds_the_next_frame() {
    let first = frame(command(1, 1), b"first");
    let second = frame(answer_to(command(1, 2)), b"second");
    let long = with(command(1, 9), b"", |h| h.total = u32::MAX);
    let damaged = with(command(1, 9), b"<?>", |h| h.digest[0] ^= 1);
    let noise: [&[u8]; 5] = [
        b"noise",
        b"<?<?<!",
        &long,
        &[&b"x"[..], &damaged].concat(),
        b"<?>\0\0\0\0",
    ];
    for noise in noise {
        let bytes = [&first, noise, &second].concat();
        let mut decoder = Decoder::<Toy>::new().resync(true);
        let mut frames = Vec::new();
        for byte in &bytes {
            decoder.push(std::slice::from_ref(byte));
            drain(&mut decoder, &mut frames);
        }
        let expected = [
            (command(1, 1), b"first".to_vec()),
            (answer_to(command(1, 2)), b"second".to_vec()),
        ];
        assert_eq!(frames, expected.map(Ok), "{noise:?}");
        assert_eq!(decoder.skipped(), noise.len() as u64, "{noise:?}");
    }
}

proptest! {
    #[fc_test::test]
    fn no_input_panics(pieces in vec(vec(any::<u8>(), 0..80), 0..20), resync in any::<bool>()) {
        let mut decoder = Decoder::<Toy>::new().resync(resync);
        for piece in pieces {
            decoder.push(&piece);
            drain(&mut decoder, &mut Vec::new());
        }
        let _ = decoder.finish();
    }

    #[fc_test::test]
    fn no_damage_panics_or_goes_unnoticed(
        body in vec(any::<u8>(), 0..200),
        at in any::<proptest::sample::Index>(),
        flip in 1_u8..,
    ) {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::<Toy>::new().gzip(Gzip { from_bytes: 100, level: 6 });
        encoder.bytes(&mut bytes, command(1, 1), &body).unwrap();
        let at = at.index(bytes.len());
        bytes[at] ^= flip;
        let mut decoder = Decoder::<Toy>::new();
        decoder.push(&bytes);
        if let Ok(Some(frame)) = decoder.next() {
            // Bytes without a digest may be accepted: the rest of the header.
            assert!(at < ToyHeader::LEN);
            assert_eq!(frame.body(), body);
        }
    }
}

#[fc_test::test]
fn a_search_among_heads_inside_heads_ends() {
    // Each head opens a frame that reaches to the end; looking at all of them would take for ever.
    let limits = Limits {
        frame_bytes: 64 * 1024,
        ..LIMITS
    };
    let count = 1500;
    let mut bytes = b"no head".to_vec();
    for place in 0..count {
        let mut header = ToyHeader::read(&frame(command(1, 1), b"")).unwrap();
        let total = (count - place) * ToyHeader::LEN;
        header.seal(total as u32, 0, [0; 16]);
        let mut one = [0; ToyHeader::LEN];
        header.write(&mut one);
        bytes.extend_from_slice(&one);
    }
    let mut decoder = Decoder::<Toy>::new().limits(&limits).resync(true);
    decoder.push(&bytes);
    assert_eq!(
        decoder.next().map(|_| ()).map_err(|error| error.name()),
        Err("bad_head")
    );
    assert!(decoder.skipped() < 1000, "{}", decoder.skipped());
}

#[fc_test::test]
fn the_memory_of_a_large_body_is_given_back() {
    let mut bytes = Vec::new();
    let gzip = Gzip {
        from_bytes: 0,
        level: 9,
    };
    let mut encoder = Encoder::<Toy>::new().gzip(gzip);
    encoder
        .bytes(&mut bytes, command(1, 1), &vec![b' '; 12 << 20])
        .unwrap();
    let mut decoder = Decoder::<Toy>::new();
    decoder.push(&bytes);
    assert_eq!(decoder.next().unwrap().unwrap().body().len(), 12 << 20);
    assert!(decoder.next().unwrap().is_none());
    assert!(decoder.capacity() < 5 << 20, "{}", decoder.capacity());
}
