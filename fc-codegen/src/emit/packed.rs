//! Frames with the same bytes on every machine, also where their data is compressed.

use fc_reflect::{FrameId, Reflector};
use fc_spec::model::EncodingRole;
use miniz_oxide::deflate::compress_to_vec;

/// Balance of size and speed; part of the bytes, so never changed lightly.
const LEVEL: u8 = 6;

/// A frame around `plain` data, packed in this way also where that is longer.
pub(super) fn frame(
    reflector: &Reflector<'_>,
    id: FrameId,
    encoding: EncodingRole,
    plain: &[u8],
) -> Vec<u8> {
    match encoding {
        EncodingRole::Plain => reflector.seal_as_sent(id, encoding, plain, plain.len()),
        EncodingRole::Gzip => reflector.seal_as_sent(id, encoding, &gzip(plain), plain.len()),
    }
}

/// One gzip member (RFC 1952): no name, no time, operating system unknown.
pub(super) fn gzip(data: &[u8]) -> Vec<u8> {
    let mut out = vec![0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 255];
    out.extend(compress_to_vec(data, LEVEL));
    out.extend(crc32fast::hash(data).to_le_bytes());
    // The format counts lengths modulo 2³².
    let length = data.len() & 0xFFFF_FFFF;
    out.extend(u32::try_from(length).unwrap_or(0).to_le_bytes());
    out
}
