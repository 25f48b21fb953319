//! Frames of an operation that must be refused before their body is looked at.

use super::Case;
use super::values::text;
use crate::sample::frame::{FrameBytes, frame};
use fc_spec::model::{EncodingRole, Frame, HeaderRole, Value};

/// One refused frame per fault; nothing while the operation has no code.
pub(super) fn of_operation(case: &Case<'_, '_>, data: &[u8]) -> Vec<Value> {
    let layout = &case.samples.model().frame;
    let Some(input) = case.input(EncodingRole::Plain) else {
        return Vec::new();
    };
    let good = frame(layout, input, data);
    let faults = [
        ("bad_head", bad_head(layout, good.clone())),
        ("short_frame", short(layout, good.clone())),
        ("truncated", truncated(good.clone())),
        ("unknown_encoding", unknown_encoding(layout, good.clone())),
        ("bad_digest", bad_digest(layout, good)),
    ];
    let entry = |(error, frame): (&'static str, FrameBytes)| {
        case.rejected(error, ("frame", text(&frame.hex())), error)
    };
    faults.into_iter().map(entry).collect()
}

/// The first byte is that of neither head.
pub(super) fn bad_head(layout: &Frame, mut frame: FrameBytes) -> FrameBytes {
    let heads = [layout.request_head.first(), layout.response_head.first()];
    let other = (0..=u8::MAX).find(|byte| !heads.contains(&Some(byte)));
    if let (Some(first), Some(other)) = (frame.bytes.first_mut(), other) {
        *first = other;
    }
    frame
}

/// The total length does not even reach the end of the header.
pub(super) fn short(layout: &Frame, mut frame: FrameBytes) -> FrameBytes {
    let length = u64::try_from(layout.header_len().saturating_sub(1)).unwrap_or(0);
    frame.set(layout, HeaderRole::TotalLength, length);
    frame
}

/// The input ends one byte early.
pub(super) fn truncated(mut frame: FrameBytes) -> FrameBytes {
    frame.bytes.pop();
    frame
}

/// An encoding that the spec does not list.
pub(super) fn unknown_encoding(layout: &Frame, mut frame: FrameBytes) -> FrameBytes {
    let known = |value: &u8| {
        layout
            .encodings
            .iter()
            .any(|encoding| encoding.value == *value)
    };
    if let Some(value) = (0..=u8::MAX).find(|value| !known(value)) {
        frame.set(layout, HeaderRole::Encoding, value.into());
    }
    frame
}

/// One bit of the digest is wrong.
pub(super) fn bad_digest(layout: &Frame, mut frame: FrameBytes) -> FrameBytes {
    let place = frame.field(layout, HeaderRole::Digest);
    if let Some(byte) = place.and_then(|place| frame.bytes.get_mut(place.start)) {
        *byte ^= 1;
    }
    frame
}
