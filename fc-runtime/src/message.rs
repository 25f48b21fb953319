//! Messages: JSON objects with known keys, alone or beside the keys of an envelope.

use crate::json::{Allowance, BodyError, FromJson, ObjectWriter, Reader, ToJson, Writer, decode};

/// A JSON object with known keys. `#[derive(Message)]` writes it.
///
/// A message is read in steps, so that one pass over an object can fill two of them: an envelope
/// and a body. It names its fields in one place, [`read_fields`](Self::read_fields), whatever a
/// reader wants to know of them.
#[diagnostic::on_unimplemented(message = "`{Self}` is not a message", note = "derive `Message`")]
pub trait Message: Sized + Send + Sync + 'static {
    /// What has been read so far: a slot for each field.
    type Slots;

    /// The spec's example in wire form, own keys only; `{}` if there is none.
    const EXAMPLE: &'static str = "{}";

    /// The slots before anything is read, all empty: a slot that is full belongs to a key that has
    /// come.
    fn slots() -> Self::Slots;

    /// Names every field to the reader, in the order in which they are written, and then the place
    /// for unknown keys, if there is one. The reader fills the slots of those it finds; a value it
    /// cannot read ends the reading.
    fn read_fields(slots: &mut Self::Slots, reader: &mut Reader<'_>);

    /// Makes the message, unless a required field has not been read. A field that may be missing is
    /// then [absent](FromJson::absent).
    fn finish(slots: Self::Slots) -> Option<Self>;

    /// Writes the own keys.
    fn write_fields(&self, object: &mut ObjectWriter<'_>);

    /// Whether the constraints on the own fields hold, whatever may be inside them.
    ///
    /// # Errors
    /// The first that does not: `out_of_range`, `bad_length` or `bad_pattern`.
    fn check_own(&self) -> Result<(), BodyError> {
        Ok(())
    }

    /// Whether the constraints of the spec hold, here and in everything inside, and whether every float
    /// is a number. Reading checks them too.
    ///
    /// # Errors
    /// The first that does not: `out_of_range`, also of NaN and infinities, `bad_length` or `bad_pattern`.
    fn check(&self) -> Result<(), BodyError> {
        self.check_own()
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
        match decode(Self::EXAMPLE.as_bytes(), Allowance::ANY) {
            Ok(message) => message,
            Err(error) => panic!("the example of this message cannot be read: {error}"),
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Message> FromJson for M {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.message()
    }
}

#[diagnostic::do_not_recommend]
impl<M: Message> ToJson for M {
    fn write(&self, writer: &mut Writer<'_>) {
        let mut object = writer.object();
        self.write_fields(&mut object);
        object.end();
    }

    fn check_value(&self) -> Result<(), BodyError> {
        self.check()
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
/// `too_deep`, `too_many_values`, `lone_surrogate` in a key, or a fault of an envelope key.
pub fn read_enveloped<E: Message, B: Message>(
    text: &[u8],
    allowance: Allowance,
) -> Result<Enveloped<E, B>, BodyError> {
    crate::json::enveloped(text, allowance).map(|(read, _)| read)
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
/// What is wrong with the body, or that it takes more than [`Allowance::DEFAULT`].
pub fn transcode<M: Message>(text: &[u8]) -> Result<Vec<u8>, BodyError> {
    match decode::<M>(text, Allowance::DEFAULT) {
        Ok(message) => {
            let mut out = Vec::with_capacity(text.len());
            message.write(&mut Writer::new(&mut out));
            Ok(out)
        }
        Err(error) => Err(error),
    }
}

/// Reads the own keys as the message `M`, and keeps nothing.
pub(crate) fn check<M: Message>(text: &[u8], allowance: Allowance) -> Result<(), BodyError> {
    decode::<M>(text, allowance).map(drop)
}

/// A message without keys of its own; unknown ones are skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Empty;

impl Message for Empty {
    type Slots = ();

    fn slots() {}

    fn read_fields((): &mut (), _: &mut Reader<'_>) {}

    fn finish((): ()) -> Option<Self> {
        Some(Self)
    }

    fn write_fields(&self, _: &mut ObjectWriter<'_>) {}
}
