//! Frames, laid out as the model says.

use super::gzip;
use fc_spec::model::{
    ByteOrder, Direction, EncodingRole, Frame, HeaderField, HeaderRole, HeaderType, Kind, KindRole,
    Operation,
};
use md5::{Digest as _, Md5};
use std::ops::Range;

/// The id in every composed frame: what the app's clock-based ids give at 09:08:42.323.
pub const SAMPLE_ID: u32 = 90_842_323;

/// What a frame says besides its data.
#[derive(Clone, Copy, Debug)]
pub struct FrameInput {
    /// Chooses the head.
    pub direction: Direction,
    /// Value of the kind field.
    pub kind: u8,
    /// Command code.
    pub code: u16,
    /// Ties a response to its request.
    pub id: u32,
    /// How the data is packed.
    pub encoding: EncodingRole,
}

/// A frame and where its parts lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameBytes {
    /// Header and data.
    pub bytes: Vec<u8>,
    /// Bytes of each header field, in the order of `Frame::header`.
    pub fields: Vec<Range<usize>>,
    /// Bytes of the data area.
    pub data: Range<usize>,
}

impl FrameInput {
    /// What the frames of an operation say; `None` while it has no code.
    #[must_use]
    pub fn of(
        layout: &Frame,
        operation: &Operation,
        direction: Direction,
        encoding: EncodingRole,
    ) -> Option<Self> {
        let role = match operation.kind {
            Kind::Command => KindRole::Command,
            Kind::Report => KindRole::Report,
            Kind::Stream => KindRole::Stream,
        };
        Some(Self {
            direction,
            kind: layout.kind(role)?.value,
            code: operation.code.value?,
            id: SAMPLE_ID,
            encoding,
        })
    }
}

impl FrameBytes {
    /// Overwrites an integer of the header, keeping its low bytes.
    pub fn set(&mut self, frame: &Frame, role: HeaderRole, value: u64) {
        if let Some(range) = self.field(frame, role) {
            put_int(&mut self.bytes, range, value, frame.byte_order);
        }
    }

    /// The integer in the header field with this role; 0 if there is none.
    #[must_use]
    pub fn int(&self, frame: &Frame, role: HeaderRole) -> u64 {
        let place = self.field(frame, role).unwrap_or_default();
        let bytes = self.slice(place).iter();
        let push = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        match frame.byte_order {
            ByteOrder::Big => bytes.fold(0, push),
            ByteOrder::Little => bytes.rev().fold(0, push),
        }
    }

    /// Where the header field with this role lies.
    #[must_use]
    pub fn field(&self, frame: &Frame, role: HeaderRole) -> Option<Range<usize>> {
        let index = frame
            .header
            .iter()
            .position(|field| field.role == Some(role))?;
        self.fields.get(index).cloned()
    }

    /// The bytes of a part; empty for a range that is not of this frame.
    #[must_use]
    pub fn slice(&self, range: Range<usize>) -> &[u8] {
        self.bytes.get(range).unwrap_or_default()
    }

    /// Lower-case hexadecimal digits.
    #[must_use]
    pub fn hex(&self) -> String {
        hex(&self.bytes)
    }
}

/// Lower-case hexadecimal digits.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(bytes.len() * 2);
    let digit = |half: u8| {
        char::from(if half < 10 {
            b'0' + half
        } else {
            b'a' - 10 + half
        })
    };
    for byte in bytes {
        out.push(digit(byte >> 4));
        out.push(digit(byte & 0xF));
    }
    out
}

/// A frame around `plain` data: packed as `input.encoding` says, lengths and digest in place.
#[must_use]
pub fn frame(layout: &Frame, input: FrameInput, plain: &[u8]) -> FrameBytes {
    let packed = match input.encoding {
        EncodingRole::Plain => plain.to_vec(),
        EncodingRole::Gzip => gzip(plain),
    };
    frame_around(layout, input, &packed, plain.len())
}

/// A frame around data as it is sent, whatever its encoding; lengths and digest in place.
#[must_use]
pub fn frame_around(
    layout: &Frame,
    input: FrameInput,
    packed: &[u8],
    plain_len: usize,
) -> FrameBytes {
    let header_len = layout.header_len();
    let mut bytes = vec![0; header_len];
    bytes.extend_from_slice(packed);
    let mut fields = Vec::with_capacity(layout.header.len());
    let mut start = 0;
    for field in &layout.header {
        let range = start..start + field.ty.size();
        start = range.end;
        match content(layout, field, input, packed, plain_len) {
            Content::Int(value) => put_int(&mut bytes, range.clone(), value, layout.byte_order),
            Content::Bytes(content) => put_bytes(&mut bytes, range.clone(), &content),
        }
        fields.push(range);
    }
    let data = header_len..bytes.len();
    FrameBytes {
        bytes,
        fields,
        data,
    }
}

enum Content {
    Int(u64),
    Bytes(Vec<u8>),
}

fn content(
    layout: &Frame,
    field: &HeaderField,
    input: FrameInput,
    packed: &[u8],
    plain_len: usize,
) -> Content {
    let int = |value: usize| Content::Int(u64::try_from(value).unwrap_or(u64::MAX));
    match field.role {
        Some(HeaderRole::Head) => Content::Bytes(match input.direction {
            Direction::Request => layout.request_head.clone(),
            Direction::Response => layout.response_head.clone(),
        }),
        Some(HeaderRole::Kind) => Content::Int(input.kind.into()),
        Some(HeaderRole::Code) => Content::Int(input.code.into()),
        Some(HeaderRole::Id) => Content::Int(input.id.into()),
        Some(HeaderRole::Encoding) => {
            let encoding = layout.encoding(input.encoding);
            Content::Int(encoding.map_or(0, |encoding| encoding.value.into()))
        }
        Some(HeaderRole::TotalLength) => int(layout.header_len() + packed.len()),
        Some(HeaderRole::PlainLength) => int(plain_len),
        Some(HeaderRole::Digest) => Content::Bytes(Md5::digest(packed).to_vec()),
        Some(HeaderRole::Status) | None => match field.ty {
            // No byte order applies to a run of bytes: its last bytes hold the constant.
            HeaderType::Bytes(len) => {
                let value = field.value.to_be_bytes();
                let mut content = vec![0; len.saturating_sub(value.len())];
                content.extend(
                    value
                        .get(value.len().saturating_sub(len)..)
                        .unwrap_or_default(),
                );
                Content::Bytes(content)
            }
            _ => Content::Int(field.value),
        },
    }
}

fn put_int(bytes: &mut [u8], range: Range<usize>, value: u64, order: ByteOrder) {
    let Some(place) = bytes.get_mut(range) else {
        return;
    };
    let low_first = value.to_le_bytes();
    let low_first = low_first.into_iter().chain(std::iter::repeat(0));
    match order {
        ByteOrder::Little => place
            .iter_mut()
            .zip(low_first)
            .for_each(|(byte, low)| *byte = low),
        ByteOrder::Big => place
            .iter_mut()
            .rev()
            .zip(low_first)
            .for_each(|(byte, low)| *byte = low),
    }
}

fn put_bytes(bytes: &mut [u8], range: Range<usize>, content: &[u8]) {
    if let Some(place) = bytes.get_mut(range) {
        place
            .iter_mut()
            .zip(content)
            .for_each(|(byte, new)| *byte = *new);
    }
}
