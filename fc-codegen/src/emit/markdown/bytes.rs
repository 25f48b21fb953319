//! Frames as people read them: the ruler of the header, and the dump and the table of a real frame.

use super::words;
use crate::emit::json::hex_digits;
use fc_reflect::{Frame, HeaderContent, HeaderValue, Reflector};
use fc_spec::model::Lang;
use fc_spec::model::{Frame as Layout, HeaderRole, Kind};
use minijinja::{Value, context};
use std::fmt::Write as _;
use std::ops::Range;

/// The number of bytes in a line of a dump.
const PER_LINE: usize = 16;

/// Returns the view of a frame, or `None` if the limits of the spec do not allow the frame.
pub(super) fn frame_view(reflector: &Reflector<'_>, bytes: &[u8], lang: Lang) -> Option<Value> {
    let layout = &reflector.model().frame;
    let frame = reflector.frame(bytes).ok()?;
    let mut dump = String::new();
    let mut parts = Vec::new();
    for header in &frame.header {
        let Range { start, end } = header.span;
        let bytes = bytes.get(header.span.clone()).unwrap_or_default();
        for (index, line) in bytes.chunks(PER_LINE).enumerate() {
            let name = if index == 0 {
                format!("; {}", header.field.wire)
            } else {
                String::new()
            };
            dump_line(&mut dump, start + index * PER_LINE, line, &name);
        }
        parts.push(context! {
            offset => span(start, end),
            bytes => spaced(bytes),
            name => &header.field.wire,
            value => value(layout, header, &frame, lang),
            text => lang.text(&header.field.text),
        });
    }
    let Range { start, end } = frame.packed;
    let data = bytes.get(frame.packed.clone()).unwrap_or_default();
    for (index, line) in data.chunks(PER_LINE).enumerate() {
        dump_line(&mut dump, start + index * PER_LINE, line, &ascii(line));
    }
    if !data.is_empty() {
        let length = data.len();
        parts.push(context! {
            offset => span(start, end),
            bytes => "",
            name => lang.pick("数据", "data"),
            value => lang.pick(format!("{length} 字节"), format!("{length} bytes")),
            text => lang.text(&layout.data),
        });
    }
    Some(context! { dump, parts, length => bytes.len() })
}

/// Returns a ruler of the header. Every byte is under its offset, and every field is in brackets.
pub(super) fn ruler(layout: &Layout) -> String {
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

/// Returns the letter of a header field in the ruler.
pub(super) fn letter(index: usize) -> String {
    let mut letters = ('A'..='Z').chain(('a'..='z').cycle());
    letters.nth(index).map_or_else(String::new, String::from)
}

/// Returns bytes as pairs of hexadecimal digits.
pub(super) fn spaced(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(bytes.len() * 3);
    for (index, byte) in bytes.iter().enumerate() {
        if index > 0 {
            out.push(' ');
        }
        out.extend(hex_digits(*byte).map(|digit| char::from(digit.to_ascii_uppercase())));
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
    let _ = write!(dump, "{offset:04X}  {:<width$}  {right}", spaced(bytes));
    dump.truncate(dump.trim_end().len());
    dump.push('\n');
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

/// Returns the meaning of a header field in this frame.
fn value(
    layout: &Layout,
    header: &HeaderValue<'_>,
    frame: &Frame<'_>,
    lang: Lang,
) -> Option<String> {
    let number = match header.content {
        HeaderContent::Int(number) => number,
        HeaderContent::Bytes(_) => 0,
    };
    match header.field.role {
        None => Some(header.field.value.to_string()),
        Some(HeaderRole::Head) => {
            let mut kinds = Kind::ALL.iter();
            let kind = kinds.find(|kind| kind.role() == frame.kind.role)?;
            Some(words::side(*kind, frame.id.direction, lang).to_owned())
        }
        Some(HeaderRole::Kind) => Some(format!("`{}`", frame.kind.name)),
        Some(HeaderRole::Code) => Some(format!("0x{number:04X} = {number}")),
        Some(HeaderRole::Id | HeaderRole::Status | HeaderRole::PlainLength) => {
            Some(number.to_string())
        }
        Some(HeaderRole::Encoding) => Some(format!("`{}`", frame.encoding?.name)),
        Some(HeaderRole::TotalLength) => Some(format!(
            "{number} = {} + {}",
            layout.header_len(),
            frame.packed.len()
        )),
        Some(HeaderRole::Digest) => None,
    }
}
