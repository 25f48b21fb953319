//! `frames.json`: rules of frames that hold for every operation.

use super::file::contents;
use super::frame_faults;
use crate::emit::json::{hex, int, object, text};
use crate::emit::packed::{frame, gzip};
use crate::sample::{Profile, SAMPLE_ID};
use fc_reflect::{FrameId, HeaderContent, Reflector};
use fc_spec::model::{
    Direction, EncodingRole, Frame, HeaderQuirk, HeaderRole, Kind, Model, RangeUse, Value,
};
use std::ops::RangeInclusive;

pub(super) fn file(reflector: &Reflector<'_>) -> Value {
    let frames = Frames::new(reflector);
    let version = &reflector.model().protocol.version;
    contents(Some(version), None, frames.accepted(), frames.rejected())
}

/// Adds a frame that must be refused: the error, a name, and the whole input.
type Push<'p> = &'p mut dyn FnMut(&str, &str, &[u8]);

struct Frames<'a, 'm> {
    reflector: &'a Reflector<'m>,
    model: &'m Model,
    layout: &'m Frame,
    /// A request with only an envelope.
    request: Vec<u8>,
    response: Vec<u8>,
    unknown_code: u16,
}

impl<'a, 'm> Frames<'a, 'm> {
    fn new(reflector: &'a Reflector<'m>) -> Self {
        let envelope = |direction| {
            let none = Value::Object(Vec::new());
            let samples = reflector.samples();
            let message = samples.enveloped(direction, none, Profile::Example);
            message.to_string().into_bytes()
        };
        let model = reflector.model();
        Self {
            reflector,
            model,
            layout: &model.frame,
            request: envelope(Direction::Request),
            response: envelope(Direction::Response),
            unknown_code: unknown_code(model),
        }
    }

    fn id(&self, kind: Kind, direction: Direction) -> FrameId {
        FrameId {
            direction,
            kind: self.layout.kinds.of(kind).value,
            code: self.unknown_code,
            id: SAMPLE_ID,
        }
    }

    /// Returns an uncompressed request with an unknown code.
    fn command(&self) -> Vec<u8> {
        let id = self.id(Kind::Command, Direction::Request);
        frame(self.reflector, id, EncodingRole::Plain, &self.request)
    }

    fn gzipped(&self, packed: &[u8], plain_len: usize) -> Vec<u8> {
        let id = self.id(Kind::Command, Direction::Request);
        let reflector = self.reflector;
        reflector.seal_as_sent(id, EncodingRole::Gzip, packed, plain_len)
    }

    /// Returns the request with another integer in its header.
    fn command_with(&self, role: HeaderRole, value: u64) -> Vec<u8> {
        let mut frame = self.command();
        self.reflector.overwrite(&mut frame, role, value);
        frame
    }

    fn accepted(&self) -> Vec<Value> {
        use Direction::{Request, Response};
        use EncodingRole::{Gzip, Plain};
        let mut entries = Vec::new();
        let mut push = |name: &str, frame: &[u8]| entries.extend(self.accepted_entry(name, frame));
        let binary: Vec<u8> = (0..=u8::MAX).collect();
        let of = |kind, direction, encoding, data: &[u8]| {
            frame(self.reflector, self.id(kind, direction), encoding, data)
        };
        for (name, kind, direction, data) in [
            ("command_request", Kind::Command, Request, &self.request),
            ("command_response", Kind::Command, Response, &self.response),
            ("report_request", Kind::Report, Request, &self.request),
            ("report_response", Kind::Report, Response, &self.response),
            ("stream_request", Kind::Stream, Request, &binary),
            ("stream_response", Kind::Stream, Response, &binary),
        ] {
            push(name, &of(kind, direction, Plain, data));
            if self.compresses() {
                push(&format!("{name}_gzip"), &of(kind, direction, Gzip, data));
            }
            push(&format!("{name}_empty"), &of(kind, direction, Plain, &[]));
        }
        if self.compresses() {
            push("empty_gzip", &of(Kind::Command, Request, Gzip, &[]));
        }
        let mut push_with = |name, role, value| push(name, &self.command_with(role, value));
        if let Some(code) = pass_through_code(self.model) {
            push_with("pass_through_code", HeaderRole::Code, code.into());
        }
        push_with("id_zero", HeaderRole::Id, 0);
        push_with("id_largest", HeaderRole::Id, u32::MAX.into());
        if self.layout.field(HeaderRole::Status).is_some() {
            push_with("status_kept", HeaderRole::Status, 7);
        }
        if self.zero_when_plain() {
            push_with("quirk_zero_plain_length", HeaderRole::PlainLength, 0);
        }
        entries
    }

    fn rejected(&self) -> Vec<Value> {
        let mut entries = Vec::new();
        let push: Push<'_> = &mut |error, name, frame| {
            entries.push(object([
                ("name", text(name)),
                ("direction", text(Direction::Request.name())),
                ("frame", text(&hex(frame))),
                ("error", text(error)),
            ]));
        };
        self.length_faults(push);
        self.header_faults(push);
        self.data_faults(push);
        entries
    }

    /// Adds wrong lengths and truncated input.
    fn length_faults(&self, push: Push<'_>) {
        let good = self.command();
        let end = u64::try_from(good.len()).unwrap_or(u64::MAX);
        let too_long = u64::from(self.model.limits.frame_bytes) + 1;
        let total = |value| self.command_with(HeaderRole::TotalLength, value);
        let until = |end: usize| good.get(..end).unwrap_or_default();
        let short = frame_faults::short(self.reflector, good.clone());
        push("short_frame", "short_frame", &short);
        push("short_frame", "zero_length", &total(0));
        push("frame_too_long", "frame_too_long", &total(too_long));
        push("frame_too_long", "largest_length", &total(u32::MAX.into()));
        push("truncated", "truncated_head", until(1));
        let header = self.layout.header_len();
        let most_of_header = until(header.saturating_sub(1));
        push("truncated", "truncated_header", most_of_header);
        push("truncated", "truncated_data", until(good.len() - 1));
        push("truncated", "length_past_the_end", &total(end + 1));
    }

    fn header_faults(&self, push: Push<'_>) {
        let good = self.command();
        let bad_head = frame_faults::bad_head(self.reflector, good.clone());
        push("bad_head", "bad_head", &bad_head);
        if self.has(HeaderRole::Encoding) {
            let encoding = frame_faults::unknown_encoding(self.reflector, good);
            push("unknown_encoding", "unknown_encoding", &encoding);
        }
        let with_kind = |value: u8| self.command_with(HeaderRole::Kind, value.into());
        let kinds = &self.layout.kinds;
        let is_unknown = |value: &u8| kinds.with_value(*value).is_none();
        if let Some(value) = (0..=u8::MAX).find(is_unknown) {
            push("unknown_kind", "unknown_kind", &with_kind(value));
        }
        for kind in &kinds.reserved {
            let name = format!("reserved_kind_{}", kind.name);
            push("reserved_kind", &name, &with_kind(kind.value));
        }
    }

    /// Adds digests, plain lengths and gzip members that do not match the data.
    fn data_faults(&self, push: Push<'_>) {
        let good = self.command();
        if self.has(HeaderRole::Digest) {
            let digest = frame_faults::bad_digest(self.reflector, good.clone());
            push("bad_digest", "bad_digest", &digest);
            push("bad_digest", "changed_data", &flipped(&good, 1));
        }
        let mismatch = "plain_length_mismatch";
        let plain_length = |value| self.command_with(HeaderRole::PlainLength, value);
        if self.has(HeaderRole::PlainLength) {
            let next = u64::try_from(self.request.len() + 1).unwrap_or(u64::MAX);
            push(mismatch, "plain_length_wrong", &plain_length(next));
        }
        if self.compresses() {
            self.gzip_faults(push);
        }
        if self.has(HeaderRole::PlainLength) && !self.zero_when_plain() {
            push(mismatch, "zero_plain_length", &plain_length(0));
        }
    }

    /// Adds invalid gzip members, and members that do not match the plain length.
    fn gzip_faults(&self, push: Push<'_>) {
        let packed = gzip(&self.request);
        let len = self.request.len();
        let mismatch = "plain_length_mismatch";
        let gzipped = |data: &[u8], length| self.gzipped(data, length);
        let short = gzipped(&packed, len.saturating_sub(1));
        push(mismatch, "gzip_plain_length_short", &short);
        let long = gzipped(&packed, len + 1);
        push(mismatch, "gzip_plain_length_long", &long);
        let plain = gzipped(&self.request, len);
        push("bad_gzip", "gzip_of_plain_text", &plain);
        let cut_off = packed.get(..packed.len() / 2).unwrap_or_default();
        push("bad_gzip", "gzip_cut_off", &gzipped(cut_off, len));
        let checksum = flipped(&packed, 8);
        push("bad_gzip", "gzip_bad_checksum", &gzipped(&checksum, len));
        push("bad_gzip", "gzip_without_data", &gzipped(&[], 0));
        if let Some(too_long) = self.model.limits.inflated_bytes.checked_add(1) {
            // The header is enough to refuse it, so a decoder need not decompress the data.
            let mut frame = gzipped(&packed, len);
            let role = HeaderRole::PlainLength;
            self.reflector.overwrite(&mut frame, role, too_long.into());
            push("inflated_too_long", "inflated_too_long", &frame);
        }
    }

    fn has(&self, role: HeaderRole) -> bool {
        self.layout.field(role).is_some()
    }

    fn compresses(&self) -> bool {
        self.layout.encoding(EncodingRole::Gzip).is_some()
    }

    /// Returns `None` for a frame that the limits of the spec do not allow.
    fn accepted_entry(&self, name: &str, bytes: &[u8]) -> Option<Value> {
        let frame = self.reflector.frame(bytes).ok()?;
        let content = |role: HeaderRole| {
            let field = frame.field(role)?;
            let value = match &field.content {
                HeaderContent::Int(value) if role != HeaderRole::Digest => int(*value),
                // A digest is shown as its bytes in the frame.
                _ => text(&hex(bytes.get(field.span.clone()).unwrap_or_default())),
            };
            Some((role.name().to_owned(), value))
        };
        let roles = [
            HeaderRole::Kind,
            HeaderRole::Code,
            HeaderRole::Id,
            HeaderRole::Encoding,
            HeaderRole::TotalLength,
            HeaderRole::PlainLength,
            HeaderRole::Digest,
        ];
        let header = roles.into_iter().filter_map(content).collect();
        Some(object([
            ("name", text(name)),
            ("direction", text(frame.id.direction.name())),
            ("case", text("frame")),
            ("frame", text(&hex(bytes))),
            ("header", Value::Object(header)),
            ("data", text(&hex(&frame.data))),
        ]))
    }

    fn zero_when_plain(&self) -> bool {
        self.layout.has_quirk(HeaderQuirk::ZeroWhenPlain)
    }
}

/// Returns the ranges of pass-through codes.
fn passed_through(model: &Model) -> impl Iterator<Item = RangeInclusive<u16>> {
    let ranges = model.ranges.iter();
    let ranges = ranges.filter(|range| range.usage == RangeUse::PassThrough);
    ranges.map(|range| range.first..=range.last)
}

/// Returns the largest code without an operation outside all pass-through ranges.
fn unknown_code(model: &Model) -> u16 {
    let taken = model.taken_codes();
    let is_passed = |code: &u16| passed_through(model).any(|range| range.contains(code));
    let mut codes = (0..=u16::MAX).rev();
    let free = codes.find(|code| !taken.contains(code) && !is_passed(code));
    free.unwrap_or(u16::MAX)
}

/// Returns a pass-through code without an operation.
fn pass_through_code(model: &Model) -> Option<u16> {
    let taken = model.taken_codes();
    passed_through(model)
        .flatten()
        .find(|code| !taken.contains(code))
}

/// Returns a copy with one bit changed, `from_end` bytes before the end.
fn flipped(bytes: &[u8], from_end: usize) -> Vec<u8> {
    let mut copy = bytes.to_vec();
    if let Some(byte) = bytes
        .len()
        .checked_sub(from_end)
        .and_then(|index| copy.get_mut(index))
    {
        *byte ^= 1;
    }
    copy
}
