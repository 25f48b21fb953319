//! Frames of an operation that a reader must refuse before it reads the body.

use super::case::Case;
use crate::emit::json::{hex, text};
use crate::emit::packed;
use fc_reflect::Reflector;
use fc_spec::model::{EncodingRole, HeaderRole, Value};

/// Returns a refused frame for each error. Returns none if the operation has no code.
pub(super) fn of_operation(case: &Case<'_, '_>, data: &[u8]) -> Vec<Value> {
    let reflector = case.reflector;
    let Some(id) = case.id() else {
        return Vec::new();
    };
    let good = packed::frame(reflector, id, EncodingRole::Plain, data);
    let layout = &reflector.model().frame;
    let mut faults = vec![
        ("bad_head", bad_head(reflector, good.clone())),
        ("short_frame", short(reflector, good.clone())),
        ("truncated", truncated(good.clone())),
    ];
    if layout.field(HeaderRole::Encoding).is_some() {
        faults.push((
            "unknown_encoding",
            unknown_encoding(reflector, good.clone()),
        ));
    }
    if layout.field(HeaderRole::Digest).is_some() {
        faults.push(("bad_digest", bad_digest(reflector, good)));
    }
    let entry = |(error, frame): (&'static str, Vec<u8>)| {
        case.rejected(error, ("frame", text(&hex(&frame))), error)
    };
    faults.into_iter().map(entry).collect()
}

/// Changes the first byte, so that it starts neither head.
pub(super) fn bad_head(reflector: &Reflector<'_>, mut frame: Vec<u8>) -> Vec<u8> {
    let layout = &reflector.model().frame;
    let heads = [layout.request_head.first(), layout.response_head.first()];
    let other = (0..=u8::MAX).find(|byte| !heads.contains(&Some(byte)));
    if let (Some(first), Some(other)) = (frame.first_mut(), other) {
        *first = other;
    }
    frame
}

/// Sets the total length to less than that of the header.
pub(super) fn short(reflector: &Reflector<'_>, mut frame: Vec<u8>) -> Vec<u8> {
    let header = reflector.model().frame.header_len();
    let length = u64::try_from(header.saturating_sub(1)).unwrap_or(0);
    reflector.overwrite(&mut frame, HeaderRole::TotalLength, length);
    frame
}

/// Removes the last byte.
pub(super) fn truncated(mut frame: Vec<u8>) -> Vec<u8> {
    frame.pop();
    frame
}

/// Sets an encoding that the spec does not have.
pub(super) fn unknown_encoding(reflector: &Reflector<'_>, mut frame: Vec<u8>) -> Vec<u8> {
    let encodings = &reflector.model().frame.encodings;
    let known = |value: &u8| encodings.iter().any(|encoding| encoding.value == *value);
    if let Some(value) = (0..=u8::MAX).find(|value| !known(value)) {
        reflector.overwrite(&mut frame, HeaderRole::Encoding, value.into());
    }
    frame
}

/// Changes one bit of the digest.
pub(super) fn bad_digest(reflector: &Reflector<'_>, mut frame: Vec<u8>) -> Vec<u8> {
    let digest = reflector.model().frame.field(HeaderRole::Digest);
    if let Some(byte) = digest.and_then(|field| frame.get_mut(field.offset)) {
        *byte ^= 1;
    }
    frame
}
