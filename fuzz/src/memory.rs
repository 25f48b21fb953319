//! Measures the memory for receiving one frame, with a counting allocator.
//!
//! Input: two bytes choose the message. The next two are the number of repetitions of the middle part. One byte each is
//! the length of the first part and of the middle part. The three parts of the body follow.

use crate::bodies::MESSAGES;
use crate::input::Input;
use fc_generated::Fc;
use fc_runtime::{Allowance, Decoder, Encoder, FrameId, Gzip, Protocol};
use peak_alloc::PeakAlloc;

/// The counting allocator. It counts only in a binary that makes it the global allocator.
pub const COUNTING: PeakAlloc = PeakAlloc;

/// Allowed memory for each received or inflated byte, in bytes.
const FACTOR: usize = 4;

/// The memory of lists has a separate limit. It is small here, so that it does not hide other memory.
const ALLOWANCE: Allowance = Allowance {
    list_bytes: 1024,
    ..Allowance::DEFAULT
};

/// Encoding and limits of a body.
struct Way {
    /// Longest body, in bytes. It allows many runs, but is long compared with `constant`.
    longest: usize,
    gzip: Option<Gzip>,
    /// Allowed memory that does not depend on the length of the body, in bytes. It covers lists, including their
    /// copies while they grow, and the state of the decompressor.
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

/// Checks that no body takes more memory than a multiple of its received and inflated bytes.
///
/// The measurement covers receiving, inflating and reading.
pub fn memory(data: &[u8]) {
    let mut input = Input::new(data);
    let row = &MESSAGES[usize::from(input.u16()) % MESSAGES.len()];
    // Compression is slow, so only one input in 16 is also compressed.
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
        // The measurement starts here, because the receive buffer exists before any frame.
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
