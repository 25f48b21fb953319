//! Places in a JSON value, and changing one of them.

use fc_spec::model::Value;
use std::fmt;

/// One step down into a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// The value of this key of an object.
    Key(String),
    /// This item of an array, counted from 0.
    Item(usize),
}

/// A place in a value, from its root.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Path(pub Vec<Step>);

impl Path {
    /// This path and one key more.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        self.with(Step::Key(key.to_owned()))
    }

    /// This path and one item more.
    #[must_use]
    pub fn item(&self, index: usize) -> Self {
        self.with(Step::Item(index))
    }

    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

/// `data.stations[0].x`, as errors print it.
impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if index == 0 => write!(f, "{key}")?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Item(item) => write!(f, "[{item}]")?,
            }
        }
        Ok(())
    }
}

/// The value at a place.
#[must_use]
pub fn get<'v>(value: &'v Value, path: &Path) -> Option<&'v Value> {
    path.0
        .iter()
        .try_fold(value, |value, step| match (value, step) {
            (Value::Object(_), Step::Key(key)) => value.get(key),
            (Value::Array(items), Step::Item(index)) => items.get(*index),
            _ => None,
        })
}

/// A copy with another value at a place; a key that is not there yet is added last.
/// Unchanged where the way there is missing.
#[must_use]
pub fn replaced(value: &Value, path: &Path, new: Value) -> Value {
    let mut copy = value.clone();
    if let Some((Step::Key(key), parent)) = path.0.split_last()
        && let Some(Value::Object(entries)) = get_mut(&mut copy, parent)
    {
        match entries.iter_mut().find(|(name, _)| name == key) {
            Some((_, value)) => *value = new,
            None => entries.push((key.clone(), new)),
        }
    } else if let Some(place) = get_mut(&mut copy, &path.0) {
        *place = new;
    }
    copy
}

/// A copy without the key at the end of a path.
#[must_use]
pub fn removed(value: &Value, path: &Path) -> Value {
    let mut copy = value.clone();
    if let Some((Step::Key(key), parent)) = path.0.split_last()
        && let Some(Value::Object(entries)) = get_mut(&mut copy, parent)
    {
        entries.retain(|(name, _)| name != key);
    }
    copy
}

/// A copy in which the key at the end of a path comes again behind all others, with the same value.
#[must_use]
pub fn doubled(value: &Value, path: &Path) -> Value {
    let mut copy = value.clone();
    if let Some((Step::Key(key), parent)) = path.0.split_last()
        && let Some(Value::Object(entries)) = get_mut(&mut copy, parent)
        && let Some(entry) = entries.iter().find(|(name, _)| name == key)
    {
        entries.push(entry.clone());
    }
    copy
}

/// A copy in which the key at the end of a path is spelled otherwise.
#[must_use]
pub fn renamed(value: &Value, path: &Path, new: &str) -> Value {
    let mut copy = value.clone();
    if let Some((Step::Key(key), parent)) = path.0.split_last()
        && let Some(Value::Object(entries)) = get_mut(&mut copy, parent)
        && let Some((name, _)) = entries.iter_mut().find(|(name, _)| name == key)
    {
        new.clone_into(name);
    }
    copy
}

fn get_mut<'v>(value: &'v mut Value, path: &[Step]) -> Option<&'v mut Value> {
    path.iter()
        .try_fold(value, |value, step| match (value, step) {
            (Value::Object(entries), Step::Key(key)) => entries
                .iter_mut()
                .find(|(name, _)| name == key)
                .map(|(_, value)| value),
            (Value::Array(items), Step::Item(index)) => items.get_mut(*index),
            _ => None,
        })
}
