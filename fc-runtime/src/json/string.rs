//! Strings of JSON text.

use super::{BodyError, BodyErrorKind, Reader, scan::plain_run};
use std::borrow::Cow;

impl<'a> Reader<'a> {
    /// Reads a string, borrowed from the text unless it holds escapes.
    ///
    /// # Errors
    /// `wrong_type`, `lone_surrogate`, `bad_json`.
    #[inline]
    pub fn string(&mut self) -> Result<Cow<'a, str>, BodyError> {
        self.open_string()?;
        let start = self.at;
        self.at += plain_run(self.rest());
        let plain = self.since(start);
        if self.byte() == Some(b'"') {
            self.at += 1;
            return Ok(Cow::Borrowed(plain));
        }
        self.unescape(plain).map(Cow::Owned)
    }

    /// Reserves `needed` more bytes in a string made from the text read so far. Doubles the capacity, but not beyond
    /// the rest of the text.
    pub(super) fn grow(&self, text: &mut String, needed: usize) {
        if text.capacity() - text.len() < needed {
            text.reserve_exact(needed + text.len().min(self.rest().len()));
        }
    }

    #[inline]
    fn open_string(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b'"') {
            return Err(self.unexpected("a string"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads the rest of a string whose first `plain` bytes have no escapes.
    fn unescape(&mut self, plain: &str) -> Result<String, BodyError> {
        let mut out = String::from(plain);
        loop {
            match self.byte() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(out);
                }
                Some(b'\\') => {
                    let character = self.escape()?;
                    self.grow(&mut out, character.len_utf8());
                    out.push(character);
                }
                _ => return Err(self.broken_string()),
            }
            let start = self.at;
            self.at += plain_run(self.rest());
            let run = self.since(start);
            self.grow(&mut out, run.len());
            out.push_str(run);
        }
    }

    /// Reads an escape, its backslash included.
    fn escape(&mut self) -> Result<char, BodyError> {
        let start = self.at;
        let character = match self.escape_letter()? {
            b'b' => '\u{8}',
            b'f' => '\u{C}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => return self.unicode(start),
            other => char::from(other),
        };
        Ok(character)
    }

    /// Reads a backslash and the letter behind it.
    #[inline]
    fn escape_letter(&mut self) -> Result<u8, BodyError> {
        self.at += 1;
        match self.byte() {
            Some(letter @ (b'"' | b'\\' | b'/' | b'b' | b'f' | b'n' | b'r' | b't' | b'u')) => {
                self.at += 1;
                Ok(letter)
            }
            _ => Err(self.bad_json(r#"one of `"\/bfnrtu` is expected after a backslash"#)),
        }
    }

    /// Reads the digits of `\u`, and the second half of a surrogate pair.
    fn unicode(&mut self, start: usize) -> Result<char, BodyError> {
        let first = self.hex4()?;
        let code = match first {
            0xD800..=0xDBFF if self.take("\\u") => {
                let second = self.hex4()?;
                if !(0xDC00..=0xDFFF).contains(&second) {
                    self.at = start;
                    return Err(self.lone_surrogate());
                }
                0x1_0000 + ((first - 0xD800) << 10) + (second - 0xDC00)
            }
            other => other,
        };
        char::from_u32(code).ok_or_else(|| {
            self.at = start;
            self.lone_surrogate()
        })
    }

    #[cold]
    fn lone_surrogate(&self) -> BodyError {
        self.fault(
            BodyErrorKind::LoneSurrogate,
            "half of a surrogate pair stands alone; send whole characters",
        )
    }

    fn hex4(&mut self) -> Result<u32, BodyError> {
        let mut value = 0;
        for _ in 0..4 {
            let digit = self.byte().and_then(|byte| char::from(byte).to_digit(16));
            let Some(digit) = digit else {
                return Err(self.bad_json("four hexadecimal digits are expected after `\\u`"));
            };
            value = value << 4 | digit;
            self.at += 1;
        }
        Ok(value)
    }

    /// Skips a string. A skipped string may contain half of a surrogate pair, because the grammar allows it and the
    /// text is passed on unchanged.
    pub(super) fn skip_string(&mut self) -> Result<(), BodyError> {
        self.open_string()?;
        loop {
            self.at += plain_run(self.rest());
            match self.byte() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'\\') => {
                    if self.escape_letter()? == b'u' {
                        self.hex4()?;
                    }
                }
                _ => return Err(self.broken_string()),
            }
        }
    }

    /// Returns the error of a string with neither a quote nor a backslash at this position.
    #[cold]
    fn broken_string(&self) -> BodyError {
        match self.byte() {
            Some(_) => self.bad_json("a control character must be escaped"),
            None => self.bad_json("a closing quote is expected"),
        }
    }
}
