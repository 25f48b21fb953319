//! A message of any keys, to add an envelope to what has none and to take it off again.

use crate::json::{Extra, ObjectWriter, Reader};
use crate::message::Message;

/// A message all of whose keys are kept as they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OpenMessage(Extra);

#[cfg(feature = "server")]
impl OpenMessage {
    /// Those that are not among `others`.
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
