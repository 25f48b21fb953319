//! The entries for one side of an operation.

use crate::emit::json::{hex, object, text};
use crate::emit::packed;
use crate::sample::{Profile, SAMPLE_ID, Samples};
use fc_reflect::{FrameId, Reflector};
use fc_spec::model::{Direction, EncodingRole, Operation, StructRef, Value};

/// One side of an operation, with the context of its entries.
pub(super) struct Case<'a, 'm> {
    pub(super) reflector: &'a Reflector<'m>,
    pub(super) samples: &'a Samples<'m>,
    pub(super) operation: &'a Operation,
    pub(super) direction: Direction,
}

impl Case<'_, '_> {
    /// Returns the struct of the body, or `None` for raw bytes.
    pub(super) fn body_type(&self) -> Option<&StructRef> {
        Some(&self.operation.body(self.direction)?.ty)
    }

    /// Returns a whole message.
    pub(super) fn message(&self, profile: Profile) -> Value {
        self.samples
            .message(self.operation, self.direction, profile)
    }

    /// Returns the header fields of frames of this side, or `None` without a code.
    pub(super) fn id(&self) -> Option<FrameId> {
        self.reflector.id(self.operation, self.direction, SAMPLE_ID)
    }

    /// Returns `true` if this side has frames with this encoding.
    pub(super) fn packs(&self, encoding: EncodingRole) -> bool {
        let layout = &self.reflector.model().frame;
        let is_known = encoding == EncodingRole::Plain || layout.encoding(encoding).is_some();
        is_known && self.id().is_some()
    }

    /// Returns `frame` with a frame around the data, or `text` with the data if the operation has no code.
    pub(super) fn carrier(&self, data: &[u8], encoding: EncodingRole) -> (&'static str, Value) {
        match self.id() {
            Some(id) => {
                let frame = packed::frame(self.reflector, id, encoding, data);
                ("frame", text(&hex(&frame)))
            }
            None => ("text", text(&String::from_utf8_lossy(data))),
        }
    }

    pub(super) fn accepted(&self, case: &str, encoding: EncodingRole, body: Value) -> Value {
        let carrier = self.carrier(body.to_string().as_bytes(), encoding);
        self.entry(case, [("case", text(case)), carrier, ("body", body)])
    }

    pub(super) fn accepted_as(&self, case: &str, body: Value, canonical: &Value) -> Value {
        let is_canonical = body == *canonical;
        let mut entry = self.accepted(case, EncodingRole::Plain, body);
        if let Value::Object(entries) = &mut entry
            && !is_canonical
        {
            entries.push(("canonical".to_owned(), canonical.clone()));
        }
        entry
    }

    pub(super) fn accepted_bytes(&self, encoding: EncodingRole, data: &[u8]) -> Option<Value> {
        let case = encoding.name();
        self.packs(encoding).then(|| {
            let carrier = self.carrier(data, encoding);
            let data = ("data", text(&hex(data)));
            self.entry(case, [("case", text(case)), carrier, data])
        })
    }

    pub(super) fn rejected(
        &self,
        name: &str,
        carrier: (&'static str, Value),
        error: &str,
    ) -> Value {
        self.entry(name, [carrier, ("error", text(error))])
    }

    /// Returns an entry: its name, its direction, and further keys.
    fn entry<const N: usize>(&self, name: &str, keys: [(&str, Value); N]) -> Value {
        let side = self.direction.name();
        let name = ("name", text(&format!("{side}_{name}")));
        let start = [name, ("direction", text(side))];
        object(start.into_iter().chain(keys))
    }
}
