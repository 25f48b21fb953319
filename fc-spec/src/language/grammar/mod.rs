//! The grammar of the spec language: one declaration per key, with its type and its documentation in both languages.
//!
//! The shape checks ([`shape`](crate::load)), the reader ([`Key::read`]), the JSON Schema and the reference ([`crate::language`]) all use
//! these declarations. An editor, a page and the generator therefore cannot disagree.
//!
//! Checks on the lowered draft cover the rest, such as names that must exist and codes that must differ.

/// Declares mappings with known keys. The first line of each comment is English, the second Chinese. `use` adds keys that are declared
/// elsewhere.
///
/// Each mapping defines a constant with one field per key, which the loader uses to read the key. It also defines the [`Table`] of its
/// keys, in the recommended order.
///
/// A key can have three more parts after its form:
/// - `default`: the value that the loader uses for a missing key.
/// - `example`: a value as YAML. A kind whose values are all equally good examples needs none.
/// - `faults`: the errors that its kind does not imply.
macro_rules! grammar {
    (@must required) => { true };
    (@must optional) => { false };
    (@maybe) => { None };
    (@maybe $said:expr) => { Some($said) };
    ($(
        #[doc = $en:literal] #[doc = $zh:literal]
        $KEYS:tt: $Keys:ident = $name:literal $name_zh:literal {
            $(use $($first:expr),+;)?
            $(
                #[doc = $key_en:literal] #[doc = $key_zh:literal]
                $must:ident $key:ident: $Form:ty
                    $(, default $default:expr)? $(, example $example:literal)? $(, faults [$($fault:ident),+])?;
                $(use $($next:expr),+;)?
            )*
        }
    )+) => { $(
        #[doc = $en]
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        #[allow(clippy::struct_field_names, reason = "they are the keys of the language")]
        #[derive(Debug)]
        pub(crate) struct $Keys {
            $(#[doc = $key_en] pub $key: $crate::language::grammar::key::Key<$Form>,)*
        }

        #[doc = $en]
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        pub(crate) const $KEYS: $Keys = $Keys {
            $($key: $crate::language::grammar::key::Key::new(
                stringify!($key),
                grammar!(@must $must),
                $crate::language::grammar::kind::Doc::new($key_en, $key_zh),
                $crate::language::grammar::kind::Said {
                    default: grammar!(@maybe $($default)?),
                    example: grammar!(@maybe $($example)?),
                    faults: &[$($($crate::diagnostic::FaultCode::$fault),+)?],
                },
            ),)*
        };

        impl $Keys {
            /// The name in prose and in the schema.
            pub const NAME: &'static str = $name;
            /// The table of its keys.
            pub const TABLE: &'static $crate::language::grammar::kind::Table = &$crate::language::grammar::kind::Table {
                name: Self::NAME,
                name_zh: $name_zh,
                doc: $crate::language::grammar::kind::Doc::new($en, $zh),
                example: include_str!(concat!("examples/", stringify!($Keys), ".yaml")),
                keys: &[$($($first.any(),)+)? $($KEYS.$key.any(), $($($next.any(),)+)?)*],
            };
        }

        impl $crate::language::grammar::form::Form for $Keys {
            const KIND: $crate::language::grammar::kind::Kind = $crate::language::grammar::kind::Kind::Map(Self::TABLE);
            type Value<'a> = $crate::syntax::Node<'a>;

            fn read(node: $crate::syntax::Node<'_>) -> Option<Self::Value<'_>> {
                Some(node)
            }
        }
    )+ };
}

/// Declares forms of values: the kind that the grammar requires, the Rust type of the value, and its reader. The type
/// may have the lifetime `'a` of the node.
macro_rules! forms {
    ($($(#[$doc:meta])* $Form:ident: $kind:expr => $Value:ty, $read:expr;)+) => { $(
        $(#[$doc])*
        #[derive(Debug)]
        pub(crate) enum $Form {}

        impl $crate::language::grammar::form::Form for $Form {
            const KIND: $crate::language::grammar::kind::Kind = $kind;
            type Value<'a> = $Value;

            fn read(node: $crate::syntax::Node<'_>) -> Option<Self::Value<'_>> {
                $read(node)
            }
        }
    )+ };
}

mod available;
mod common;
mod coordinates;
mod entity;
mod field;
mod file;
mod form;
mod glossary;
mod key;
mod kind;
mod operation;
mod project;
mod refers;
pub(crate) mod unit;
mod waiver;
mod wire;

pub(crate) use available::*;
pub(crate) use common::*;
pub(crate) use coordinates::*;
pub(crate) use entity::*;
pub(crate) use field::*;
pub(crate) use file::*;
pub(crate) use form::{Form, List, TestedKind};
pub(crate) use glossary::*;
pub(crate) use key::Key;
pub(crate) use kind::{AnyKey, Doc, Kind, Table};
pub(crate) use operation::*;
pub(crate) use project::*;
pub(crate) use refers::*;
pub(crate) use waiver::*;
pub(crate) use wire::*;
