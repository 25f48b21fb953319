//! A message of any keys, to add an envelope to what has none and to take it off again.

use crate::json::{Extra, ObjectWriter, Reader};
use crate::message::Message;

/// A message all of whose keys are kept as they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Keys(Extra);

impl Message for Keys {
    type Slots = Extra;

    fn slots() -> Extra {
        Extra::new()
    }

    fn read_fields(slots: &mut Extra, reader: &mut Reader<'_>) {
        reader.extra(slots);
    }

    fn finish(slots: Extra) -> Option<Self> {
        Some(Self(slots))
    }

    fn write_fields(&self, object: &mut ObjectWriter<'_>) {
        object.extra(&self.0);
    }
}
