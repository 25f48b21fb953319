//! What has been read: values with their names, places and descriptions.

use fc_spec::model::{EnumValue, EnvelopeField, Field, Quirk, Scalar, Text, Type, Variant};
use std::fmt::{self, Write as _};
use std::ops::Range;

/// A value in a body.
#[derive(Clone)]
pub struct Node<'m> {
    /// Its key or its place in a list.
    pub key: Key,
    /// Where the spec describes it.
    pub about: About<'m>,
    /// Its type in the spec; `None` of an unknown key.
    pub ty: Option<&'m Type>,
    /// Its bytes in the decompressed body.
    pub span: Range<usize>,
    /// Its value.
    pub value: Value<'m>,
    /// Where the reader has been lenient to get it. Written again, it has the canonical form.
    pub lenient: Vec<Leniency>,
    /// Its place among the fields of its object, which is the order in which they are written; those that the spec does
    /// not know come behind.
    pub(crate) slot: usize,
}

/// What leads to a value from what holds it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Key {
    /// A key as received, without escapes: the wire key, or another that is taken for it.
    Name(String),
    /// The place in a list, from 0.
    Item(usize),
}

/// Where the spec describes a value.
#[derive(Clone, Copy, Debug)]
pub enum About<'m> {
    /// A field of a struct.
    Field(&'m Field),
    /// A key of the envelope.
    Envelope(&'m EnvelopeField),
    /// An item, which the field of its list describes.
    Item,
    /// Nowhere: the spec does not know the key.
    Unknown,
}

/// A value.
#[derive(Clone, Debug)]
pub enum Value<'m> {
    /// An optional field that is there and says nothing: `null`, or what the spec takes for it.
    Absent,
    /// A bool.
    Bool(bool),
    /// An integer or a timestamp.
    Int(i128),
    /// A float; of an `f32` one that it holds exactly.
    Float(f64),
    /// A string.
    Text(String),
    /// Bytes sent as base64.
    Bytes(Vec<u8>),
    /// Any JSON, as its exact text.
    Json(String),
    /// A value of an enum.
    Enum {
        /// What travels.
        wire: Scalar,
        /// What the spec says of it; `None` of a value that an open enum does not have.
        named: Option<&'m EnumValue>,
    },
    /// A list.
    List(Vec<Node<'m>>),
    /// An object: its keys in the order in which they came.
    Object(Vec<Node<'m>>),
    /// An object that is one of several.
    OneOf {
        /// Which.
        variant: &'m Variant,
        /// Its keys in the order in which they came.
        keys: Vec<Node<'m>>,
    },
}

/// A place where a reader is more lenient than a writer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Leniency {
    /// A quirk of the field.
    Quirk(Quirk),
    /// Another key was taken for the field's.
    OtherKey,
}

impl<'m> Node<'m> {
    /// The key that is sent for it, whichever was received; empty of an item.
    #[must_use]
    pub fn wire(&self) -> &str {
        match (self.about, &self.key) {
            (About::Field(field), _) => &field.wire,
            (About::Envelope(field), _) => &field.wire,
            (_, Key::Name(name)) => name,
            (_, Key::Item(_)) => "",
        }
    }

    /// Its name in code; `None` of items and unknown keys.
    #[must_use]
    pub fn name(&self) -> Option<&'m str> {
        match self.about {
            About::Field(field) => Some(&field.name),
            About::Envelope(field) => Some(&field.name),
            About::Item | About::Unknown => None,
        }
    }

    /// What the spec says of it in both languages; `None` of items and unknown keys.
    #[must_use]
    pub fn text(&self) -> Option<&'m Text> {
        match self.about {
            About::Field(field) => Some(&field.text),
            About::Envelope(field) => Some(&field.text),
            About::Item | About::Unknown => None,
        }
    }

    /// Whether its value must not be shown in logs.
    #[must_use]
    pub fn is_sensitive(&self) -> bool {
        matches!(self.about, About::Field(field) if field.sensitive)
    }

    /// What it holds: keys of an object, items of a list.
    #[must_use]
    pub fn children(&self) -> &[Node<'m>] {
        match &self.value {
            Value::List(nodes) | Value::Object(nodes) | Value::OneOf { keys: nodes, .. } => nodes,
            _ => &[],
        }
    }
}

/// Does not show what must not be logged.
impl fmt::Debug for Node<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Node");
        shown.field("key", &self.key).field("name", &self.name());
        shown.field("span", &self.span);
        if self.is_sensitive() {
            shown.field("value", &format_args!("…"));
        } else {
            shown.field("value", &self.value);
        }
        shown
            .field("lenient", &self.lenient)
            .finish_non_exhaustive()
    }
}

/// Shows each of `nodes` and all that they hold, with its path in front, such as `data.stations[3].x`.
pub fn walk<'a, 'm>(nodes: &'a [Node<'m>], visit: &mut dyn FnMut(&str, &'a Node<'m>)) {
    let mut path = String::new();
    walk_from(nodes, &mut path, visit);
}

/// As deep as the text is nested, which is bounded.
fn walk_from<'a, 'm>(
    nodes: &'a [Node<'m>],
    path: &mut String,
    visit: &mut dyn FnMut(&str, &'a Node<'m>),
) {
    let before = path.len();
    for node in nodes {
        match &node.key {
            Key::Name(name) => {
                if before > 0 {
                    path.push('.');
                }
                path.push_str(name);
            }
            Key::Item(index) => {
                // Writing to a String cannot fail.
                let _ = write!(path, "[{index}]");
            }
        }
        visit(path, node);
        walk_from(node.children(), path, visit);
        path.truncate(before);
    }
}

#[cfg(test)]
mod tests {
    use super::Node;

    /// What `Limits::json_values` promises.
    #[test]
    fn a_node_takes_no_more_than_is_promised() {
        assert!(size_of::<Node<'_>>() <= 192, "{}", size_of::<Node<'_>>());
    }
}
