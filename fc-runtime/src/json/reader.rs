//! Reads JSON text, directed by the type that is wanted.

use super::halt::Halt;
use super::{Allowance, BodyError, BodyErrorKind};
use std::borrow::Cow;

/// A place in a JSON text.
///
/// Every method that reads a value skips the whitespace in front of it and stops right behind it.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    pub(super) text: &'a str,
    /// Bytes read.
    pub(super) at: usize,
    /// Levels of nesting that may still be entered.
    depth: usize,
    /// Keys and items that may still be read.
    pub(super) values: usize,
    /// Memory that lists may still take, in bytes.
    pub(super) list_bytes: usize,
    /// Why no field is read any more, if none is.
    pub(super) halt: Halt<'a>,
}

impl<'a> Reader<'a> {
    /// A reader at the start of `text`.
    #[must_use]
    pub fn new(text: &'a str, allowance: Allowance) -> Self {
        Self {
            text,
            at: 0,
            depth: allowance.depth.min(super::MAX_DEPTH),
            values: allowance.values,
            list_bytes: allowance.list_bytes,
            halt: Halt::No,
        }
    }

    /// Bytes read.
    #[must_use]
    pub fn offset(&self) -> usize {
        self.at
    }

    /// Skips whitespace and tells the next byte, if there is one.
    #[inline]
    pub fn peek(&mut self) -> Option<u8> {
        loop {
            let byte = self.byte()?;
            if byte > b' ' || !matches!(byte, b' ' | b'\n' | b'\r' | b'\t') {
                return Some(byte);
            }
            self.at += 1;
        }
    }

    /// The next byte, whitespace or not.
    #[inline]
    pub(super) fn byte(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// The text not read yet.
    #[inline]
    pub(super) fn rest(&self) -> &'a [u8] {
        self.text.as_bytes().get(self.at..).unwrap_or_default()
    }

    /// The text read since `start`.
    #[inline]
    pub(super) fn since(&self, start: usize) -> &'a str {
        self.text.get(start..self.at).unwrap_or_default()
    }

    /// Reads `literal` if the text goes on with it.
    #[inline(always)]
    #[allow(
        clippy::inline_always,
        reason = "the comparison is as fast as its literal is constant"
    )]
    pub(super) fn take(&mut self, literal: &str) -> bool {
        let found = self.rest().starts_with(literal.as_bytes());
        if found {
            self.at += literal.len();
        }
        found
    }

    /// Reads `null` if it is the next value.
    #[inline]
    pub fn take_null(&mut self) -> bool {
        self.peek() == Some(b'n') && self.take("null")
    }

    /// Reads `true` or `false`.
    ///
    /// # Errors
    /// `wrong_type`.
    #[inline]
    pub fn bool(&mut self) -> Result<bool, BodyError> {
        match self.peek() {
            Some(b't') if self.take("true") => Ok(true),
            Some(b'f') if self.take("false") => Ok(false),
            _ => Err(self.unexpected("true or false")),
        }
    }

    /// Reads the next value and gives its text.
    ///
    /// # Errors
    /// `bad_json`, `too_deep`, `too_many_values`.
    pub fn value_text(&mut self) -> Result<&'a str, BodyError> {
        self.peek();
        let start = self.at;
        self.skip_value()?;
        Ok(self.since(start))
    }

    /// Reads the next value and forgets it.
    ///
    /// # Errors
    /// `bad_json`, `too_deep`, `too_many_values`.
    pub fn skip_value(&mut self) -> Result<(), BodyError> {
        match self.peek() {
            Some(b'"') => self.skip_string(),
            Some(b'{') => {
                self.begin_object()?;
                while !self.end_object() {
                    self.skip_key()?;
                    self.count(1)?;
                    self.skip_value()?;
                    self.end_value()?;
                }
                Ok(())
            }
            Some(b'[') => {
                self.begin_array()?;
                if self.end_array() {
                    return Ok(());
                }
                loop {
                    self.count(1)?;
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

    // ---- objects ---------------------------------------------------------------------------

    /// Enters an object and stops at its first key or at its closing brace. Gives the place of the
    /// opening brace.
    ///
    /// # Errors
    /// `wrong_type`, `too_deep`, `bad_json`.
    #[inline]
    pub fn begin_object(&mut self) -> Result<usize, BodyError> {
        if self.peek() != Some(b'{') {
            return Err(self.unexpected("an object"));
        }
        let start = self.at;
        self.enter()?;
        match self.peek() {
            Some(b'"' | b'}') => Ok(start),
            _ => Err(self.bad_json("a key in quotes or `}` is expected here")),
        }
    }

    /// Reads the closing brace if it comes next.
    #[inline]
    pub fn end_object(&mut self) -> bool {
        let ends = self.byte() == Some(b'}');
        if ends {
            self.leave();
        }
        ends
    }

    /// Reads a key and its colon.
    ///
    /// # Errors
    /// `bad_json`, `lone_surrogate`.
    pub fn key(&mut self) -> Result<Cow<'a, str>, BodyError> {
        let key = self.string()?;
        self.colon()?;
        Ok(key)
    }

    fn skip_key(&mut self) -> Result<(), BodyError> {
        self.skip_string()?;
        self.colon()
    }

    #[inline]
    fn colon(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b':') {
            return Err(self.bad_json("`:` is expected after a key"));
        }
        self.at += 1;
        Ok(())
    }

    /// Reads what follows a value in an object: a comma, up to the next key, or nothing, up to the
    /// closing brace.
    ///
    /// # Errors
    /// `bad_json`.
    #[inline]
    pub fn end_value(&mut self) -> Result<(), BodyError> {
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

    // ---- lists -----------------------------------------------------------------------------

    /// Enters a list.
    ///
    /// # Errors
    /// `wrong_type`, `too_deep`.
    #[inline]
    pub fn begin_array(&mut self) -> Result<(), BodyError> {
        if self.peek() != Some(b'[') {
            return Err(self.unexpected("a list"));
        }
        self.enter()
    }

    /// Reads the closing bracket if it comes next. Only for an empty list: behind a comma a bracket
    /// is a fault.
    #[inline]
    pub fn end_array(&mut self) -> bool {
        let ends = self.peek() == Some(b']');
        if ends {
            self.leave();
        }
        ends
    }

    /// Reads what follows an item of a list; whether another one comes.
    ///
    /// # Errors
    /// `bad_json`.
    #[inline]
    pub fn next_item(&mut self) -> Result<bool, BodyError> {
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

    /// Reads a list whose items `read` reads.
    ///
    /// # Errors
    /// `wrong_type`, `too_deep`, `bad_json`, `too_many_values`, `lists_too_large`, or what is wrong
    /// with an item.
    #[inline]
    pub fn list<T>(
        &mut self,
        read: impl Fn(&mut Self) -> Result<T, BodyError>,
    ) -> Result<Vec<T>, BodyError> {
        self.begin_array()?;
        let mut items = Vec::new();
        if self.end_array() {
            return Ok(items);
        }
        loop {
            let item = read(self)?;
            if items.len() == items.capacity() {
                let more = self.more_items(items.len(), size_of::<T>())?;
                items.reserve_exact(more);
            }
            items.push(item);
            if !self.next_item()? {
                self.count(items.len())?;
                return Ok(items);
            }
        }
    }

    /// How many items a list of `length` makes room for: as many as it has, but no more than the
    /// rest of the text may bring. They are paid for here, and counted at the end of the list.
    #[cold]
    fn more_items(&mut self, length: usize, size: usize) -> Result<usize, BodyError> {
        if length >= self.values {
            return Err(self.too_many_values());
        }
        // One has been read, and any other takes a comma and a byte at least.
        let more = length.max(4).min(1 + self.rest().len() / 2);
        let Some(left) = self.list_bytes.checked_sub(more.saturating_mul(size)) else {
            return Err(self.fault(
                BodyErrorKind::ListsTooLarge,
                "the lists take more memory than the limit; send less or raise `json_list_bytes`",
            ));
        };
        self.list_bytes = left;
        Ok(more)
    }

    /// Counts keys or items.
    #[inline]
    pub(super) fn count(&mut self, values: usize) -> Result<(), BodyError> {
        let Some(left) = self.values.checked_sub(values) else {
            return Err(self.too_many_values());
        };
        self.values = left;
        Ok(())
    }

    #[cold]
    fn too_many_values(&self) -> BodyError {
        self.fault(
            BodyErrorKind::TooManyValues,
            "more keys and items than the limit; send less or raise `json_values`",
        )
    }

    #[inline]
    fn enter(&mut self) -> Result<(), BodyError> {
        let Some(depth) = self.depth.checked_sub(1) else {
            return Err(self.fault(
                BodyErrorKind::TooDeep,
                "nested deeper than the limit; send a flatter body or raise `json_depth`",
            ));
        };
        self.depth = depth;
        self.at += 1;
        Ok(())
    }

    #[inline]
    fn leave(&mut self) {
        self.depth += 1;
        self.at += 1;
    }

    // ---- the whole text --------------------------------------------------------------------

    /// Checks that nothing but whitespace is left.
    ///
    /// # Errors
    /// `bad_json`.
    pub fn end(&mut self) -> Result<(), BodyError> {
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.bad_json("nothing may follow the value")),
        }
    }

    // ---- faults ----------------------------------------------------------------------------

    /// A fault at this place.
    #[cold]
    #[must_use]
    pub fn fault(&self, kind: BodyErrorKind, detail: impl Into<Cow<'static, str>>) -> BodyError {
        BodyError::new(kind, detail).at(self.at)
    }

    #[cold]
    pub(super) fn bad_json(&self, detail: &'static str) -> BodyError {
        let end = if self.at >= self.text.len() {
            "; the text ends"
        } else {
            ""
        };
        self.fault(BodyErrorKind::BadJson, format!("{detail}{end}"))
    }

    /// The fault of a value of another kind than `wanted`.
    #[cold]
    #[must_use]
    pub fn unexpected(&mut self, wanted: &str) -> BodyError {
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
            BodyErrorKind::WrongType,
            format!("found {found}; send {wanted}"),
        )
    }
}
