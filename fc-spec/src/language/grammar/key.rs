//! A key of the language, and how what stands under it is read.

use super::form::Form;
use super::kind::{AnyKey, Doc, Said};
use crate::syntax::{Entry, Items, Node};
use std::marker::PhantomData;

/// A known key under which an `F` stands.
#[derive(Debug)]
pub(crate) struct Key<F> {
    /// The key.
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
    /// A key by the name of its field, which for a word of Rust is a raw one.
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

    /// The key and what stands under it in this mapping.
    pub fn entry<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Entry<'a>> {
        node.into()?.entry(self.name)
    }

    /// What stands under it in this mapping.
    pub fn of<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<Node<'a>> {
        node.into()?.get(self.name)
    }

    /// Items of the list under it in this mapping.
    pub fn items<'a>(self, node: impl Into<Option<Node<'a>>>) -> Items<'a> {
        self.of(node).map(Node::items).unwrap_or_default()
    }

    /// What it says in this mapping; nothing where that is `None`.
    pub fn get<'a>(self, node: impl Into<Option<Node<'a>>>) -> F::Value<'a>
    where
        F::Value<'a>: Default,
    {
        self.read(node).unwrap_or_default()
    }

    /// What it says in this mapping, or what stands here in place of one.
    pub fn read_in_or_at(self, node: Node<'_>) -> Option<F::Value<'_>> {
        F::read(self.of(node).unwrap_or(node))
    }

    /// What it says in this mapping; `None` where it is not there, or malformed, which has been reported.
    pub fn read<'a>(self, node: impl Into<Option<Node<'a>>>) -> Option<F::Value<'a>> {
        F::read(self.of(node)?)
    }
}
