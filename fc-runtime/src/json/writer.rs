//! Writes JSON text into a byte buffer.

use super::decimal::Decimal;
use super::{AsNumber, Extra, Quotable, ToJson};

/// Writes one JSON value to the end of a buffer.
#[derive(Debug)]
pub struct Writer<'a> {
    out: &'a mut Vec<u8>,
}

impl<'a> Writer<'a> {
    /// Creates a writer that appends to `out`.
    #[inline]
    pub fn new(out: &'a mut Vec<u8>) -> Self {
        Self { out }
    }

    /// Writes `null`.
    #[inline]
    pub fn null(&mut self) {
        self.out.extend_from_slice(b"null");
    }

    /// Writes `true` or `false`.
    #[inline]
    pub fn bool(&mut self, value: bool) {
        let text: &[u8] = if value { b"true" } else { b"false" };
        self.out.extend_from_slice(text);
    }

    /// Writes an integer.
    #[inline]
    pub fn integer(&mut self, value: impl itoa::Integer) {
        let mut buffer = itoa::Buffer::new();
        self.out.extend_from_slice(buffer.format(value).as_bytes());
    }

    /// Writes a number in the shortest form that reads back as the same value. Writes NaN and infinities as `null`.
    pub fn f64(&mut self, value: f64) {
        if let Some(text) = Decimal::default().format(value) {
            self.out.extend_from_slice(text);
        } else if value.is_finite() {
            let mut buffer = zmij::Buffer::new();
            self.out
                .extend_from_slice(buffer.format_finite(value).as_bytes());
        } else {
            self.null();
        }
    }

    /// Writes a number in the shortest form that reads back as the same value. Writes NaN and infinities as `null`.
    pub fn f32(&mut self, value: f32) {
        if value.is_finite() {
            let mut buffer = zmij::Buffer::new();
            self.out
                .extend_from_slice(buffer.format_finite(value).as_bytes());
        } else {
            self.null();
        }
    }

    /// Writes a string with only the escapes that JSON requires.
    #[inline]
    pub fn string(&mut self, text: &str) {
        self.out.push(b'"');
        self.escaped(text);
        self.out.push(b'"');
    }

    fn escaped(&mut self, text: &str) {
        let mut rest = text.as_bytes();
        loop {
            let plain = super::scan::plain_run(rest);
            let (run, special) = rest.split_at(plain);
            self.out.extend_from_slice(run);
            let Some((&byte, after)) = special.split_first() else {
                return;
            };
            self.escape(byte);
            rest = after;
        }
    }

    #[cold]
    fn escape(&mut self, byte: u8) {
        let short = match byte {
            b'"' => b'"',
            b'\\' => b'\\',
            b'\n' => b'n',
            b'\r' => b'r',
            b'\t' => b't',
            0x08 => b'b',
            0x0C => b'f',
            control => {
                const HEX: [u8; 16] = *b"0123456789abcdef";
                let digit = |value: u8| HEX.get(usize::from(value & 15)).copied().unwrap_or(b'0');
                self.out.extend_from_slice(&[
                    b'\\',
                    b'u',
                    b'0',
                    b'0',
                    digit(control >> 4),
                    digit(control),
                ]);
                return;
            }
        };
        self.out.extend_from_slice(&[b'\\', short]);
    }

    /// Writes a text that already is one JSON value.
    #[inline]
    pub(crate) fn raw(&mut self, text: &str) {
        self.out.extend_from_slice(text.as_bytes());
    }

    /// Writes base64 (RFC 4648, padded) as a string.
    pub(crate) fn base64(&mut self, bytes: &[u8]) {
        self.out.push(b'"');
        super::base64::encode(bytes, self.out);
        self.out.push(b'"');
    }

    /// Writes a list.
    #[inline]
    pub fn array<T: ToJson>(&mut self, items: &[T]) {
        self.list(items, T::write);
    }

    /// Writes a list with `write` for each item.
    #[inline]
    pub fn list<T>(&mut self, items: &[T], write: impl Fn(&T, &mut Writer<'_>)) {
        let start = self.out.len();
        for item in items {
            self.out.push(b',');
            write(item, self);
        }
        self.close(start, b'[', b']');
    }

    /// Writes a value without quotes as a string.
    pub(crate) fn quoted<T: ToJson>(&mut self, value: &T) {
        self.out.push(b'"');
        value.write(self);
        self.out.push(b'"');
    }

    /// Starts an object.
    #[inline]
    pub fn object(&mut self) -> ObjectWriter<'_> {
        let start = self.out.len();
        ObjectWriter {
            writer: Writer { out: self.out },
            start,
        }
    }

    /// Replaces the comma before the first item by the opening bracket, or adds the bracket to an empty list.
    #[inline]
    fn close(&mut self, start: usize, open: u8, close: u8) {
        match self.out.get_mut(start) {
            Some(comma) => *comma = open,
            None => self.out.push(open),
        }
        self.out.push(close);
    }
}

/// Writes the keys of one object.
#[derive(Debug)]
pub struct ObjectWriter<'a> {
    writer: Writer<'a>,
    start: usize,
}

impl ObjectWriter<'_> {
    /// Writes a field unless it is absent.
    ///
    /// `key` is the text before the value with a leading comma: `,"stationId":`. At the end, the comma of the first
    /// field becomes the opening brace.
    #[inline(always)]
    #[allow(
        clippy::inline_always,
        reason = "a constant key is copied without a call"
    )]
    pub fn field<T: ToJson>(&mut self, key: &'static str, value: &T) {
        if !value.is_absent() {
            self.writer.raw(key);
            value.write(&mut self.writer);
        }
    }

    /// Writes a field inside a string, unless it is absent.
    #[inline]
    pub fn quoted_field<T: Quotable + ToJson>(&mut self, key: &'static str, value: &T) {
        if !value.is_absent() {
            self.writer.raw(key);
            value.write_quoted(&mut self.writer);
        }
    }

    /// Writes a field as a number, unless it is absent.
    #[inline]
    pub fn numeric_field<T: AsNumber + ToJson>(&mut self, key: &'static str, value: &T) {
        if !value.is_absent() {
            self.writer.raw(key);
            value.write_number(&mut self.writer);
        }
    }

    /// Writes unknown keys.
    pub fn extra(&mut self, extra: &Extra) {
        self.writer.raw(extra.text());
    }

    /// Ends the object.
    #[inline]
    pub fn end(mut self) {
        self.writer.close(self.start, b'{', b'}');
    }
}
