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

/// Longest body, in bytes.
const LONGEST: usize = 32 * 1024;

/// Bytes of memory for each byte that was received or inflated.
const FACTOR: usize = 4;

/// What lists may take is a limit of its own: small here, so that it hides nothing.
const ALLOWANCE: Allowance = Allowance {
    list_bytes: 16 * 1024,
    ..Allowance::DEFAULT
};

/// What does not depend on the body: the receive buffer, the state of the decompressor, and the lists
/// with what moves while they grow.
const CONSTANT: usize = 192 * 1024;

/// However a body is made, to receive, inflate and read it takes no more memory than a multiple of
/// what was received and inflated.
pub fn memory(data: &[u8]) {
    let mut input = Input::new(data);
    let row = &MESSAGES[usize::from(input.u16()) % MESSAGES.len()];
    let times = usize::from(input.u16());
    let (front, piece) = (input.byte(), input.byte());
    let front = input.take(usize::from(front));
    let piece = input.take(usize::from(piece));
    let times = times.min(LONGEST / piece.len().max(1));
    let body = [front, &piece.repeat(times), input.rest()].concat();
    for from_bytes in [0, usize::MAX] {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::<Fc>::new().gzip(Gzip {
            from_bytes,
            level: 6,
        });
        let id = FrameId {
            response: false,
            kind: Fc::COMMAND,
            code: 1,
            id: 1,
        };
        encoder.bytes(&mut bytes, id, &body).expect("it fits");
        drop(encoder);

        let before = COUNTING.current_usage();
        COUNTING.reset_peak_usage();
        let mut decoder = Decoder::<Fc>::new();
        decoder.push(&bytes);
        let mut inflated = 0;
        if let Ok(Some(frame)) = decoder.next() {
            inflated = frame.body().len();
            let _ = row.enveloped(frame.body(), ALLOWANCE);
        }
        let peak = COUNTING.peak_usage().saturating_sub(before);
        let most = FACTOR * (bytes.len() + inflated) + CONSTANT;
        assert!(
            peak <= most,
            "{}: {peak} bytes for {} received and {inflated} inflated",
            row.name,
            bytes.len()
        );
    }
}
