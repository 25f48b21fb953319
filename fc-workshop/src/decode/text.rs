//! Records as text for people.

use super::{Record, error_text, milliseconds};
use fc_reflect::{About, Error, HeaderContent, HeaderValue, Key, Leniency, Node, Value, walk};
use fc_spec::model::{
    Direction, EncodingRole, EnvelopeRole, HeaderRole, Lang, Model, Number, Scalar,
};
use std::fmt::Write as _;
use std::ops::Range;
use std::time::Duration;
use unicode_width::UnicodeWidthStr as _;

/// The maximum length of a value in characters.
const LONGEST: usize = 160;

/// The columns of positions and names. Longer ones shift the rest of their line.
const POSITION: usize = 12;
const NAME: usize = 24;

/// Returns a record as a tree: a title, the header fields, the keys of the body, and the error in its place.
#[must_use]
pub fn tree(record: &Record<'_>, model: &Model, lang: Lang) -> String {
    let mut tree = Tree {
        out: title(record, model, lang).join(" · ") + "\n",
        model,
        lang,
    };
    tree.header(record);
    if let Some(error @ Error::Frame(_)) = &record.error {
        tree.error(error);
        return tree.out;
    }
    tree.body(record);
    tree.out
}

/// Returns a record as one line: its title, and the name of its error.
#[must_use]
pub fn line(record: &Record<'_>, model: &Model, lang: Lang) -> String {
    let mut parts = title(record, model, lang);
    parts.extend(record.error.as_ref().map(|error| error.name().to_owned()));
    parts.join(" · ")
}

/// Returns the parts of the first line.
fn title(record: &Record<'_>, model: &Model, lang: Lang) -> Vec<String> {
    let mut parts = Vec::new();
    match record.id {
        Some(id) => {
            let name = record.operation.map_or_else(
                || lang.pick("未知功能码", "unknown code"),
                |it| it.name.as_str(),
            );
            let direction = side(id.direction, lang);
            parts.push(format!("0x{:04X} {name} {direction}", id.code));
            if let Some(operation) = record.operation {
                parts.push(lang.text(&operation.title).to_owned());
            }
            if let Some(field) = model.frame.field(HeaderRole::Id) {
                parts.push(format!("{} {}", field.wire, id.id));
            }
        }
        None => parts.push(lang.pick("无法识别", "not a frame").to_owned()),
    }
    let (length, offset) = (record.length, record.offset);
    parts.push(lang.pick(
        format!("{length} 字节，起始于 {offset}"),
        format!("{length} bytes at {offset}"),
    ));
    parts.extend(record.time.map(clock));
    parts.extend(record.flow.map(|flow| flow.to_string()));
    if let Some(elapsed) = record.request.and_then(|request| request.elapsed) {
        let elapsed = milliseconds(elapsed);
        parts.push(match lang {
            Lang::Zh => format!("请求后 {elapsed:.3} ms"),
            Lang::En => format!("{elapsed:.3} ms after the request"),
        });
    }
    parts
}

struct Tree<'m> {
    out: String,
    model: &'m Model,
    lang: Lang,
}

impl Tree<'_> {
    fn header(&mut self, record: &Record<'_>) {
        for value in &record.header {
            let meaning = self.meaning(value);
            let text = self.lang.text(&value.field.text).to_owned();
            self.row(
                &value.span,
                &value.field.wire,
                &content(value),
                &meaning,
                &text,
            );
        }
    }

    /// Returns the name that the spec gives to the value of a header field.
    fn meaning(&self, value: &HeaderValue<'_>) -> String {
        let HeaderContent::Int(number) = value.content else {
            return String::new();
        };
        let small = u8::try_from(number).ok();
        let frame = &self.model.frame;
        let named = match value.field.role {
            Some(HeaderRole::Kind) => small
                .and_then(|small| frame.kinds.with_value(small))
                .map(|kind| self.lang.text(&kind.text)),
            Some(HeaderRole::Encoding) => small
                .and_then(|small| frame.encodings.iter().find(|it| it.value == small))
                .map(|encoding| self.lang.text(&encoding.text)),
            _ => None,
        };
        named.unwrap_or_default().to_owned()
    }

    fn body(&mut self, record: &Record<'_>) {
        let Some(frame) = &record.frame else { return };
        let is_packed = frame
            .encoding
            .is_some_and(|encoding| encoding.role == EncodingRole::Gzip);
        // Positions in compressed data would not help.
        let base = if is_packed { 0 } else { frame.packed.start };
        let length = frame.data.len();
        let title = match (self.lang, is_packed) {
            (Lang::Zh, false) => format!("  数据，{length} 字节"),
            (Lang::Zh, true) => format!("  数据，解压后 {length} 字节，位置按解压后计"),
            (Lang::En, false) => format!("  data, {length} bytes"),
            (Lang::En, true) => {
                format!("  data, {length} bytes after decompression, with positions in these")
            }
        };
        self.out.push_str(&title);
        self.out.push('\n');
        if let Some(message) = &record.message {
            self.nodes(&message.envelope, base);
            if let Ok(body) = &message.body {
                self.nodes(body, base);
            }
        }
        if let Some(error @ Error::Body { error: fault, .. }) = &record.error {
            let at = base.saturating_add(fault.offset());
            let found = excerpt(&frame.data, fault.offset());
            let mark = self.lang.pick("此处", "here");
            self.row(&(at..at), fault.path(), &found, mark, "");
            self.error(error);
        }
    }

    fn nodes(&mut self, nodes: &[Node<'_>], base: usize) {
        walk(nodes, &mut |path, node| {
            let span = node.span.start.saturating_add(base)..node.span.end.saturating_add(base);
            let (value, meaning) = self.value(node);
            let text = match (node.about, &node.key) {
                (About::Unknown, Key::Name(_)) => self.lang.pick("未知的键", "unknown key"),
                _ => node.text().map_or("", |text| self.lang.text(text)),
            };
            self.row(&span, path, &value, &meaning, text);
        });
    }

    /// Returns a value, and its unit or its name in the spec.
    fn value(&self, node: &Node<'_>) -> (String, String) {
        let lang = self.lang;
        let mut meaning = match node.about {
            About::Field(field) => field.details().unit.clone().unwrap_or_default(),
            _ => String::new(),
        };
        let count = |zh: &str, en: &str| {
            let count = node.children().len();
            lang.pick(format!("{count} 个{zh}"), format!("{count} {en}"))
        };
        let value = match &node.value {
            Value::Absent => lang
                .pick("null，视为没有", "null, which means absent")
                .to_owned(),
            Value::Bool(value) => value.to_string(),
            Value::Int(value) => value.to_string(),
            Value::Float(value) => value.to_string(),
            Value::Text(text) => quoted(text),
            Value::Bytes(bytes) => match lang {
                Lang::Zh => format!("{} 字节的 base64", bytes.len()),
                Lang::En => format!("{} bytes of base64", bytes.len()),
            },
            Value::Json(text) => clipped(text),
            Value::Enum { wire, named } => {
                meaning = match named {
                    Some(value) => format!("{} {}", value.name, lang.text(&value.text)),
                    None => lang.pick("未知的值", "unknown value").to_owned(),
                };
                scalar(wire)
            }
            Value::List(_) => count("元素", "items"),
            Value::Object(_) => count("键", "keys"),
            Value::OneOf { variant, .. } => {
                lang.text(&variant.text).clone_into(&mut meaning);
                variant.name.clone()
            }
        };
        if let (About::Envelope(field), Value::Int(code)) = (node.about, &node.value)
            && field.role == EnvelopeRole::ResultCode
        {
            let mut results = self.model.results.iter();
            meaning = match results.find(|result| i128::from(result.code) == *code) {
                Some(result) => format!("{} {}", result.name, lang.text(&result.text)),
                None => lang.pick("未知的结果", "unknown result").to_owned(),
            };
        }
        for leniency in &node.lenient {
            let name = match leniency {
                Leniency::Quirk(quirk) => quirk.name(),
                Leniency::OtherKey => lang.pick("另一个键", "other key"),
            };
            let _ = write!(meaning, " [{name}]");
        }
        (value, meaning)
    }

    fn row(&mut self, span: &Range<usize>, name: &str, value: &str, meaning: &str, text: &str) {
        let position = if span.end > span.start {
            format!("{}..{}", span.start, span.end)
        } else {
            span.start.to_string()
        };
        let fill = NAME.saturating_sub(name.width());
        let _ = write!(self.out, "  {position:POSITION$}{name}{:fill$} {value}", "");
        for part in [meaning.trim(), text] {
            if !part.is_empty() {
                let _ = write!(self.out, "  {part}");
            }
        }
        self.out.push('\n');
    }

    fn error(&mut self, error: &Error) {
        let name = error.name();
        let text = error_text::text(name, self.lang).unwrap_or(name);
        let label = self.lang.pick("错误：", "error: ");
        let _ = write!(self.out, "  {label}{name}");
        if !error.path().is_empty() {
            let _ = write!(self.out, " `{}`", error.path());
        }
        // The details of the readers are in English.
        let _ = match self.lang {
            Lang::Zh => writeln!(self.out, "，{text}（{}）", error.detail()),
            Lang::En => writeln!(self.out, ": {}", error.detail()),
        };
    }
}

/// Returns the name of a direction.
pub(crate) fn side(direction: Direction, lang: Lang) -> &'static str {
    match direction {
        Direction::Request => lang.pick("请求", "request"),
        Direction::Response => lang.pick("响应", "response"),
    }
}

/// Returns the time of day in UTC.
pub(crate) fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes) = (seconds / 3600 % 24, seconds / 60 % 60);
    let micros = time.subsec_micros();
    format!("{hours:02}:{minutes:02}:{:02}.{micros:06}", seconds % 60)
}

fn content(value: &HeaderValue<'_>) -> String {
    match &value.content {
        HeaderContent::Bytes(bytes) => hex(bytes),
        HeaderContent::Int(number) if value.field.role == Some(HeaderRole::Code) => {
            format!("0x{number:04X}")
        }
        HeaderContent::Int(number) => number.to_string(),
    }
}

/// Returns bytes as pairs of digits, with a space between them.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(bytes.len().saturating_mul(3));
    for byte in bytes {
        if !out.is_empty() {
            out.push(' ');
        }
        let _ = write!(out, "{byte:02X}");
    }
    out
}

pub(crate) fn scalar(value: &Scalar) -> String {
    match value {
        Scalar::Bool(value) => value.to_string(),
        Scalar::Number(Number::Int(value)) => value.to_string(),
        Scalar::Number(Number::Float(value)) => value.to_string(),
        Scalar::String(text) => quoted(text),
    }
}

/// Returns the beginning of a text as a JSON string, so that control characters cannot reach the terminal.
fn quoted(text: &str) -> String {
    serde_json::Value::from(clipped(text)).to_string()
}

/// Returns the beginning of a text on one line.
pub(crate) fn clipped(text: &str) -> String {
    let mut shown: String = text.chars().take(LONGEST).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    shown.replace(|found: char| found.is_control(), " ")
}

/// Returns the bytes around a position, with marks for bytes that are not UTF-8.
fn excerpt(data: &[u8], offset: usize) -> String {
    let start = offset.saturating_sub(20).min(data.len());
    let end = offset.saturating_add(20).min(data.len());
    let bytes = data.get(start..end).unwrap_or_default();
    clipped(&String::from_utf8_lossy(bytes))
}
