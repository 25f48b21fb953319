//! Decodes a capture as a tool does: frames, then their bodies by operation, and back to frames.
//!
//! Input: a byte of flags, then the capture.

use crate::input::Input;
use fc_generated::Fc;
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{BodyInfo, Decoder, Encoder, FrameId, Gzip, OperationKind, Protocol};

/// Checks that a written body reads and writes the same again, and passes unchanged through a compressed frame.
pub fn decode(data: &[u8]) {
    let mut input = Input::new(data);
    let flags = input.byte();
    let mut decoder = Decoder::<Fc>::new()
        .verify_digest(flags & 1 != 0)
        .resync(flags & 2 != 0);
    decoder.push(input.rest());
    loop {
        match decoder.next() {
            Ok(None) => break,
            Ok(Some(frame)) => {
                let (id, body) = (frame.id(), frame.body().to_vec());
                read(id, &body);
            }
            Err(error) => {
                assert!(!error.name().is_empty() && !error.to_string().is_empty());
                if error.is_fatal() {
                    break;
                }
            }
        }
    }
    let _ = decoder.finish();
}

fn info(id: FrameId) -> Option<BodyInfo> {
    let kind = match id.kind {
        Fc::COMMAND => OperationKind::Command,
        Fc::REPORT => OperationKind::Report,
        _ => return None,
    };
    let operation = OPERATIONS
        .iter()
        .find(|o| o.code == Some(id.code) && o.kind == kind)?;
    Some(if id.response {
        operation.response
    } else {
        operation.request
    })
}

fn read(id: FrameId, body: &[u8]) {
    let Some(info) = info(id) else { return };
    let Ok(text) = (info.transcode)(body) else {
        return;
    };
    assert_eq!((info.transcode)(&text).as_ref(), Ok(&text), "not canonical");
    let mut bytes = Vec::new();
    let mut encoder = Encoder::<Fc>::new().gzip(Gzip {
        from_bytes: 64,
        level: 1,
    });
    encoder
        .bytes(&mut bytes, id, &text)
        .expect("no longer than what came");
    let mut decoder = Decoder::<Fc>::new();
    decoder.push(&bytes);
    let frame = decoder
        .next()
        .expect("a frame made here")
        .expect("a whole one");
    assert_eq!((frame.id(), frame.body()), (id, text.as_slice()));
}
