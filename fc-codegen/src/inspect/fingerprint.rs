//! The fingerprint of a spec, for the packages that are generated from it.

use super::tree;
use fc_spec::model::{Dump, Model, Value, fingerprint as digits};

/// Returns the fingerprint of a spec: twelve hex digits.
///
/// It changes with everything that a package contains, also with texts. Positions in files and waivers do not count, so
/// a release keeps the fingerprint of the spec that was released.
#[must_use]
pub fn fingerprint(model: &Model) -> String {
    let mut dump = tree(&Dump::from(model));
    dump.set("waivers", Value::Null);
    forget_positions(&mut dump);
    digits([dump.to_string().as_str()])
}

/// Removes every `place` with a line from a dump.
fn forget_positions(value: &mut Value) {
    match value {
        Value::Object(entries) => {
            entries.retain(|(key, value)| key != "place" || value.get("line").is_none());
            for (_, value) in entries {
                forget_positions(value);
            }
        }
        Value::Array(items) => items.iter_mut().for_each(forget_positions),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}
