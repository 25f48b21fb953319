//! Whole texts: bytes in, a value or an error with its position out.

use super::fields::{Failed, Fields, FieldsOf, finish};
use super::{
    Allowance, BodyError, BodyErrorKind, FromJson, MAX_DEPTH, Reader, ToJson, Writer, locate,
};
use crate::message::{Empty, Enveloped, Message};

/// Reads a text as one value. Whitespace may surround it.
///
/// # Errors
/// The error of the text, with its position.
pub fn from_str<T: FromJson>(text: &str, allowance: Allowance) -> Result<T, BodyError> {
    let mut reader = Reader::new(text, allowance);
    let value = T::read(&mut reader).and_then(|value| reader.end().map(|()| value));
    value.map_err(|error| placed(text, allowance, error))
}

/// Reads bytes as [`from_str`] reads text.
///
/// # Errors
/// `not_utf8`, or the error of the text, with its position.
pub fn from_slice<T: FromJson>(bytes: &[u8], allowance: Allowance) -> Result<T, BodyError> {
    from_str(utf8(bytes)?, allowance)
}

/// Reads the body of a frame with `read`, which gets a reader in front of an object. An empty body is read as `{}`.
/// This is for bodies whose type is unknown at compile time.
///
/// # Errors
/// `not_utf8`, `not_an_object`, or the error of `read`, with its position. If the text is not JSON, that error takes
/// precedence.
pub fn read_object<'a, T>(
    bytes: &'a [u8],
    allowance: Allowance,
    read: impl FnOnce(&mut Reader<'a>) -> Result<T, BodyError>,
) -> Result<T, BodyError> {
    let text = body_text(bytes)?;
    let mut reader = Reader::new(text, allowance);
    let value = reader.expect_object().and_then(|()| read(&mut reader));
    value.map_err(|error| placed(text, allowance, error))
}

/// Reads the body of a frame as a message. An empty body is read as `{}`.
///
/// # Errors
/// The error of the body, with its position; `not_an_object` for any other JSON value.
pub fn decode<M: Message>(bytes: &[u8], allowance: Allowance) -> Result<M, BodyError> {
    let mut slots = M::slots();
    match fill(bytes, allowance, &mut FieldsOf::<M>(&mut slots)) {
        Ok(filled) => filled.finish(slots),
        Err(error) => Err(error),
    }
}

/// Reads a body into the fields of one message.
fn fill<'a>(
    bytes: &'a [u8],
    allowance: Allowance,
    fields: &mut dyn Fields,
) -> Result<Filled<'a>, BodyError> {
    let text = body_text(bytes)?;
    let mut reader = Reader::new(text, allowance);
    let filled = reader.expect_object().and_then(|()| {
        let start = reader.object(fields)?;
        reader.end()?;
        Ok(start)
    });
    match filled {
        Ok(start) => Ok(Filled::new(&reader, allowance, start)),
        Err(error) => Err(placed(text, allowance, error)),
    }
}

/// A body whose fields have been read.
struct Filled<'a> {
    text: &'a str,
    allowance: Allowance,
    /// Offset of the object's opening brace.
    start: usize,
    /// Memory of its lists, in bytes.
    lists: usize,
}

impl<'a> Filled<'a> {
    fn new(reader: &Reader<'a>, allowance: Allowance, start: usize) -> Self {
        Self {
            text: reader.text,
            allowance,
            start,
            lists: allowance.list_bytes - reader.list_bytes,
        }
    }

    /// Creates the message from the slots.
    fn finish<M: Message>(&self, slots: M::Slots) -> Result<M, BodyError> {
        match finish(slots, self.text, self.start) {
            Ok(message) => Ok(message),
            Err(error) => Err(placed(self.text, self.allowance, error)),
        }
    }
}

/// Writes a value as JSON text.
#[must_use]
pub fn to_vec<T: ToJson>(value: &T) -> Vec<u8> {
    let mut out = Vec::new();
    value.write(&mut Writer::new(&mut out));
    out
}

/// Implements [`read_enveloped`](crate::message::read_enveloped). Returns also the memory of the body's lists, in
/// bytes.
pub(crate) fn enveloped<E: Message, B: Message>(
    bytes: &[u8],
    allowance: Allowance,
) -> Result<(Enveloped<E, B>, usize), BodyError> {
    let mut envelope = E::slots();
    let mut body = B::slots();
    let filled = fill_both(
        bytes,
        allowance,
        &mut FieldsOf::<E>(&mut envelope),
        &mut FieldsOf::<B>(&mut body),
    );
    match filled {
        Ok(filled) => {
            let enveloped = Enveloped {
                envelope: filled.finish(envelope)?,
                body: filled.finish(body),
            };
            Ok((enveloped, filled.lists))
        }
        Err(Failed::Envelope(error)) => Err(error),
        // An error in the body must not lose the envelope: read the envelope again, alone.
        Err(Failed::Body(error)) => {
            let (alone, _) = enveloped::<E, Empty>(bytes, allowance)?;
            let enveloped = Enveloped {
                envelope: alone.envelope,
                body: Err(error),
            };
            Ok((enveloped, 0))
        }
    }
}

/// Reads a body into the fields of an envelope and of a message.
fn fill_both<'a>(
    bytes: &'a [u8],
    allowance: Allowance,
    envelope: &mut dyn Fields,
    body: &mut dyn Fields,
) -> Result<Filled<'a>, Failed> {
    let text = body_text(bytes).map_err(Failed::Envelope)?;
    let mut reader = Reader::new(text, allowance);
    match reader.fill_both(envelope, body) {
        Ok(start) => Ok(Filled::new(&reader, allowance, start)),
        Err(Failed::Envelope(error)) => Err(Failed::Envelope(placed(text, allowance, error))),
        Err(Failed::Body(error)) => Err(Failed::Body(placed(text, allowance, error))),
    }
}

fn utf8(bytes: &[u8]) -> Result<&str, BodyError> {
    simdutf8::basic::from_utf8(bytes).map_err(|_| {
        let valid = std::str::from_utf8(bytes).map_or_else(|error| error.valid_up_to(), str::len);
        BodyError::new(BodyErrorKind::NotUtf8, "a body is UTF-8 text").at(valid)
    })
}

fn body_text(bytes: &[u8]) -> Result<&str, BodyError> {
    if bytes.is_empty() {
        Ok("{}")
    } else {
        utf8(bytes)
    }
}

impl Reader<'_> {
    /// Returns the error of a body that is not an object.
    pub(super) fn expect_object(&mut self) -> Result<(), BodyError> {
        if self.peek() == Some(b'{') {
            return Ok(());
        }
        let fault = self.unexpected("an object");
        Err(fault.with_kind(BodyErrorKind::NotAnObject))
    }
}

/// Adds the position to an error.
///
/// A text that is not JSON is `bad_json`, `too_deep` or `too_many_values`, even if another error comes first. So the
/// name of the error does not depend on the order in which an implementation checks a text.
#[cold]
fn placed(text: &str, allowance: Allowance, error: BodyError) -> BodyError {
    let mut reader = Reader::new(text, allowance);
    let error = match reader.skip_value().and_then(|()| reader.end()) {
        Ok(()) => error,
        Err(grammar) => grammar,
    };
    let offset = error.noted_offset().unwrap_or(0);
    let mut path = locate::path(text, offset);
    if !path.is_empty() && !error.path().is_empty() && !error.path().starts_with('[') {
        path.push('.');
    }
    path.push_str(error.path());
    error.placed(offset, path)
}

const _: () = assert!(
    MAX_DEPTH < 128,
    "serde_json must be able to read what is kept as text"
);
