//! Messages: JSON objects with known keys, alone or together with the keys of an envelope.

use crate::json::{Allowance, BodyError, FromJson, ObjectWriter, Reader, ToJson, Writer, decode};

/// A JSON object with known keys. `#[derive(Message)]` implements it.
///
/// A message is read in steps, so that one pass over an object can fill an envelope and a body. All readers get the
/// fields from [`read_fields`](Self::read_fields).
#[diagnostic::on_unimplemented(message = "`{Self}` is not a message", note = "derive `Message`")]
pub trait Message: Sized + Send + Sync + 'static {
    /// The values read so far, with a slot for each field.
    type Slots;

    /// The spec's example in wire form, without the keys of the envelope; `{}` if there is none.
    const EXAMPLE: &'static str = "{}";

    /// Returns empty slots. A full slot means that its key has occurred.
    fn slots() -> Self::Slots;

    /// Names every field to the reader in the order in which they are written, followed by the field for unknown keys.
    /// The reader fills the slots of the fields it finds. A value that cannot be read ends the reading.
    fn read_fields(slots: &mut Self::Slots, reader: &mut Reader<'_>);

    /// Creates the message, or returns `None` if a required field is missing. A missing optional field is
    /// [absent](FromJson::absent).
    fn finish(slots: Self::Slots) -> Option<Self>;

    /// Writes the keys of this message.
    fn write_fields(&self, object: &mut ObjectWriter<'_>);

    /// Checks the constraints on the fields of this message, but not those of messages inside.
    ///
    /// # Errors
    /// The first violation: `out_of_range`, `bad_length` or `bad_pattern`.
    fn check_own(&self) -> Result<(), BodyError> {
        Ok(())
    }

    /// Checks all constraints of the spec, also in messages inside, and that every float is finite. Reading checks the
    /// same.
    ///
    /// # Errors
    /// The first violation: `out_of_range`, also for NaN and infinities, `bad_length` or `bad_pattern`.
    fn check(&self) -> Result<(), BodyError> {
        self.check_own()
    }

    /// Returns the spec's example.
    ///
    /// # Panics
    /// If [`EXAMPLE`](Self::EXAMPLE) is not such a message. A generated example has been checked. Test a handwritten
    /// one by calling this.
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

/// A message with its envelope, read in one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Enveloped<E, B> {
    /// The keys of the envelope.
    pub envelope: E,
    /// The message, or its error. A refusal consists of an envelope alone, so an error here does not lose the envelope.
    pub body: Result<B, BodyError>,
}

/// Reads the keys of an envelope and of a body in any order, in one pass.
///
/// Empty text is read as `{}`. Unknown keys belong to the body.
///
/// # Errors
/// An error of the whole text or the envelope: `not_utf8`, `bad_json`, `not_an_object`, `too_deep`, `too_many_values`,
/// `lone_surrogate` in a key, or the error of an envelope key.
pub fn read_enveloped<E: Message, B: Message>(
    text: &[u8],
    allowance: Allowance,
) -> Result<Enveloped<E, B>, BodyError> {
    crate::json::enveloped(text, allowance).map(|(read, _)| read)
}

/// Appends the keys of an envelope and of a body to `out`, as one object.
pub fn write_enveloped<E: Message, B: Message>(envelope: &E, body: &B, out: &mut Vec<u8>) {
    let mut writer = Writer::new(out);
    let mut object = writer.object();
    envelope.write_fields(&mut object);
    body.write_fields(&mut object);
    object.end();
}

/// Reads the keys of the body as the message `M` and writes it again in canonical form.
///
/// # Errors
/// The error of the body, also if it exceeds [`Allowance::DEFAULT`].
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

/// Checks that the keys of the body can be read as the message `M`.
pub(crate) fn check<M: Message>(text: &[u8], allowance: Allowance) -> Result<(), BodyError> {
    decode::<M>(text, allowance).map(drop)
}

/// A message without keys. Unknown keys are skipped.
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
