//! Messages: JSON objects with known keys, alone or beside the keys of an envelope.

use crate::json::{BodyError, FromJson, ObjectWriter, Reader, ToJson, Writer, decode};

/// A key of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Its name on the wire.
    pub name: &'static str,
    /// Other names that are read as well.
    pub also: &'static [&'static str],
    /// Whether a message without it is refused.
    pub required: bool,
}

/// A JSON object with known keys. `#[derive(Message)]` writes it.
///
/// A message is read in steps, so that one pass over an object can fill two of them: an envelope
/// and a body.
#[diagnostic::on_unimplemented(message = "`{Self}` is no message", note = "derive `Message`")]
pub trait Message: FromJson + ToJson + Send + Sync + 'static {
    /// The fields read so far.
    type Partial: Default;

    /// The known keys, in the order in which they are written.
    const KEYS: &'static [Key];

    /// The spec's example in wire form, own keys only; `{}` if there is none.
    const EXAMPLE: &'static str = "{}";

    /// Reads fields as long as their keys come in the order of [`KEYS`](Self::KEYS), and leaves the
    /// reader in front of the next key. It may read none: whatever it leaves is looked up.
    ///
    /// # Errors
    /// What is wrong with a value.
    fn read_in_order(partial: &mut Self::Partial, reader: &mut Reader<'_>)
    -> Result<(), BodyError>;

    /// Reads the value of `key` if this message has that key; `false`, and nothing read, if not.
    ///
    /// # Errors
    /// What is wrong with the value.
    fn read_field(
        partial: &mut Self::Partial,
        key: &str,
        reader: &mut Reader<'_>,
    ) -> Result<bool, BodyError>;

    /// Keeps or skips the value of a key that this message does not have.
    ///
    /// # Errors
    /// What is wrong with the JSON.
    fn read_unknown(
        partial: &mut Self::Partial,
        key: &str,
        reader: &mut Reader<'_>,
    ) -> Result<(), BodyError>;

    /// Makes the message once all keys have been read.
    ///
    /// # Errors
    /// `missing_field`; the constraint that an own field breaks. (What is inside the fields has been
    /// checked already.)
    fn finish(partial: Self::Partial) -> Result<Self, BodyError>;

    /// Writes the own keys.
    fn write_fields(&self, object: &mut ObjectWriter<'_>);

    /// Whether the constraints on the own fields hold, whatever may be inside them.
    ///
    /// # Errors
    /// The first that does not: `out_of_range`, `bad_length` or `bad_pattern`.
    fn check_own(&self) -> Result<(), BodyError> {
        Ok(())
    }

    /// Whether the constraints of the spec hold, here and in everything inside. Reading checks them
    /// too.
    ///
    /// # Errors
    /// The first that does not: `out_of_range`, `bad_length` or `bad_pattern`.
    fn check(&self) -> Result<(), BodyError> {
        self.check_value()
    }

    /// The spec's example.
    ///
    /// # Panics
    /// If [`EXAMPLE`](Self::EXAMPLE) is not such a message. It is source code, not data: a
    /// generated one has been checked, a hand-written one deserves a test that calls this.
    #[must_use]
    #[allow(
        clippy::panic,
        reason = "documented: a wrong example is a fault of the source code"
    )]
    fn example() -> Self {
        match decode(Self::EXAMPLE.as_bytes(), crate::json::MAX_DEPTH) {
            Ok(message) => message,
            Err(error) => panic!("the example of this message cannot be read: {error}"),
        }
    }
}

/// What one pass over a message with an envelope makes of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Enveloped<E, B> {
    /// The keys of the envelope.
    pub envelope: E,
    /// The message's own keys, or what is wrong with them: a refusal that carries nothing but an
    /// envelope is still understood.
    pub body: Result<B, BodyError>,
}

/// Reads the keys of an envelope, of a body and unknown ones in any order, in one pass.
///
/// Empty text is read as `{}`. Unknown keys go to the body.
///
/// # Errors
/// What keeps even the envelope from being read: `not_utf8`, `bad_json`, `not_an_object`,
/// `too_deep`, or a fault of an envelope key.
pub fn read_enveloped<E: Message, B: Message>(
    text: &[u8],
    max_depth: usize,
) -> Result<Enveloped<E, B>, BodyError> {
    crate::json::enveloped(text, max_depth)
}

/// Writes the keys of an envelope and of a body as one object to the end of `out`.
pub fn write_enveloped<E: Message, B: Message>(envelope: &E, body: &B, out: &mut Vec<u8>) {
    let mut writer = Writer::new(out);
    let mut object = writer.object();
    envelope.write_fields(&mut object);
    body.write_fields(&mut object);
    object.end();
}

/// Reads the own keys as the message `M` and writes it again, in canonical form.
///
/// # Errors
/// What is wrong with the body.
pub fn transcode<M: Message>(text: &[u8]) -> Result<Vec<u8>, BodyError> {
    let message: M = decode(text, crate::json::MAX_DEPTH)?;
    let mut out = Vec::with_capacity(text.len());
    Writer::new(&mut out).message(&message);
    Ok(out)
}

/// A message without keys of its own; unknown ones are skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Empty;

impl FromJson for Empty {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.message()
    }
}

impl ToJson for Empty {
    fn write(&self, writer: &mut Writer<'_>) {
        writer.message(self);
    }
}

impl Message for Empty {
    type Partial = ();

    const KEYS: &'static [Key] = &[];

    fn read_in_order((): &mut (), _: &mut Reader<'_>) -> Result<(), BodyError> {
        Ok(())
    }

    fn read_field((): &mut (), _: &str, _: &mut Reader<'_>) -> Result<bool, BodyError> {
        Ok(false)
    }

    fn read_unknown((): &mut (), _: &str, reader: &mut Reader<'_>) -> Result<(), BodyError> {
        reader.skip_value()
    }

    fn finish((): ()) -> Result<Self, BodyError> {
        Ok(Self)
    }

    fn write_fields(&self, _: &mut ObjectWriter<'_>) {}
}
