//! Frames for human eyes: the ruler of the header, the dump and the table of a real frame.

use super::lang::Lang;
use super::words;
use crate::sample::FrameBytes;
use crate::sample::frame::hex;
use fc_spec::model::{Direction, Frame, HeaderField, HeaderRole, Kind, KindRole};
use serde::Serialize;
use std::fmt::Write as _;

/// Bytes in a line of a dump.
const PER_LINE: usize = 16;

/// Lines of data up to which all of it is shown.
const ALL_LINES: usize = 24;

/// Lines of data shown at the start of a longer data area; one more is shown of its end.
const FIRST_LINES: usize = 6;

/// A real frame.
#[derive(Debug, Serialize)]
pub(super) struct FrameView {
    /// Lines of offset, bytes and field name, or of offset, bytes and ASCII.
    dump: String,
    /// What the dump's fence is called: the site draws `fc-frame`, which must be all of a frame.
    fence: &'static str,
    parts: Vec<PartView>,
    length: usize,
}

/// One header field of a real frame, or its data.
#[derive(Debug, Serialize)]
struct PartView {
    /// `0–1`.
    offset: String,
    /// Hexadecimal; empty for data.
    bytes: String,
    name: String,
    /// What the value is, read as the field's type.
    value: Option<String>,
    text: String,
}

/// A frame as the pages show it.
pub(super) fn frame_view(layout: &Frame, frame: &FrameBytes, lang: Lang) -> FrameView {
    let mut dump = String::new();
    let mut parts = Vec::new();
    for (field, range) in layout.header.iter().zip(&frame.fields) {
        let bytes = frame.slice(range.clone());
        for (index, line) in bytes.chunks(PER_LINE).enumerate() {
            let name = if index == 0 {
                format!("; {}", field.wire)
            } else {
                String::new()
            };
            dump_line(&mut dump, range.start + index * PER_LINE, line, &name);
        }
        parts.push(PartView {
            offset: span(range.start, range.end),
            bytes: spaced(bytes),
            name: field.wire.clone(),
            value: value(layout, field, frame, lang),
            text: lang.text(&field.text).to_owned(),
        });
    }
    let data = frame.slice(frame.data.clone());
    dump_data(&mut dump, frame.data.start, data, lang);
    if !data.is_empty() {
        parts.push(PartView {
            offset: span(frame.data.start, frame.data.end),
            bytes: String::new(),
            name: lang.pick("数据", "data").to_owned(),
            value: Some(lang.pick(
                format!("{} 字节", data.len()),
                format!("{} bytes", data.len()),
            )),
            text: lang.text(&layout.data).to_owned(),
        });
    }
    let all = data.len() <= ALL_LINES * PER_LINE;
    FrameView {
        dump,
        fence: if all { "fc-frame" } else { "text" },
        parts,
        length: frame.bytes.len(),
    }
}

/// A ruler of the header: every byte under its offset, every field in brackets.
pub(super) fn ruler(layout: &Frame) -> String {
    let header = layout.header_len();
    let mut cells = String::new();
    for (index, field) in layout.header.iter().enumerate() {
        let size = field.ty.size();
        if size > 0 {
            let inside = size * 3 - 2;
            let _ = write!(cells, "[{:<inside$}]", letter(index));
        }
    }
    let mut out = String::new();
    for start in (0..header).step_by(PER_LINE) {
        let end = (start + PER_LINE).min(header);
        out.push_str("      ");
        for offset in start..end {
            let _ = write!(out, "{offset:>2} ");
        }
        out.truncate(out.trim_end().len());
        let line = cells.get(start * 3..end * 3).unwrap_or_default();
        let _ = writeln!(out, "\n{start:>4}  {}", line.trim_end());
    }
    out
}

/// The letter that stands for a header field in the ruler.
pub(super) fn letter(index: usize) -> String {
    let letters = 'A'..='Z';
    match letters.clone().nth(index) {
        Some(letter) => letter.to_string(),
        None => letters
            .clone()
            .nth(index % 26)
            .map_or_else(String::new, |letter| letter.to_lowercase().to_string()),
    }
}

/// Two hexadecimal digits a byte.
pub(super) fn spaced(bytes: &[u8]) -> String {
    let digits = hex(bytes).to_ascii_uppercase();
    let mut out = String::with_capacity(bytes.len() * 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && index.is_multiple_of(2) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

fn span(start: usize, end: usize) -> String {
    if end <= start + 1 {
        start.to_string()
    } else {
        format!("{start}–{}", end - 1)
    }
}

fn dump_line(dump: &mut String, offset: usize, bytes: &[u8], right: &str) {
    let width = PER_LINE * 3 - 1;
    let line = format!("{offset:04X}  {:<width$}  {right}", spaced(bytes));
    dump.push_str(line.trim_end());
    dump.push('\n');
}

fn dump_data(dump: &mut String, start: usize, data: &[u8], lang: Lang) {
    let lines: Vec<&[u8]> = data.chunks(PER_LINE).collect();
    let skipped = if lines.len() <= ALL_LINES {
        0
    } else {
        lines.len() - FIRST_LINES - 1
    };
    for (index, line) in lines.iter().enumerate() {
        if index == FIRST_LINES && skipped > 0 {
            let bytes = skipped * PER_LINE;
            dump.push_str(&lang.pick(
                format!("      …（略去 {bytes} 字节）\n"),
                format!("      … ({bytes} bytes left out)\n"),
            ));
        }
        if skipped == 0 || index < FIRST_LINES || index >= FIRST_LINES + skipped {
            dump_line(dump, start + index * PER_LINE, line, &ascii(line));
        }
    }
}

fn ascii(bytes: &[u8]) -> String {
    let shown = |byte: &u8| {
        if (0x20..0x7F).contains(byte) {
            char::from(*byte)
        } else {
            '.'
        }
    };
    let text: String = bytes.iter().map(shown).collect();
    format!("|{text}|")
}

/// What the frame's own kind field says that it is.
fn kind(layout: &Frame, frame: &FrameBytes) -> Option<Kind> {
    let number = frame.int(layout, HeaderRole::Kind);
    let mut kinds = layout.kinds.iter();
    match kinds.find(|kind| u64::from(kind.value) == number)?.role {
        KindRole::Command => Some(Kind::Command),
        KindRole::Report => Some(Kind::Report),
        KindRole::Stream => Some(Kind::Stream),
        KindRole::Reserved => None,
    }
}

/// What a header field says in this frame.
fn value(layout: &Frame, field: &HeaderField, frame: &FrameBytes, lang: Lang) -> Option<String> {
    let Some(role) = field.role else {
        return Some(field.value.to_string());
    };
    let number = frame.int(layout, role);
    let data = frame.data.len();
    match role {
        HeaderRole::Head => {
            let place = frame.field(layout, role)?;
            let direction = if frame.slice(place) == layout.request_head {
                Direction::Request
            } else {
                Direction::Response
            };
            Some(words::side(kind(layout, frame)?, direction, lang).to_owned())
        }
        HeaderRole::Kind => {
            let kind = layout
                .kinds
                .iter()
                .find(|kind| u64::from(kind.value) == number)?;
            Some(format!("`{}`", kind.name))
        }
        HeaderRole::Code => Some(format!("0x{number:04X} = {number}")),
        HeaderRole::Id | HeaderRole::Status | HeaderRole::PlainLength => Some(number.to_string()),
        HeaderRole::Encoding => {
            let mut encodings = layout.encodings.iter();
            let encoding = encodings.find(|encoding| u64::from(encoding.value) == number)?;
            Some(format!("`{}`", encoding.name))
        }
        HeaderRole::TotalLength => Some(format!("{number} = {} + {data}", layout.header_len())),
        HeaderRole::Digest => None,
    }
}
