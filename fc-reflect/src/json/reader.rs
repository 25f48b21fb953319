//! A place in a JSON text, moved by reading.

use crate::error::{BodyError, BodyFault};
use std::borrow::Cow;

/// Every method that reads a value skips the white space in front of it and stops right behind it.
#[derive(Clone, Debug)]
pub(crate) struct Reader<'t> {
    text: &'t str,
    /// Bytes read.
    at: usize,
    /// Levels of nesting that may still be entered.
    depth: usize,
    /// Keys and items that may still be read.
    values: usize,
}

impl<'t> Reader<'t> {
    /// At the start of a text that may be nested `depth` deep and have so many keys and items.
    pub(crate) fn within(text: &'t str, depth: usize, values: usize) -> Self {
        Self {
            text,
            at: 0,
            depth: depth.min(super::MAX_DEPTH),
            values,
        }
    }

    /// At the start of a text that has been checked.
    pub(crate) fn checked(text: &'t str) -> Self {
        Self::within(text, super::MAX_DEPTH, usize::MAX)
    }

    /// Bytes read.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// The text read since `start`.
    pub(crate) fn since(&self, start: usize) -> &'t str {
        self.text.get(start..self.at).unwrap_or_default()
    }

    /// Whether all of the text has been read, white space included.
    pub(crate) fn is_at_end(&self) -> bool {
        self.at >= self.text.len()
    }

    /// Skips white space and tells the next byte, if there is one.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\n' | b'\r' | b'\t') = self.byte() {
            self.at += 1;
        }
        self.byte()
    }

    fn byte(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn rest(&self) -> &'t [u8] {
        self.text.as_bytes().get(self.at..).unwrap_or_default()
    }

    /// Reads `literal` if the text goes on with it.
    pub(crate) fn take(&mut self, literal: &str) -> bool {
        let found = self.rest().starts_with(literal.as_bytes());
        if found {
            self.at += literal.len();
        }
        found
    }

    /// Reads `null` if it is the next value.
    pub(crate) fn take_null(&mut self) -> bool {
        self.peek() == Some(b'n') && self.take("null")
    }

    /// Reads `{}`, `[]` or `""` if it is the next value.
    pub(crate) fn take_empty(&mut self) -> bool {
        let start = self.clone();
        let empty = match self.peek() {
            Some(b'"') => self.take("\"\""),
            Some(b'{') => self.begin_object().is_ok() && self.end_object(),
            Some(b'[') => self.begin_list().is_ok() && self.end_list(),
            _ => false,
        };
        if !empty {
            *self = start;
        }
        empty
    }

    /// Reads `true` or `false` if it is the next value.
    pub(crate) fn take_bool(&mut self) -> Option<bool> {
        match self.peek() {
            Some(b't') if self.take("true") => Some(true),
            Some(b'f') if self.take("false") => Some(false),
            _ => None,
        }
    }

    /// Reads the next value and gives its text.
    pub(crate) fn value_text(&mut self) -> Result<&'t str, BodyError> {
        self.peek();
        let start = self.at;
        self.skip_value()?;
        Ok(self.since(start))
    }

    /// Reads the next value, whatever it is.
    pub(crate) fn skip_value(&mut self) -> Result<(), BodyError> {
        match self.peek() {
            Some(b'"') => self.skip_string(),
            Some(b'{') => {
                self.begin_object()?;
                while !self.end_object() {
                    self.skip_string()?;
                    self.colon()?;
                    self.count()?;
                    self.skip_value()?;
                    self.end_value()?;
                }
                Ok(())
            }
            Some(b'[') => {
                self.begin_list()?;
                if self.end_list() {
                    return Ok(());
                }
                loop {
                    self.count()?;
                    self.skip_value()?;
                    if !self.next_item()? {
                        return Ok(());
                    }
                }
            }
            Some(b't') if self.take("true") => Ok(()),
            Some(b'f') if self.take("false") => Ok(()),
            Some(b'n') if self.take("null") => Ok(()),
            Some(b'-' | b'0'..=b'9') => self.skip_number(),
            _ => Err(self.bad_json("a JSON value is expected here")),
        }
    }

    // ---- objects and lists -----------------------------------------------------------------

    /// Enters an object and stops at its first key or at its closing brace.
    pub(crate) fn begin_object(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b'{') {
            return Err(self.unexpected("an object"));
        }
        self.enter()?;
        match self.peek() {
            Some(b'"' | b'}') => Ok(()),
            _ => Err(self.bad_json("a key in quotes or `}` is expected here")),
        }
    }

    /// Reads the closing brace if it comes next.
    pub(crate) fn end_object(&mut self) -> bool {
        let ends = self.byte() == Some(b'}');
        if ends {
            self.leave();
        }
        ends
    }

    /// Reads a key and its colon.
    pub(crate) fn key(&mut self) -> Result<Cow<'t, str>, BodyError> {
        let key = self.string()?;
        self.colon()?;
        Ok(key)
    }

    fn colon(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b':') {
            return Err(self.bad_json("`:` is expected after a key"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads what follows a value in an object: a comma, up to the next key, or nothing, up to the closing brace.
    pub(crate) fn end_value(&mut self) -> Result<(), BodyError> {
        match self.peek() {
            Some(b',') => {
                self.at += 1;
                if self.peek() == Some(b'"') {
                    Ok(())
                } else {
                    Err(self.bad_json("a key in quotes is expected after `,`"))
                }
            }
            Some(b'}') => Ok(()),
            _ => Err(self.bad_json("`,` or `}` is expected after a value")),
        }
    }

    /// Enters a list.
    pub(crate) fn begin_list(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b'[') {
            return Err(self.unexpected("a list"));
        }
        self.enter()
    }

    /// Reads the closing bracket if it comes next. Only for an empty list: behind a comma a bracket is a fault.
    pub(crate) fn end_list(&mut self) -> bool {
        let ends = self.peek() == Some(b']');
        if ends {
            self.leave();
        }
        ends
    }

    /// Reads what follows an item of a list; whether another one comes.
    pub(crate) fn next_item(&mut self) -> Result<bool, BodyError> {
        match self.peek() {
            Some(b',') => {
                self.at += 1;
                Ok(true)
            }
            Some(b']') => {
                self.leave();
                Ok(false)
            }
            _ => Err(self.bad_json("`,` or `]` is expected after an item")),
        }
    }

    fn count(&mut self) -> Result<(), BodyError> {
        let Some(left) = self.values.checked_sub(1) else {
            return Err(self.fault(
                BodyFault::TooManyValues,
                "more keys and items than the limit",
            ));
        };
        self.values = left;
        Ok(())
    }

    fn enter(&mut self) -> Result<(), BodyError> {
        let Some(depth) = self.depth.checked_sub(1) else {
            return Err(self.fault(BodyFault::TooDeep, "nested deeper than the limit"));
        };
        self.depth = depth;
        self.at += 1;
        Ok(())
    }

    fn leave(&mut self) {
        self.depth += 1;
        self.at += 1;
    }

    /// Checks that nothing but white space is left.
    pub(crate) fn end(&mut self) -> Result<(), BodyError> {
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.bad_json("nothing may follow the value")),
        }
    }

    // ---- numbers ---------------------------------------------------------------------------

    /// Reads a number and gives its text.
    pub(crate) fn number(&mut self, wanted: &str) -> Result<&'t str, BodyError> {
        let Some(b'-' | b'0'..=b'9') = self.peek() else {
            return Err(self.unexpected(wanted));
        };
        let start = self.at;
        self.skip_number()?;
        Ok(self.since(start))
    }

    fn skip_number(&mut self) -> Result<(), BodyError> {
        self.at += usize::from(self.byte() == Some(b'-'));
        let start = self.at;
        self.skip_digits()?;
        if self.at - start > 1 && self.text.as_bytes().get(start) == Some(&b'0') {
            self.at = start;
            return Err(self.bad_json("a number must not start with `0`"));
        }
        if self.byte() == Some(b'.') {
            self.at += 1;
            self.skip_digits()?;
        }
        if let Some(b'e' | b'E') = self.byte() {
            self.at += 1;
            if let Some(b'+' | b'-') = self.byte() {
                self.at += 1;
            }
            self.skip_digits()?;
        }
        Ok(())
    }

    fn skip_digits(&mut self) -> Result<(), BodyError> {
        let digits = self.rest().iter().take_while(|byte| byte.is_ascii_digit());
        match digits.count() {
            0 => Err(self.bad_json("a digit is expected here")),
            count => {
                self.at += count;
                Ok(())
            }
        }
    }

    // ---- strings ---------------------------------------------------------------------------

    /// Reads a string, borrowed from the text unless it holds escapes.
    pub(crate) fn string(&mut self) -> Result<Cow<'t, str>, BodyError> {
        self.open_string()?;
        let plain = self.plain_run();
        if self.take("\"") {
            return Ok(Cow::Borrowed(plain));
        }
        let mut out = plain.to_owned();
        loop {
            match self.byte() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(Cow::Owned(out));
                }
                Some(b'\\') => out.push(self.escape()?),
                _ => return Err(self.broken_string()),
            }
            out.push_str(self.plain_run());
        }
    }

    /// Reads a string that nobody looks into. Halves of surrogate pairs may stand alone there: the grammar allows
    /// them, and it is passed on unchanged.
    fn skip_string(&mut self) -> Result<(), BodyError> {
        self.open_string()?;
        loop {
            self.plain_run();
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

    fn open_string(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b'"') {
            return Err(self.unexpected("a string"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads up to the next quote, backslash or control character.
    fn plain_run(&mut self) -> &'t str {
        let start = self.at;
        let special = |byte: &u8| *byte < 0x20 || matches!(byte, b'"' | b'\\');
        let rest = self.rest();
        self.at += rest.iter().position(special).unwrap_or(rest.len());
        self.since(start)
    }

    /// Reads an escape, its backslash included.
    fn escape(&mut self) -> Result<char, BodyError> {
        let start = self.at;
        Ok(match self.escape_letter()? {
            b'b' => '\u{8}',
            b'f' => '\u{C}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => return self.unicode(start),
            other => char::from(other),
        })
    }

    /// Reads a backslash and the letter behind it.
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
        let mut code = Some(first);
        if (0xD800..=0xDBFF).contains(&first) && self.take("\\u") {
            let second = self.hex4()?;
            let half = second.checked_sub(0xDC00).filter(|half| *half < 0x400);
            code = half.map(|half| 0x1_0000 + ((first - 0xD800) << 10) + half);
        }
        code.and_then(char::from_u32).ok_or_else(|| {
            self.at = start;
            self.fault(
                BodyFault::LoneSurrogate,
                "half of a surrogate pair stands alone; send whole characters",
            )
        })
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

    fn broken_string(&self) -> BodyError {
        match self.byte() {
            Some(_) => self.bad_json("a control character must be escaped"),
            None => self.bad_json("a closing quote is expected"),
        }
    }

    // ---- faults ----------------------------------------------------------------------------

    /// A fault at this place.
    fn fault(&self, fault: BodyFault, detail: impl Into<Cow<'static, str>>) -> BodyError {
        BodyError::new(fault, self.at, detail)
    }

    fn bad_json(&self, detail: &'static str) -> BodyError {
        let end = if self.is_at_end() {
            "; the text ends"
        } else {
            ""
        };
        self.fault(BodyFault::BadJson, format!("{detail}{end}"))
    }

    /// The fault of a value of another kind than `wanted`.
    pub(crate) fn unexpected(&mut self, wanted: &str) -> BodyError {
        let found = match self.peek() {
            Some(b'"') => "a string",
            Some(b'{') => "an object",
            Some(b'[') => "a list",
            Some(b't' | b'f') => "a bool",
            Some(b'n') => "null",
            Some(b'-' | b'0'..=b'9') => "a number",
            Some(_) => "no JSON value",
            None => "the end of the text",
        };
        self.fault(
            BodyFault::WrongType,
            format!("found {found}; send {wanted}"),
        )
    }
}
