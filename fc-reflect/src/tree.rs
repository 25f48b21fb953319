//! Trees of values with their names, positions and descriptions.

use fc_spec::model::{EnumValue, EnvelopeField, Field, Quirk, Scalar, Text, Type, Variant};
use std::fmt::{self, Write as _};
use std::ops::Range;

/// A value in a body.
#[derive(Clone)]
pub struct Node<'m> {
    /// The key, or the index in a list.
    pub key: Key,
    /// The description in the spec.
    pub about: About<'m>,
    /// The type in the spec, or `None` for an unknown key.
    pub ty: Option<&'m Type>,
    /// The position in the decompressed body.
    pub span: Range<usize>,
    /// The value.
    pub value: Value<'m>,
    /// The leniencies of the reader for this value. Writing the value gives its canonical form.
    pub lenient: Vec<Leniency>,
    /// The index among the fields of the object, which is the order in writing. Unknown keys come last.
    pub(crate) slot: usize,
}

/// The step from a container to a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Key {
    /// A key as received, without escapes. It can be the wire key or another accepted key.
    Name(String),
    /// The index in a list, from 0.
    Item(usize),
}

/// The description of a value in the spec.
#[derive(Clone, Copy, Debug)]
pub enum About<'m> {
    /// A field of a struct.
    Field(&'m Field),
    /// An item. The field of its list describes it.
    Envelope(&'m EnvelopeField),
    /// An item, which the field of its list describes.
    Item,
    /// A key that the spec does not have.
    Unknown,
}

/// A value.
#[derive(Clone, Debug)]
pub enum Value<'m> {
    /// A field that is present but means absent: `null`, or another form that the spec accepts for it.
    Absent,
    /// A bool.
    Bool(bool),
    /// An integer or a timestamp.
    Int(i128),
    /// A float. An `f32` has a value that the type represents exactly.
    Float(f64),
    /// A string.
    Text(String),
    /// Bytes sent as base64.
    Bytes(Vec<u8>),
    /// Any JSON, as its exact text.
    Json(String),
    /// A value of an enum.
    Enum {
        /// The value in the message.
        wire: Scalar,
        /// The value in the spec, or `None` for an unknown value of an open enum.
        named: Option<&'m EnumValue>,
    },
    /// A list.
    List(Vec<Node<'m>>),
    /// An object, with its keys in the order of the message.
    Object(Vec<Node<'m>>),
    /// An object that is one of several variants.
    OneOf {
        /// The variant.
        variant: &'m Variant,
        /// The keys in the order of the message.
        keys: Vec<Node<'m>>,
    },
}

/// A place where a reader accepts more than a writer sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Leniency {
    /// A quirk of the field.
    Quirk(Quirk),
    /// Another accepted key instead of the wire key.
    OtherKey,
}

impl<'m> Node<'m> {
    /// Returns the wire key, regardless of the received key. It is empty for an item.
    #[must_use]
    pub fn wire(&self) -> &str {
        match (self.about, &self.key) {
            (About::Field(field), _) => &field.wire,
            (About::Envelope(field), _) => &field.wire,
            (_, Key::Name(name)) => name,
            (_, Key::Item(_)) => "",
        }
    }

    /// Returns the name in code, or `None` for an item or an unknown key.
    #[must_use]
    pub fn name(&self) -> Option<&'m str> {
        match self.about {
            About::Field(field) => Some(&field.name),
            About::Envelope(field) => Some(&field.name),
            About::Item | About::Unknown => None,
        }
    }

    /// Returns the description in both languages, or `None` for an item or an unknown key.
    #[must_use]
    pub fn text(&self) -> Option<&'m Text> {
        match self.about {
            About::Field(field) => Some(&field.text),
            About::Envelope(field) => Some(&field.text),
            About::Item | About::Unknown => None,
        }
    }

    /// Returns `true` if logs must not show the value.
    #[must_use]
    pub fn is_sensitive(&self) -> bool {
        matches!(self.about, About::Field(field) if field.sensitive)
    }

    /// Returns the keys of an object or the items of a list.
    #[must_use]
    pub fn children(&self) -> &[Node<'m>] {
        match &self.value {
            Value::List(nodes) | Value::Object(nodes) | Value::OneOf { keys: nodes, .. } => nodes,
            _ => &[],
        }
    }
}

/// Leaves out values that must not be logged.
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

/// Visits all nodes and their descendants, with a path such as `data.stations[3].x`.
pub fn walk<'a, 'm>(nodes: &'a [Node<'m>], visit: &mut dyn FnMut(&str, &'a Node<'m>)) {
    let mut path = String::new();
    walk_from(nodes, &mut path, visit);
}

/// The recursion is as deep as the text is nested, which is bounded.
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

    /// The documentation of `Limits::json_values` promises this size.
    #[test]
    fn a_node_takes_no_more_than_is_promised() {
        assert!(size_of::<Node<'_>>() <= 192, "{}", size_of::<Node<'_>>());
    }
}
