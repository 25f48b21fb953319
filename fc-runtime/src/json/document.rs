//! Whole texts: bytes in, a value or a placed error out.

use super::{BodyError, BodyErrorKind, FromJson, MAX_DEPTH, Reader, ToJson, Writer, locate};
use crate::message::{Enveloped, Message};

/// Reads a text as one value with nothing but whitespace around it.
///
/// # Errors
/// What is wrong with the text, placed.
pub fn from_str<T: FromJson>(text: &str, max_depth: usize) -> Result<T, BodyError> {
    let mut reader = Reader::new(text, max_depth);
    let value = T::read(&mut reader).and_then(|value| reader.end().map(|()| value));
    value.map_err(|error| placed(text, max_depth, error))
}

/// Reads bytes as [`from_str`] reads text.
///
/// # Errors
/// `not_utf8`, or what is wrong with the text, placed.
pub fn from_slice<T: FromJson>(bytes: &[u8], max_depth: usize) -> Result<T, BodyError> {
    from_str(utf8(bytes)?, max_depth)
}

/// Reads the body of a frame as a message. No bytes are read as `{}`.
///
/// # Errors
/// What is wrong with the body, placed; `not_an_object` if it is another JSON value.
pub fn decode<M: Message>(bytes: &[u8], max_depth: usize) -> Result<M, BodyError> {
    let text = body_text(bytes)?;
    let mut reader = Reader::new(text, max_depth);
    let message = expect_object(&mut reader)
        .and_then(|()| reader.message())
        .and_then(|message| reader.end().map(|()| message));
    message.map_err(|error| placed(text, max_depth, error))
}

/// Writes a value as JSON text.
#[must_use]
pub fn to_vec<T: ToJson>(value: &T) -> Vec<u8> {
    let mut out = Vec::new();
    value.write(&mut Writer::new(&mut out));
    out
}

/// See [`read_enveloped`](crate::message::read_enveloped).
pub(crate) fn enveloped<E: Message, B: Message>(
    bytes: &[u8],
    max_depth: usize,
) -> Result<Enveloped<E, B>, BodyError> {
    let text = body_text(bytes)?;
    let mut reader = Reader::new(text, max_depth);
    both(&mut reader)
        .map(|(envelope, body)| Enveloped {
            envelope,
            body: body.map_err(|error| placed(text, max_depth, error)),
        })
        .or_else(|error| match error {
            Failed::Envelope(error) => Err(error),
            // The own keys must not cost the envelope: read it again, alone.
            Failed::Body(error) => {
                let mut reader = Reader::new(text, max_depth);
                let envelope = reader.message_skipping_unknown()?;
                Ok(Enveloped {
                    envelope,
                    body: Err(placed(text, max_depth, error)),
                })
            }
        })
        .map_err(|error| placed(text, max_depth, error))
}

/// Which half of a message with an envelope could not be read.
enum Failed {
    Envelope(BodyError),
    Body(BodyError),
}

fn both<E: Message, B: Message>(
    reader: &mut Reader<'_>,
) -> Result<(E, Result<B, BodyError>), Failed> {
    use Failed::{Body, Envelope};

    expect_object(reader).map_err(Envelope)?;
    let start = reader.begin_object().map_err(Envelope)?;
    let mut envelope = E::Partial::default();
    let mut body = B::Partial::default();
    loop {
        E::read_in_order(&mut envelope, reader).map_err(Envelope)?;
        B::read_in_order(&mut body, reader).map_err(Body)?;
        if reader.end_object() {
            break;
        }
        let key = reader.key().map_err(Envelope)?;
        if !E::read_field(&mut envelope, &key, reader).map_err(Envelope)?
            && !B::read_field(&mut body, &key, reader).map_err(Body)?
        {
            B::read_unknown(&mut body, &key, reader).map_err(Body)?;
        }
        reader.end_value().map_err(Envelope)?;
    }
    reader.end().map_err(Envelope)?;
    let envelope = complete(envelope, start).map_err(Envelope)?;
    Ok((envelope, complete(body, start)))
}

impl Reader<'_> {
    /// Reads an object as a message.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn message<M: Message>(&mut self) -> Result<M, BodyError> {
        let start = self.begin_object()?;
        let mut partial = M::Partial::default();
        loop {
            M::read_in_order(&mut partial, self)?;
            if self.end_object() {
                return complete(partial, start);
            }
            let key = self.key()?;
            if !M::read_field(&mut partial, &key, self)? {
                M::read_unknown(&mut partial, &key, self)?;
            }
            self.end_value()?;
        }
    }

    /// Reads an object as a message and forgets every other key.
    fn message_skipping_unknown<M: Message>(&mut self) -> Result<M, BodyError> {
        let start = self.begin_object()?;
        let mut partial = M::Partial::default();
        while !self.end_object() {
            let key = self.key()?;
            if !M::read_field(&mut partial, &key, self)? {
                self.skip_value()?;
            }
            self.end_value()?;
        }
        self.end()?;
        complete(partial, start)
    }
}

/// Makes the message and checks its own constraints; what is inside has been checked already.
fn complete<M: Message>(partial: M::Partial, start: usize) -> Result<M, BodyError> {
    M::finish(partial)
        .and_then(|message| message.check_own().map(|()| message))
        .map_err(|error| error.at(start))
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

/// A body that is another JSON value than an object has an error of its own.
fn expect_object(reader: &mut Reader<'_>) -> Result<(), BodyError> {
    if reader.peek() == Some(b'{') {
        return Ok(());
    }
    let fault = reader.unexpected("an object");
    Err(fault.with_kind(BodyErrorKind::NotAnObject))
}

/// Completes an error on its way out.
///
/// A text that is not JSON is `bad_json` (or `too_deep`) whatever else was wrong before that place,
/// so that the error's name does not depend on the order in which a product looks at things.
#[cold]
fn placed(text: &str, max_depth: usize, error: BodyError) -> BodyError {
    let mut reader = Reader::new(text, max_depth);
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
