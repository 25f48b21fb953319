//! Reads and writes frames with the header layout of the model.

use crate::error::{FrameError, FrameFault};
use crate::id::FrameId;
use crate::limits::Limits;
use crate::plan::{FramePlan, Plan};
use fc_runtime::frame::{Deflater, InflateError, Inflater};
use fc_spec::model::{
    DigestAlgorithm, Direction, Encoding, EncodingRole, FrameKind, HeaderField, HeaderQuirk,
    HeaderRole, HeaderType, KindRole, Operation,
};
use md5::{Digest as _, Md5};
use std::fmt;
use std::ops::Range;

/// Up to this size, decompressed data may have any compression ratio.
const INFLATE_FREE: u64 = 1 << 20;

/// The packing of the data in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Packing {
    /// Uncompressed.
    #[default]
    Plain,
    /// One gzip member, if it is shorter than the data.
    Gzip {
        /// The level from 1 (fast) to 9 (small).
        level: u8,
    },
}

/// A frame that has been read.
#[derive(Clone)]
pub struct Frame<'m> {
    /// The message that the frame belongs to.
    pub id: FrameId,
    /// All fields of the header, in order.
    pub header: Vec<HeaderValue<'m>>,
    /// The kind of the frame in the spec.
    pub kind: &'m FrameKind,
    /// The encoding of the data in the spec.
    pub encoding: Option<&'m Encoding>,
    /// The operation with this kind and code, or `None` if the spec has none.
    pub operation: Option<&'m Operation>,
    /// The length of the whole frame in bytes. The next frame of a stream begins there.
    pub length: usize,
    /// The position of the data in the frame, as sent.
    pub packed: Range<usize>,
    /// The decompressed data.
    pub data: Vec<u8>,
}

impl<'m> Frame<'m> {
    /// Returns the header field with this role.
    #[must_use]
    pub fn field(&self, role: HeaderRole) -> Option<&HeaderValue<'m>> {
        let has_role = |value: &&HeaderValue<'m>| value.field.role == Some(role);
        self.header.iter().find(has_role)
    }

    /// Returns `true` if the frame belongs to a stream. Its data can be raw bytes or JSON.
    #[must_use]
    pub fn is_stream(&self) -> bool {
        self.kind.role == KindRole::Stream
    }

    /// Returns `true` if the data is JSON. Only streams whose keys the spec does not describe have other data.
    #[must_use]
    pub fn is_json(&self) -> bool {
        let body = self.operation.and_then(|it| it.body(self.id.direction));
        !self.is_stream() || body.is_some()
    }
}

/// Leaves out the data, because a body can contain values that must not be logged.
impl fmt::Debug for Frame<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Frame({}, {} bytes)", self.id, self.data.len())
    }
}

/// A header field of a frame.
#[derive(Clone, Debug)]
pub struct HeaderValue<'m> {
    /// The field in the spec, with its names, role and description.
    pub field: &'m HeaderField,
    /// The position of its bytes in the frame.
    pub span: Range<usize>,
    /// The content.
    pub content: HeaderContent,
    /// `true` if only a quirk accepts the value: a plain length of 0 with uncompressed data.
    pub lenient: bool,
}

/// The content of a header field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HeaderContent {
    /// An integer.
    Int(u64),
    /// A sequence of bytes.
    Bytes(Vec<u8>),
}

/// Reads the frame at the start of `bytes`.
pub(crate) fn read<'m>(
    plan: &Plan<'m>,
    limits: &Limits,
    bytes: &[u8],
) -> Result<Frame<'m>, FrameError> {
    let (length, direction) = locate(&plan.frame, limits, bytes)?;
    let raw = Raw {
        plan: &plan.frame,
        bytes: bytes.get(..length).unwrap_or_default(),
    };
    let narrow = |role| raw.int(role).unwrap_or(0);
    let id = FrameId {
        direction,
        kind: u8::try_from(narrow(HeaderRole::Kind)).unwrap_or(u8::MAX),
        code: u16::try_from(narrow(HeaderRole::Code)).unwrap_or(u16::MAX),
        id: u32::try_from(narrow(HeaderRole::Id)).unwrap_or(u32::MAX),
    };
    let Checked {
        kind,
        encoding,
        data,
        zero_length,
    } = raw.check(id, limits)?;
    let value = |field: &'m HeaderField| HeaderValue {
        lenient: zero_length && field.role == Some(HeaderRole::PlainLength),
        ..raw.value(field)
    };
    let operation = plan.with_code(id.kind, id.code);
    Ok(Frame {
        id,
        header: plan.frame.layout.header.iter().map(value).collect(),
        kind,
        encoding,
        operation: operation.map(|plan| plan.operation),
        length,
        packed: plan.frame.header_len..length,
        data,
    })
}

/// Returns the length of the whole frame at the start of `bytes`, and its direction.
fn locate(
    plan: &FramePlan<'_>,
    limits: &Limits,
    bytes: &[u8],
) -> Result<(usize, Direction), FrameError> {
    match announced(plan, limits, bytes)? {
        Some((length, direction)) if length <= bytes.len() => Ok((length, direction)),
        _ => {
            let count = bytes.len();
            let detail = format!("the input ends inside the frame, after {count} bytes");
            Err(FrameError::new(FrameFault::Truncated, None, detail))
        }
    }
}

/// Returns the length of the frame that begins at the start of `bytes`, and its direction. Returns `None` while the
/// field with the length is incomplete. An error is reported as soon as the bytes show it. A receiver that reads byte
/// by byte reports the same error.
pub(crate) fn announced(
    plan: &FramePlan<'_>,
    limits: &Limits,
    bytes: &[u8],
) -> Result<Option<(usize, Direction)>, FrameError> {
    let fault = |fault, detail: &str| Err(FrameError::new(fault, None, detail));
    let opens = |head: &[u8]| bytes.iter().zip(head).all(|(one, two)| one == two);
    let direction = if opens(&plan.layout.response_head) {
        Direction::Response
    } else if opens(&plan.layout.request_head) {
        Direction::Request
    } else {
        return fault(FrameFault::BadHead, "no frame begins here");
    };
    let raw = Raw { plan, bytes };
    let Some(total) = raw.int(HeaderRole::TotalLength) else {
        return Ok(None);
    };
    if total > limits.frame_bytes.into() {
        let limit = limits.frame_bytes;
        let detail = format!("the frame has {total} bytes, more than the limit of {limit}");
        return fault(FrameFault::FrameTooLong, &detail);
    }
    let length = usize::try_from(total).unwrap_or(usize::MAX);
    if length < plan.header_len {
        let detail = format!(
            "the frame claims {total} bytes in all, less than its header of {}",
            plan.header_len
        );
        return fault(FrameFault::ShortFrame, &detail);
    }
    Ok(Some((length, direction)))
}

/// Returns the header fields whose bytes are all present, in order.
pub(crate) fn header<'m>(plan: &FramePlan<'m>, bytes: &[u8]) -> Vec<HeaderValue<'m>> {
    let raw = Raw { plan, bytes };
    let fields = plan.layout.header.iter();
    let fields = fields.take_while(|field| field.place().end <= bytes.len());
    fields.map(|field| raw.value(field)).collect()
}

/// The bytes of a header.
struct Raw<'p, 'm, 'b> {
    plan: &'p FramePlan<'m>,
    bytes: &'b [u8],
}

/// The result of checking a frame.
struct Checked<'m> {
    kind: &'m FrameKind,
    encoding: Option<&'m Encoding>,
    data: Vec<u8>,
    /// `true` if a plain length of 0 was accepted.
    zero_length: bool,
}

impl<'m> Raw<'_, 'm, '_> {
    /// Returns the integer in the field with this role. Returns `None` if the field does not exist or its bytes are
    /// missing.
    fn int(&self, role: HeaderRole) -> Option<u64> {
        self.int_in(self.plan.layout.field(role)?)
    }

    fn int_in(&self, field: &HeaderField) -> Option<u64> {
        let bytes = self.bytes.get(field.place())?.iter();
        let push = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        Some(if self.plan.big_endian {
            bytes.fold(0, push)
        } else {
            bytes.rev().fold(0, push)
        })
    }

    /// Returns a field as if no quirk accepted its value.
    fn value(&self, field: &'m HeaderField) -> HeaderValue<'m> {
        HeaderValue {
            field,
            span: field.place(),
            content: self.content(field),
            lenient: false,
        }
    }

    fn content(&self, field: &HeaderField) -> HeaderContent {
        let bytes = self.bytes.get(field.place()).unwrap_or_default();
        match field.ty {
            HeaderType::Bytes(_) => HeaderContent::Bytes(bytes.to_vec()),
            _ => HeaderContent::Int(self.int_in(field).unwrap_or(0)),
        }
    }

    /// Checks a whole frame and decompresses it. The order of the checks decides which of several errors is reported.
    fn check(&self, id: FrameId, limits: &Limits) -> Result<Checked<'m>, FrameError> {
        let fault = |fault, detail: String| Err(FrameError::new(fault, Some(id), detail));
        let kind = match self.plan.kind(id.kind) {
            Some(kind) if kind.role == KindRole::Reserved => {
                let detail = format!("the kind `{}` is reserved", kind.name);
                return fault(FrameFault::ReservedKind, detail);
            }
            Some(kind) => kind,
            None => {
                let detail = format!("there is no kind {}", id.kind);
                return fault(FrameFault::UnknownKind, detail);
            }
        };
        // Without an encoding field, the data is uncompressed.
        let encoding = match self.int(HeaderRole::Encoding) {
            Some(value) => {
                let mut encodings = self.plan.layout.encodings.iter();
                let Some(known) = encodings.find(|known| u64::from(known.value) == value) else {
                    let detail = format!("there is no encoding {value}");
                    return fault(FrameFault::UnknownEncoding, detail);
                };
                Some(known)
            }
            None => None,
        };
        let data = self.bytes.get(self.plan.header_len..).unwrap_or_default();
        if let Some(field) = self.plan.layout.field(HeaderRole::Digest)
            && self.content(field) != digest(field, data)
        {
            let detail = "the digest is not that of the data";
            return fault(FrameFault::BadDigest, detail.to_owned());
        }
        let checked = |data, zero_length| Checked {
            kind,
            encoding,
            data,
            zero_length,
        };
        let length = data.len() as u64;
        let field = self.plan.layout.field(HeaderRole::PlainLength);
        let plain = self.int(HeaderRole::PlainLength);
        if encoding.is_none_or(|encoding| encoding.role == EncodingRole::Plain) {
            let zero = plain == Some(0)
                && field.is_some_and(|field| field.has_quirk(HeaderQuirk::ZeroWhenPlain));
            return match plain {
                Some(plain) if plain != length && !zero => {
                    let detail =
                        format!("the plain length is {plain}, the data has {length} bytes");
                    fault(FrameFault::PlainLengthMismatch, detail)
                }
                _ => Ok(checked(data.to_vec(), zero && length > 0)),
            };
        }
        let plain = plain.unwrap_or(limits.inflated_bytes.into());
        if plain > limits.inflated_bytes.into() {
            let limit = limits.inflated_bytes;
            let detail =
                format!("{plain} bytes after decompression, more than the limit of {limit}");
            return fault(FrameFault::InflatedTooLong, detail);
        }
        let most = u64::from(limits.inflate_ratio).saturating_mul(length);
        if kind.role != KindRole::Stream && plain > INFLATE_FREE && plain > most {
            let limit = limits.inflate_ratio;
            let detail = format!("{plain} bytes of {length}, more than {limit} times as many");
            return fault(FrameFault::InflatesTooMuch, detail);
        }
        let room = usize::try_from(plain).unwrap_or(usize::MAX);
        let mut inflated = Vec::new();
        match Inflater::default().inflate(data, room, &mut inflated) {
            Ok(()) => Ok(checked(inflated, false)),
            Err(InflateError::Damaged) => {
                let detail = "the data is not one intact gzip member";
                fault(FrameFault::BadGzip, detail.to_owned())
            }
            Err(InflateError::Length) => {
                let detail = format!("the data does not inflate to the plain length of {plain}");
                fault(FrameFault::PlainLengthMismatch, detail)
            }
        }
    }
}

/// Returns the content of a digest field for data.
fn digest(field: &HeaderField, data: &[u8]) -> HeaderContent {
    match field.digest() {
        Some(DigestAlgorithm::Crc32) => HeaderContent::Int(crc32fast::hash(data).into()),
        Some(DigestAlgorithm::Md5) | None => HeaderContent::Bytes(Md5::digest(data).to_vec()),
    }
}

/// Builds a frame around data, with packing, lengths and digest.
pub(crate) fn write(
    plan: &FramePlan<'_>,
    limits: &Limits,
    id: FrameId,
    data: &[u8],
    packing: Packing,
) -> Result<Vec<u8>, FrameError> {
    let mut member = Vec::new();
    let (encoding, sent) = match packing {
        Packing::Gzip { level }
            if plan.layout.encoding(EncodingRole::Gzip).is_some()
                && Deflater::new(level).member(data, &mut member) =>
        {
            (EncodingRole::Gzip, &*member)
        }
        _ => (EncodingRole::Plain, data),
    };
    let total = plan.header_len.saturating_add(sent.len()) as u64;
    if total > limits.frame_bytes.into() || data.len() as u64 > u32::MAX.into() {
        let limit = limits.frame_bytes;
        let detail = format!("the frame would have {total} bytes, more than the limit of {limit}");
        return Err(FrameError::new(FrameFault::FrameTooLong, Some(id), detail));
    }
    Ok(around(plan, id, encoding, sent, data.len()))
}

/// Puts a header before packed data.
pub(crate) fn around(
    plan: &FramePlan<'_>,
    id: FrameId,
    encoding: EncodingRole,
    sent: &[u8],
    plain_length: usize,
) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(plan.header_len + sent.len());
    bytes.resize(plan.header_len, 0);
    bytes.extend_from_slice(sent);
    for field in &plan.layout.header {
        let content = match field.role {
            Some(HeaderRole::Head) => HeaderContent::Bytes(match id.direction {
                Direction::Request => plan.layout.request_head.clone(),
                Direction::Response => plan.layout.response_head.clone(),
            }),
            Some(HeaderRole::Kind) => HeaderContent::Int(id.kind.into()),
            Some(HeaderRole::Code) => HeaderContent::Int(id.code.into()),
            Some(HeaderRole::Id) => HeaderContent::Int(id.id.into()),
            Some(HeaderRole::Encoding) => {
                let encoding = plan.layout.encoding(encoding);
                HeaderContent::Int(encoding.map_or(0, |encoding| encoding.value.into()))
            }
            Some(HeaderRole::TotalLength) => HeaderContent::Int(bytes.len() as u64),
            Some(HeaderRole::PlainLength) => HeaderContent::Int(plain_length as u64),
            Some(HeaderRole::Digest) => digest(field, sent),
            // A byte field is sent as zeros.
            Some(HeaderRole::Status) | None => match field.ty {
                HeaderType::Bytes(_) => HeaderContent::Bytes(Vec::new()),
                _ => HeaderContent::Int(field.value),
            },
        };
        put(plan, &mut bytes, field, &content);
    }
    bytes
}

/// Overwrites the integer in the header field with this role, if the field exists.
pub(crate) fn overwrite(plan: &FramePlan<'_>, frame: &mut [u8], role: HeaderRole, value: u64) {
    if let Some(field) = plan.layout.field(role) {
        put(plan, frame, field, &HeaderContent::Int(value));
    }
}

fn put(plan: &FramePlan<'_>, bytes: &mut [u8], field: &HeaderField, content: &HeaderContent) {
    let Some(place) = bytes.get_mut(field.place()) else {
        return;
    };
    match content {
        HeaderContent::Bytes(content) => {
            for (byte, new) in place.iter_mut().zip(content) {
                *byte = *new;
            }
        }
        HeaderContent::Int(value) => {
            let low_first = value.to_le_bytes();
            for (byte, low) in place.iter_mut().rev().zip(low_first) {
                *byte = low;
            }
            if !plan.big_endian {
                place.reverse();
            }
        }
    }
}
