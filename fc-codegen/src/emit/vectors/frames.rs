//! `frames.json`: the frame itself, whatever operation it carries.

use super::values::{int, object, text};
use super::{FORMAT, frame_faults};
use crate::sample::frame::{FrameBytes, frame, frame_around, hex};
use crate::sample::{FrameInput, Profile, SAMPLE_ID, Samples, gzip};
use fc_spec::model::{
    Direction, EncodingRole, Frame, HeaderQuirk, HeaderRole, KindRole, Model, RangeUse, Value,
};

pub(super) fn file(samples: &Samples<'_>) -> Value {
    let frames = Frames::new(samples);
    object([
        ("format", int(FORMAT)),
        ("operation", Value::Null),
        ("kind", Value::Null),
        ("code", Value::Null),
        ("accepted", Value::Array(frames.accepted())),
        ("rejected", Value::Array(frames.rejected())),
    ])
}

/// The error, a name, the frame.
type Fault = (&'static str, String, FrameBytes);

fn fault((error, name, frame): (&'static str, &str, FrameBytes)) -> Fault {
    (error, name.to_owned(), frame)
}

struct Frames<'m> {
    model: &'m Model,
    layout: &'m Frame,
    /// A request without keys of its own.
    request: Vec<u8>,
    response: Vec<u8>,
    unknown_code: u16,
}

impl<'m> Frames<'m> {
    fn new(samples: &Samples<'m>) -> Self {
        let envelope = |direction| {
            let none = Value::Object(Vec::new());
            samples
                .enveloped(direction, none, Profile::Example)
                .to_string()
                .into_bytes()
        };
        let model = samples.model();
        Self {
            model,
            layout: &model.frame,
            request: envelope(Direction::Request),
            response: envelope(Direction::Response),
            unknown_code: unknown_code(model),
        }
    }

    fn input(&self, role: KindRole, direction: Direction, encoding: EncodingRole) -> FrameInput {
        let kind = self.layout.kind(role).map_or(0, |kind| kind.value);
        FrameInput {
            direction,
            kind,
            code: self.unknown_code,
            id: SAMPLE_ID,
            encoding,
        }
    }

    /// A request that nobody knows, plain.
    fn command(&self) -> FrameBytes {
        let input = self.input(KindRole::Command, Direction::Request, EncodingRole::Plain);
        frame(self.layout, input, &self.request)
    }

    fn gzipped(&self, packed: &[u8], plain_len: usize) -> FrameBytes {
        let input = self.input(KindRole::Command, Direction::Request, EncodingRole::Gzip);
        frame_around(self.layout, input, packed, plain_len)
    }

    /// The same with one integer of its header changed.
    fn command_with(&self, role: HeaderRole, value: u64) -> FrameBytes {
        let mut frame = self.command();
        frame.set(self.layout, role, value);
        frame
    }

    fn accepted(&self) -> Vec<Value> {
        use Direction::{Request, Response};
        use EncodingRole::{Gzip, Plain};
        let mut entries = Vec::new();
        let mut push = |name: &str, frame: &FrameBytes, data: &[u8]| {
            entries.push(self.accepted_entry(name, frame, data));
        };
        let binary: Vec<u8> = (0..=u8::MAX).collect();
        let of = |role, direction, encoding, data: &[u8]| {
            frame(self.layout, self.input(role, direction, encoding), data)
        };
        for (name, role, direction, data) in [
            ("command_request", KindRole::Command, Request, &self.request),
            (
                "command_response",
                KindRole::Command,
                Response,
                &self.response,
            ),
            ("report_request", KindRole::Report, Request, &self.request),
            (
                "report_response",
                KindRole::Report,
                Response,
                &self.response,
            ),
            ("stream_request", KindRole::Stream, Request, &binary),
            ("stream_response", KindRole::Stream, Response, &binary),
        ] {
            push(name, &of(role, direction, Plain, data), data);
            push(
                &format!("{name}_gzip"),
                &of(role, direction, Gzip, data),
                data,
            );
            push(
                &format!("{name}_empty"),
                &of(role, direction, Plain, &[]),
                &[],
            );
        }
        push(
            "empty_gzip",
            &of(KindRole::Command, Request, Gzip, &[]),
            &[],
        );
        if let Some(code) = pass_through_code(self.model) {
            let frame = self.command_with(HeaderRole::Code, code.into());
            push("pass_through_code", &frame, &self.request);
        }
        for (name, id) in [("id_zero", 0), ("id_largest", u32::MAX)] {
            let frame = self.command_with(HeaderRole::Id, id.into());
            push(name, &frame, &self.request);
        }
        if self.role_is_there(HeaderRole::Status) {
            let frame = self.command_with(HeaderRole::Status, 7);
            push("status_kept", &frame, &self.request);
        }
        if self.zero_when_plain() {
            let frame = self.command_with(HeaderRole::PlainLength, 0);
            push("quirk_zero_plain_length", &frame, &self.request);
        }
        entries
    }

    fn rejected(&self) -> Vec<Value> {
        let faults = [
            self.length_faults(),
            self.header_faults(),
            self.data_faults(),
        ];
        let entry = |(error, name, frame): Fault| {
            object([
                ("name", text(&name)),
                ("direction", text(Direction::Request.name())),
                ("frame", text(&frame.hex())),
                ("error", text(error)),
            ])
        };
        faults.into_iter().flatten().map(entry).collect()
    }

    /// Lengths that lie, and input that ends too soon.
    fn length_faults(&self) -> Vec<Fault> {
        let layout = self.layout;
        let good = self.command();
        let end = u64::try_from(good.bytes.len()).unwrap_or(u64::MAX);
        let too_long = u64::from(self.model.limits.frame_bytes) + 1;
        let total = |value| self.command_with(HeaderRole::TotalLength, value);
        let header = layout.header_len();
        [
            (
                "short_frame",
                "short_frame",
                frame_faults::short(layout, good.clone()),
            ),
            ("short_frame", "zero_length", total(0)),
            ("frame_too_long", "frame_too_long", total(too_long)),
            ("frame_too_long", "largest_length", total(u32::MAX.into())),
            ("truncated", "truncated_head", cut(good.clone(), 1)),
            (
                "truncated",
                "truncated_header",
                cut(good.clone(), header.saturating_sub(1)),
            ),
            ("truncated", "truncated_data", frame_faults::truncated(good)),
            ("truncated", "length_past_the_end", total(end + 1)),
        ]
        .map(fault)
        .into()
    }

    fn header_faults(&self) -> Vec<Fault> {
        let layout = self.layout;
        let good = self.command();
        let mut faults: Vec<Fault> = [
            (
                "bad_head",
                "bad_head",
                frame_faults::bad_head(layout, good.clone()),
            ),
            (
                "unknown_encoding",
                "unknown_encoding",
                frame_faults::unknown_encoding(layout, good),
            ),
        ]
        .map(fault)
        .into();
        let with_kind = |value: u8| self.command_with(HeaderRole::Kind, value.into());
        if let Some(value) = unknown_kind(layout) {
            faults.push(("unknown_kind", "unknown_kind".to_owned(), with_kind(value)));
        }
        for kind in layout
            .kinds
            .iter()
            .filter(|kind| kind.role == KindRole::Reserved)
        {
            let name = format!("reserved_kind_{}", kind.name);
            faults.push(("reserved_kind", name, with_kind(kind.value)));
        }
        faults
    }

    /// Digests, plain lengths and gzip members that do not fit the data.
    fn data_faults(&self) -> Vec<Fault> {
        let good = self.command();
        let packed = gzip(&self.request);
        let len = self.request.len();
        let next = u64::try_from(len + 1).unwrap_or(u64::MAX);
        let cut_off = packed.get(..packed.len() / 2).unwrap_or_default();
        let digest = frame_faults::bad_digest(self.layout, good.clone());
        let plain_length = self.command_with(HeaderRole::PlainLength, next);
        let mut faults: Vec<Fault> = [
            ("bad_digest", "bad_digest", digest),
            ("bad_digest", "changed_data", changed_data(good)),
            ("plain_length_mismatch", "plain_length_wrong", plain_length),
            (
                "plain_length_mismatch",
                "gzip_plain_length_short",
                self.gzipped(&packed, len - 1),
            ),
            (
                "plain_length_mismatch",
                "gzip_plain_length_long",
                self.gzipped(&packed, len + 1),
            ),
            (
                "bad_gzip",
                "gzip_of_plain_text",
                self.gzipped(&self.request, len),
            ),
            ("bad_gzip", "gzip_cut_off", self.gzipped(cut_off, len)),
            (
                "bad_gzip",
                "gzip_bad_checksum",
                self.gzipped(&flipped(&packed, 8), len),
            ),
            ("bad_gzip", "gzip_without_data", self.gzipped(&[], 0)),
        ]
        .map(fault)
        .into();
        if let Some(too_long) = self.model.limits.inflated_bytes.checked_add(1) {
            // Refused by what the header says: a decoder need not inflate it to know.
            let mut frame = self.gzipped(&packed, len);
            frame.set(self.layout, HeaderRole::PlainLength, too_long.into());
            faults.push(("inflated_too_long", "inflated_too_long".to_owned(), frame));
        }
        if !self.zero_when_plain() {
            let frame = self.command_with(HeaderRole::PlainLength, 0);
            faults.push((
                "plain_length_mismatch",
                "zero_plain_length".to_owned(),
                frame,
            ));
        }
        faults
    }

    fn accepted_entry(&self, name: &str, frame: &FrameBytes, data: &[u8]) -> Value {
        let number = |role: HeaderRole| (role.name(), int(frame.int(self.layout, role).into()));
        let direction = if frame.bytes.starts_with(&self.layout.request_head) {
            Direction::Request
        } else {
            Direction::Response
        };
        let digest = frame
            .field(self.layout, HeaderRole::Digest)
            .unwrap_or_default();
        object([
            ("name", text(name)),
            ("direction", text(direction.name())),
            ("case", text("frame")),
            ("frame", text(&frame.hex())),
            (
                "header",
                object([
                    number(HeaderRole::Kind),
                    number(HeaderRole::Code),
                    number(HeaderRole::Id),
                    number(HeaderRole::Encoding),
                    number(HeaderRole::TotalLength),
                    number(HeaderRole::PlainLength),
                    (HeaderRole::Digest.name(), text(&hex(frame.slice(digest)))),
                ]),
            ),
            ("data", text(&hex(data))),
        ])
    }

    fn role_is_there(&self, role: HeaderRole) -> bool {
        self.layout
            .header
            .iter()
            .any(|field| field.role == Some(role))
    }

    fn zero_when_plain(&self) -> bool {
        self.layout.has_quirk(HeaderQuirk::ZeroWhenPlain)
    }
}

/// A code that no operation has, outside every range that is passed through; the largest.
fn unknown_code(model: &Model) -> u16 {
    let free = |code: &u16| is_free(model, *code) && !is_passed_through(model, *code);
    (0..=u16::MAX).rev().find(free).unwrap_or(u16::MAX)
}

/// A code that is passed through and that no operation has.
fn pass_through_code(model: &Model) -> Option<u16> {
    let mut ranges = model
        .ranges
        .iter()
        .filter(|range| range.usage == RangeUse::PassThrough);
    ranges.find_map(|range| (range.first..=range.last).find(|code| is_free(model, *code)))
}

fn is_free(model: &Model, code: u16) -> bool {
    let used = |operation: &fc_spec::model::Operation| operation.code.value == Some(code);
    !model.operations.iter().any(used) && !model.retired.iter().any(|retired| retired.code == code)
}

fn is_passed_through(model: &Model, code: u16) -> bool {
    let inside = |range: &fc_spec::model::CodeRange| {
        range.usage == RangeUse::PassThrough && (range.first..=range.last).contains(&code)
    };
    model.ranges.iter().any(inside)
}

fn unknown_kind(layout: &Frame) -> Option<u8> {
    (0..=u8::MAX).find(|value| !layout.kinds.iter().any(|kind| kind.value == *value))
}

fn cut(mut frame: FrameBytes, length: usize) -> FrameBytes {
    frame.bytes.truncate(length);
    frame
}

fn changed_data(mut frame: FrameBytes) -> FrameBytes {
    if let Some(last) = frame.bytes.last_mut() {
        *last ^= 1;
    }
    frame
}

/// A copy with a bit changed `from_end` bytes before the end.
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
