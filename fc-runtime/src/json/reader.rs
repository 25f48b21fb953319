//! Reads JSON text, directed by the wanted type.

use super::reader_state::ReaderState;
use super::{Allowance, BodyError, BodyErrorKind};
use std::borrow::Cow;

/// A position in a JSON text.
///
/// Every method that reads a value skips the whitespace before it and stops right after it.
#[derive(Clone, Debug)]
pub struct Reader<'a> {
    pub(super) text: &'a str,
    /// Number of bytes read.
    pub(super) at: usize,
    /// Levels of nesting left.
    depth: usize,
    /// Keys and items left.
    pub(super) values: usize,
    /// Memory left for lists, in bytes.
    pub(super) list_bytes: usize,
    /// Reading, or the reason why no field is read.
    pub(super) state: ReaderState<'a>,
}

impl<'a> Reader<'a> {
    /// Creates a reader at the start of `text`.
    #[must_use]
    pub fn new(text: &'a str, allowance: Allowance) -> Self {
        Self {
            text,
            at: 0,
            depth: allowance.depth.min(super::MAX_DEPTH),
            values: allowance.values,
            list_bytes: allowance.list_bytes,
            state: ReaderState::Reading,
        }
    }

    /// Number of bytes read.
    #[must_use]
    pub fn offset(&self) -> usize {
        self.at
    }

    /// Skips whitespace and returns the next byte, or `None` at the end.
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

    /// Returns the next byte, which may be whitespace.
    #[inline]
    pub(super) fn byte(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// Returns the unread text.
    #[inline]
    pub(super) fn rest(&self) -> &'a [u8] {
        self.text.as_bytes().get(self.at..).unwrap_or_default()
    }

    /// Returns the text read since `start`.
    #[inline]
    pub(super) fn since(&self, start: usize) -> &'a str {
        self.text.get(start..self.at).unwrap_or_default()
    }

    /// Reads `literal` if it comes next.
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

    /// Reads the next value and returns its text.
    ///
    /// # Errors
    /// `bad_json`, `too_deep`, `too_many_values`.
    pub fn value_text(&mut self) -> Result<&'a str, BodyError> {
        self.peek();
        let start = self.at;
        self.skip_value()?;
        Ok(self.since(start))
    }

    /// Skips the next value.
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

    /// Enters an object and stops at its first key or closing brace. Returns the offset of the opening brace.
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

    /// Reads the comma after a value and stops at the next key, or stops at the closing brace.
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

    /// Reads the closing bracket if it comes next. Only for an empty list, because a bracket after a comma is an error.
    #[inline]
    pub fn end_array(&mut self) -> bool {
        let ends = self.peek() == Some(b']');
        if ends {
            self.leave();
        }
        ends
    }

    /// Reads the text after an item of a list. Returns `true` if another item follows.
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

    /// Reads a list with `read` for each item.
    ///
    /// # Errors
    /// `wrong_type`, `too_deep`, `bad_json`, `too_many_values`, `lists_too_large`, or the error of an item.
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

    /// Returns the number of items for which a list of `length` reserves memory: its length again, but not more than
    /// the rest of the text can contain. Subtracts their memory from the allowance. The items are counted at the end of
    /// the list.
    #[cold]
    fn more_items(&mut self, length: usize, size: usize) -> Result<usize, BodyError> {
        if length >= self.values {
            return Err(self.too_many_values());
        }
        // One item has been read. Each further item takes at least a comma and a byte.
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

    /// Checks that only whitespace is left.
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

    /// Creates an error at this position.
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

    /// Creates the error for a value of another kind than `wanted`.
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
