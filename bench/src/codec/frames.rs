//! Encodes and decodes one message.

use fc_bench_cases::messages;
use fc_generated::{Fc, ResponseEnvelope};
use fc_runtime::{Decoder, Encoder, FrameId, Gzip, Message, Protocol as _, read_enveloped};

/// Compression for frames of any length, at the fastest level.
pub(super) const GZIP: Gzip = Gzip { from_bytes: 0, level: 1 };

/// Decodes the next frame and its message.
pub(super) fn read<M: Message>(decoder: &mut Decoder<Fc>) -> M {
    let frame = decoder.next().expect("a sound frame").expect("a whole frame");
    let read = read_enveloped::<ResponseEnvelope, M>(frame.body(), Fc::DEFAULTS.limits.json());
    read.expect("an envelope").body.expect("a message")
}

/// Encodes a message as a frame.
pub(super) fn encoded<M: Message>(gzip: Option<Gzip>, id: FrameId, message: &M) -> Vec<u8> {
    let mut frame = Vec::new();
    let encoder = &mut Encoder::<Fc>::new().gzip(gzip);
    encoder.message(&mut frame, id, &messages::envelope(), message).expect("it fits");
    frame
}
