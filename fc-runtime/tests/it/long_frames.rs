//! Long frames are digested while they arrive: whatever the pieces, one that is damaged anywhere is found, and
//! the next is not touched by it.

use crate::common::{Toy, ToyHeader, command, frame};
use fc_runtime::{Decoder, FrameError, FrameId, Header};

/// The result of a stream that arrives in pieces of this length.
fn outcomes(
    decoder: &mut Decoder<Toy>,
    stream: &[u8],
    piece: usize,
) -> Vec<Result<u32, FrameError>> {
    let mut outcomes = Vec::new();
    for piece in stream.chunks(piece) {
        decoder.push(piece);
        while let Some(next) = decoder.next().transpose() {
            outcomes.push(next.map(|frame| frame.id().id));
        }
    }
    outcomes
}

/// Bodies without equal pieces, all different.
fn body(id: u32, length: usize) -> Vec<u8> {
    (id << 24..)
        .flat_map(u32::to_le_bytes)
        .take(length)
        .collect()
}

fn long(id: u32, length: usize) -> (FrameId, Vec<u8>) {
    let id = command(1, id);
    (id, frame(id, &body(id.id, length)))
}

const LENGTHS: [usize; 5] = [100, 65_490, 65_536, 300_000, 1 << 20];
const PIECES: [usize; 5] = [999, 10_000, 65_536, 400_000, 1 << 21];

#[fc_test::test]
fn damage_anywhere_is_found() {
    for length in LENGTHS {
        for piece in PIECES {
            let (first, bytes) = long(1, length);
            let (_, next) = long(2, length);
            for at in [0, 1, length / 3, length / 2, length - 1] {
                let mut stream = bytes.clone();
                stream[ToyHeader::LEN + at] ^= 1;
                stream.extend_from_slice(&next);
                let outcomes = outcomes(&mut Decoder::new(), &stream, piece);
                let bad = Err(FrameError::BadDigest { frame: first });
                assert_eq!(outcomes, [bad, Ok(2)], "{length} in {piece} at {at}");
            }
        }
    }
}

#[fc_test::test]
fn frame_after_frame_is_read() {
    for piece in PIECES {
        let stream: Vec<u8> = (0..)
            .zip(LENGTHS)
            .flat_map(|(id, length)| long(id, length).1)
            .collect();
        let outcomes = outcomes(&mut Decoder::new(), &stream, piece);
        assert_eq!(outcomes, [Ok(0), Ok(1), Ok(2), Ok(3), Ok(4)], "in {piece}");
    }
}

/// A frame refused without a digest check leaves no state behind for the next one.
#[fc_test::test]
fn a_refused_frame_leaves_no_digest_behind() {
    for piece in PIECES {
        let (frame, mut stream) = long(1, 300_000);
        let mut header = ToyHeader::read(&stream).unwrap();
        header.kind = 43;
        assert!(header.write(&mut stream));
        let frame = FrameId { kind: 43, ..frame };
        stream.extend(long(2, 300_000).1);
        let outcomes = outcomes(&mut Decoder::new(), &stream, piece);
        assert_eq!(
            outcomes,
            [Err(FrameError::ReservedKind { frame }), Ok(2)],
            "in {piece}"
        );
    }
}

/// A search may return to an earlier position.
#[fc_test::test]
fn a_search_digests_each_candidate_for_itself() {
    for piece in PIECES {
        // A head that claims a long frame, and in the midst of that a true one.
        let (_, claim) = long(1, 200_000);
        let mut stream = claim[..ToyHeader::LEN + 70_000].to_vec();
        stream.extend(b"<?>\xFF\xFF\xFF\xFF");
        stream.extend(long(2, 300_000).1);
        stream.extend(long(3, 300_000).1);
        let mut decoder = Decoder::<Toy>::new().resync(true);
        let outcomes = outcomes(&mut decoder, &stream, piece);
        assert_eq!(outcomes.last(), Some(&Ok(3)), "in {piece}");
    }
}
