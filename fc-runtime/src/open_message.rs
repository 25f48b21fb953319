//! A message with any keys, to add an envelope to a JSON object and to remove it.

use crate::json::{Extra, ObjectWriter, Reader};
use crate::message::Message;

/// A message that keeps all keys unchanged.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OpenMessage(Extra);

#[cfg(feature = "server")]
impl OpenMessage {
    /// Returns the keys that `others` does not have.
    pub(crate) fn without(&self, others: &Self) -> Self {
        let mut left = Extra::new();
        let missing = self.0.iter().filter(|(key, _)| others.0.get(key).is_none());
        for (key, value) in missing {
            left.insert(key, value.to_json());
        }
        Self(left)
    }
}

impl Message for OpenMessage {
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
