//! A message of any keys, to add an envelope to what has none and to take it off again.

use crate::json::{BodyError, Extra, FromJson, ObjectWriter, Reader, ToJson, Writer};
use crate::message::{Key, Message};

/// A message all of whose keys are kept as they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Keys(Extra);

impl FromJson for Keys {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.message()
    }
}

impl ToJson for Keys {
    fn write(&self, writer: &mut Writer<'_>) {
        writer.message(self);
    }
}

impl Message for Keys {
    type Partial = Extra;

    const KEYS: &'static [Key] = &[];

    fn read_in_order(_: &mut Extra, _: &mut Reader<'_>) -> Result<(), BodyError> {
        Ok(())
    }

    fn read_field(_: &mut Extra, _: &str, _: &mut Reader<'_>) -> Result<bool, BodyError> {
        Ok(false)
    }

    fn read_unknown(
        partial: &mut Extra,
        key: &str,
        reader: &mut Reader<'_>,
    ) -> Result<(), BodyError> {
        partial.keep(key, reader)
    }

    fn finish(partial: Extra) -> Result<Self, BodyError> {
        Ok(Self(partial))
    }

    fn write_fields(&self, object: &mut ObjectWriter<'_>) {
        object.extra(&self.0);
    }

    fn check(&self) -> Result<(), BodyError> {
        Ok(())
    }
}
