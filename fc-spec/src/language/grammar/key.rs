//! A key of the language, and how its value is read.

use super::form::Form;
use super::kind::{AnyKey, Doc, Said};
use crate::syntax::{Entry, Items, Node};
use std::marker::PhantomData;

/// A known key whose value has the form `F`.
#[derive(Debug)]
pub(crate) struct Key<F> {
    /// The name.
    pub name: &'static str,
    required: bool,
    doc: Doc,
    said: Said,
    form: PhantomData<fn() -> F>,
}

impl<F> Clone for Key<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Key<F> {}

impl<F: Form> Key<F> {
    /// Returns a key named after its field. The name of a raw identifier is the part after `r#`.
    pub(super) const fn new(field: &'static str, required: bool, doc: Doc, said: Said) -> Self {
        let name = match field.as_bytes() {
            [b'r', b'#', ..] => field.split_at(2).1,
            _ => field,
        };
        Self {
            name,
            required,
            doc,
            said,
            form: PhantomData,
        }
    }

    pub(super) const fn any(self) -> AnyKey {
        AnyKey {
            name: self.name,
            required: self.required,
            kind: F::KIND,
            doc: self.doc,
            said: self.said,
        }
    }

    /// Returns the entry of this key in the mapping.
    pub fn entry<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Entry<'a>> {
        node.into()?.entry(self.name)
    }

    /// Returns the value node of this key in the mapping.
    pub fn of<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Node<'a>> {
        node.into()?.get(self.name)
    }

    /// Returns the items of the list at this key in the mapping.
    pub fn items<'a>(self, node: impl Into<Option<Node<'a>>>) -> Items<'a> {
        self.of(node).map(Node::items).unwrap_or_default()
    }

    /// Returns the value of this key in the mapping, or the default of its type.
    pub fn get<'a>(self, node: impl Into<Option<Node<'a>>>) -> F::Value<'a>
    where
        F::Value<'a>: Default,
    {
        self.read(node).unwrap_or_default()
    }

    /// Returns the value of this key in the mapping. Without the key, reads the node itself.
    pub fn read_in_or_at(self, node: Node<'_>) -> Option<F::Value<'_>> {
        F::read(self.of(node).unwrap_or(node))
    }

    /// Returns the value of this key in the mapping.
    ///
    /// Returns `None` for a missing key and for a malformed value, which has been reported.
    pub fn read<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<F::Value<'a>> {
        F::read(self.of(node)?)
    }
}
