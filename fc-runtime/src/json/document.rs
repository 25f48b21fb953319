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
    let place = |error| placed(text, max_depth, error);
    let mut envelope = FieldsOf::<E>::new();
    let mut body = FieldsOf::<B>::new();
    match Reader::new(text, max_depth).fill_both(&mut envelope, &mut body) {
        Ok(start) => Ok(Enveloped {
            envelope: envelope.finish(start).map_err(place)?,
            body: body.finish(start).map_err(place),
        }),
        Err(Failed::Envelope(error)) => Err(place(error)),
        // The own keys must not cost the envelope: read it again, alone.
        Err(Failed::Body(error)) => {
            let mut envelope = FieldsOf::<E>::new();
            match Reader::new(text, max_depth).fill_both(&mut envelope, &mut Skipped) {
                Ok(start) => Ok(Enveloped {
                    envelope: envelope.finish(start).map_err(place)?,
                    body: Err(place(error)),
                }),
                Err(Failed::Envelope(error) | Failed::Body(error)) => Err(place(error)),
            }
        }
    }
}

/// Which half of a message with an envelope could not be read.
enum Failed {
    Envelope(BodyError),
    Body(BodyError),
}

/// Fields of a message that are being read, without the message's type: the loops over keys are then
/// compiled once and not for every message.
trait Fields {
    fn read_in_order(&mut self, reader: &mut Reader<'_>) -> Result<(), BodyError>;
    fn read_field(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<bool, BodyError>;
    fn read_unknown(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<(), BodyError>;
}

struct FieldsOf<M: Message>(M::Partial);

impl<M: Message> FieldsOf<M> {
    fn new() -> Self {
        Self(M::Partial::default())
    }

    /// Makes the message of an object that started at `start`.
    fn finish(self, start: usize) -> Result<M, BodyError> {
        M::finish(self.0).map_err(|error| error.at(start))
    }
}

impl<M: Message> Fields for FieldsOf<M> {
    fn read_in_order(&mut self, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        M::read_in_order(&mut self.0, reader)
    }

    fn read_field(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<bool, BodyError> {
        M::read_field(&mut self.0, key, reader)
    }

    fn read_unknown(&mut self, key: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        M::read_unknown(&mut self.0, key, reader)
    }
}

/// Fields that nobody wants.
struct Skipped;

impl Fields for Skipped {
    fn read_in_order(&mut self, _: &mut Reader<'_>) -> Result<(), BodyError> {
        Ok(())
    }

    fn read_field(&mut self, _: &str, _: &mut Reader<'_>) -> Result<bool, BodyError> {
        Ok(false)
    }

    fn read_unknown(&mut self, _: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        reader.skip_value()
    }
}

impl Reader<'_> {
    /// Reads an object as a message.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn message<M: Message>(&mut self) -> Result<M, BodyError> {
        let mut fields = FieldsOf::<M>::new();
        let start = self.fill(&mut fields)?;
        fields.finish(start)
    }

    /// Reads an object into fields. Gives the place of its opening brace.
    fn fill(&mut self, fields: &mut dyn Fields) -> Result<usize, BodyError> {
        let start = self.begin_object()?;
        loop {
            fields.read_in_order(self)?;
            if self.end_object() {
                return Ok(start);
            }
            let key = self.key()?;
            if !fields.read_field(&key, self)? {
                fields.read_unknown(&key, self)?;
            }
            self.end_value()?;
        }
    }

    /// Reads a whole text that is an object into the fields of an envelope and of a body.
    fn fill_both(
        &mut self,
        envelope: &mut dyn Fields,
        body: &mut dyn Fields,
    ) -> Result<usize, Failed> {
        use Failed::{Body, Envelope};

        expect_object(self).map_err(Envelope)?;
        let start = self.begin_object().map_err(Envelope)?;
        loop {
            envelope.read_in_order(self).map_err(Envelope)?;
            body.read_in_order(self).map_err(Body)?;
            if self.end_object() {
                break;
            }
            let key = self.key().map_err(Envelope)?;
            if !envelope.read_field(&key, self).map_err(Envelope)?
                && !body.read_field(&key, self).map_err(Body)?
            {
                body.read_unknown(&key, self).map_err(Body)?;
            }
            self.end_value().map_err(Envelope)?;
        }
        self.end().map_err(Envelope)?;
        Ok(start)
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
