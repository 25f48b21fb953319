//! Places in a JSON value, and changes at a place.

use fc_reflect::Key;
use fc_spec::model::Value;
use std::fmt;

/// A place in a value, from its root.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Path(Vec<Key>);

impl Path {
    /// Returns this path with one more key.
    pub(super) fn key(&self, key: &str) -> Self {
        self.with(Key::Name(key.to_owned()))
    }

    /// Returns this path with one more item.
    pub(super) fn item(&self, index: usize) -> Self {
        self.with(Key::Item(index))
    }

    /// Returns the path of the parent.
    pub(super) fn parent(&self) -> Self {
        let (_, steps) = self.0.split_last().unzip();
        Self(steps.map(<[Key]>::to_vec).unwrap_or_default())
    }

    fn with(&self, step: Key) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

/// Writes the path as in errors: `data.stations[0].x`.
impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, step) in self.0.iter().enumerate() {
            match step {
                Key::Name(key) if index == 0 => write!(f, "{key}")?,
                Key::Name(key) => write!(f, ".{key}")?,
                Key::Item(item) => write!(f, "[{item}]")?,
            }
        }
        Ok(())
    }
}

/// Returns the value at a place.
pub(super) fn get<'v>(value: &'v Value, path: &Path) -> Option<&'v Value> {
    path.0
        .iter()
        .try_fold(value, |value, step| match (value, step) {
            (Value::Array(items), Key::Item(index)) => items.get(*index),
            (value, Key::Name(key)) => value.get(key),
            _ => None,
        })
}

/// Returns a copy with another value at a place. A new key is added last. If the parent does not exist, the copy is
/// unchanged.
pub(super) fn replaced(value: &Value, path: &Path, new: Value) -> Value {
    changed(value, path, |parent, step| match (parent, step) {
        (Value::Array(items), Key::Item(index)) => {
            if let Some(item) = items.get_mut(*index) {
                *item = new;
            }
        }
        (parent, Key::Name(key)) => parent.set(key, new),
        _ => {}
    })
}

/// Returns a copy without the key at the end of a path.
pub(super) fn removed(value: &Value, path: &Path) -> Value {
    with_keys(value, path, |entries, key| {
        entries.retain(|(name, _)| name != key);
    })
}

/// Returns a copy in which the key at the end of a path is repeated after all other keys.
pub(super) fn doubled(value: &Value, path: &Path) -> Value {
    with_keys(value, path, |entries, key| {
        let entry = entries.iter().find(|(name, _)| name == key);
        entries.extend(entry.cloned());
    })
}

/// Returns a copy in which the key at the end of a path has another name.
pub(super) fn renamed(value: &Value, path: &Path, new: &str) -> Value {
    with_keys(value, path, |entries, key| {
        if let Some((name, _)) = entries.iter_mut().find(|(name, _)| name == key) {
            new.clone_into(name);
        }
    })
}

/// Returns a copy in which `change` changes the object that contains the end of a path.
fn with_keys(
    value: &Value,
    path: &Path,
    change: impl FnOnce(&mut Vec<(String, Value)>, &str),
) -> Value {
    changed(value, path, |parent, step| {
        if let (Value::Object(entries), Key::Name(key)) = (parent, step) {
            change(entries, key);
        }
    })
}

/// Returns a copy in which `change` changes the parent of the end of a path.
fn changed(value: &Value, path: &Path, change: impl FnOnce(&mut Value, &Key)) -> Value {
    let mut copy = value.clone();
    if let Some((last, steps)) = path.0.split_last() {
        let parent = steps
            .iter()
            .try_fold(&mut copy, |value, step| match (value, step) {
                (Value::Array(items), Key::Item(index)) => items.get_mut(*index),
                (value, Key::Name(key)) => value.get_mut(key),
                _ => None,
            });
        if let Some(parent) = parent {
            change(parent, last);
        }
    }
    copy
}
