//! Feeds a stream to the frame decoder as a whole and in arbitrary pieces.
//!
//! Input: a byte of flags, the number of piece lengths, the piece lengths, the stream. A flag corrects the digests of
//! all frames first, because a fuzzer cannot guess an MD5.

use crate::input::Input;
use fc_generated::Fc;
use fc_runtime::digest::{DigestAlgorithm as _, Md5};
use fc_runtime::{Decoder, Encoder, FrameError, FrameId, Header, Limits, Protocol};

const LIMITS: Limits = Limits {
    frame_bytes: 8 * 1024,
    inflated_bytes: 32 * 1024,
    ..Fc::DEFAULTS.limits
};
/// Memory that a decoder may keep in addition to a multiple of the received bytes, in bytes.
const SLACK: usize = 256 * 1024;

type Found = Vec<Result<(FrameId, Vec<u8>), FrameError>>;

/// Checks that the split does not change the frames and errors.
///
/// The memory of the decoder is limited by the number of received bytes. Every decoded frame can be encoded and decoded
/// again.
pub fn frames(data: &[u8]) {
    let mut input = Input::new(data);
    let flags = input.byte();
    let pieces: Vec<usize> = {
        let count = usize::from(input.byte() % 16);
        input
            .take(count)
            .iter()
            .map(|&byte| usize::from(byte))
            .collect()
    };
    let mut stream = input.rest().to_vec();
    if flags & 1 != 0 {
        seal(&mut stream);
    }
    let decoder = || {
        Decoder::<Fc>::new()
            .limits(&LIMITS)
            .verify_digest(flags & 2 == 0)
            .resync(flags & 4 != 0)
    };

    let mut whole = decoder();
    let mut expected = Found::new();
    whole.push(&stream);
    drain(&mut whole, &mut expected);

    let mut split = decoder();
    let mut found = Found::new();
    let mut rest = stream.as_slice();
    let mut lengths = pieces.iter().copied().cycle();
    let mut given = 0;
    while !rest.is_empty() {
        let length = lengths.next().unwrap_or(1).clamp(1, rest.len());
        let (piece, after) = rest.split_at(length);
        split.push(piece);
        drain(&mut split, &mut found);
        rest = after;
        given += length;
        let most = 4 * given + LIMITS.inflated_bytes as usize + SLACK;
        assert!(
            split.capacity() <= most,
            "{} bytes kept of {given}",
            split.capacity()
        );
    }
    assert_eq!(found, expected, "the split has changed what was found");
    assert_eq!(split.finish(), whole.finish());
    assert_eq!(split.skipped(), whole.skipped());
    if flags & 4 != 0 {
        assert_ne!(whole.finish().map_err(|error| error.is_fatal()), Err(false));
    }

    for (id, body) in expected.into_iter().flatten() {
        let mut again = Vec::new();
        Encoder::<Fc>::new()
            .bytes(&mut again, id, &body)
            .expect("it fitted once");
        let mut decoder = Decoder::<Fc>::new();
        decoder.push(&again);
        let frame = decoder
            .next()
            .expect("a frame made here")
            .expect("a whole one");
        assert_eq!((frame.id(), frame.body()), (id, body.as_slice()));
    }
}

fn drain(decoder: &mut Decoder<Fc>, found: &mut Found) {
    loop {
        match decoder.next() {
            Ok(None) => return,
            Ok(Some(frame)) => found.push(Ok((frame.id(), frame.body().to_vec()))),
            Err(error) => {
                let fatal = error.is_fatal();
                // Every further call returns a fatal error again.
                if found.last() != Some(&Err(error)) || !fatal {
                    found.push(Err(error));
                }
                if fatal {
                    return;
                }
            }
        }
    }
}

/// Corrects the digests of the frames in `stream`, up to the first impossible length.
fn seal(stream: &mut [u8]) {
    const LEN: usize = <Fc as Protocol>::Header::LEN;
    let mut rest = stream;
    while let Some(mut header) = <Fc as Protocol>::Header::read(rest) {
        let total = header.total_length() as usize;
        if total < LEN || total > rest.len() {
            return;
        }
        let (frame, after) = rest.split_at_mut(total);
        let (front, data) = frame.split_at_mut(LEN);
        header.seal(
            header.total_length(),
            header.plain_length(),
            Md5::digest(data),
        );
        header.write(front);
        rest = after;
    }
}
