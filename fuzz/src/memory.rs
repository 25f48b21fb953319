//! What a frame costs in memory, as an allocator counts it.
//!
//! Input: two bytes that choose the message, two that say how often a piece is repeated, the lengths
//! of what is in front of it and of itself, then the three parts of a body.

use crate::bodies::MESSAGES;
use crate::input::Input;
use fc_generated::Fc;
use fc_runtime::{Allowance, Decoder, Encoder, FrameId, Gzip, Protocol};
use peak_alloc::PeakAlloc;

/// What a binary that means to count makes its global allocator. Elsewhere it sees nothing.
pub const COUNTING: PeakAlloc = PeakAlloc;

/// Bytes of memory for each byte that was received or inflated.
const FACTOR: usize = 4;

/// What lists may take is a limit of its own: small here, so that it hides nothing.
const ALLOWANCE: Allowance = Allowance {
    list_bytes: 1024,
    ..Allowance::DEFAULT
};

/// A way for a body to come.
struct Way {
    /// Longest body, in bytes: short enough for many, and long enough to stand out beside the constant.
    longest: usize,
    gzip: Option<Gzip>,
    /// What does not depend on the body, in bytes: the lists with what moves while they grow, the state of the
    /// decompressor.
    constant: usize,
}

const PLAIN: Way = Way {
    longest: 2 * 1024,
    gzip: None,
    constant: 6 * 1024,
};

const PACKED: Way = Way {
    longest: 32 * 1024,
    gzip: Some(Gzip {
        from_bytes: 0,
        level: 6,
    }),
    constant: 160 * 1024,
};

/// However a body is made, to receive, inflate and read it takes no more memory than a multiple of
/// what was received and inflated.
pub fn memory(data: &[u8]) {
    let mut input = Input::new(data);
    let row = &MESSAGES[usize::from(input.u16()) % MESSAGES.len()];
    // Packing takes long: most are plain.
    let ways: &[Way] = if data.len().is_multiple_of(16) {
        &[PLAIN, PACKED]
    } else {
        &[PLAIN]
    };
    let times = usize::from(input.u16());
    let (front, piece) = (input.byte(), input.byte());
    let front = input.take(usize::from(front));
    let piece = input.take(usize::from(piece));
    for way in ways {
        let times = times.min(way.longest / piece.len().max(1));
        let body = [front, &piece.repeat(times), input.rest()].concat();
        let mut bytes = Vec::new();
        let mut encoder = Encoder::<Fc>::new().gzip(way.gzip);
        let id = FrameId {
            response: false,
            kind: Fc::COMMAND,
            code: 1,
            id: 1,
        };
        encoder.bytes(&mut bytes, id, &body).expect("it fits");
        drop(encoder);

        let (first, rest) = bytes.split_at(1);
        let mut decoder = Decoder::<Fc>::new().verify_digest(false);
        decoder.push(first);
        // From here on: the receive buffer is there, whatever comes.
        let before = COUNTING.current_usage();
        COUNTING.reset_peak_usage();
        decoder.push(rest);
        let mut inflated = 0;
        if let Ok(Some(frame)) = decoder.next() {
            inflated = frame.body().len();
            let _ = row.enveloped(frame.body(), ALLOWANCE);
        }
        let peak = COUNTING.peak_usage().saturating_sub(before);
        let most = FACTOR * (bytes.len() + inflated) + way.constant;
        assert!(
            peak <= most,
            "{}: {peak} bytes for {} received and {inflated} inflated",
            row.name,
            bytes.len()
        );
    }
}
