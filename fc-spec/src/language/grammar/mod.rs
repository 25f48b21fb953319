//! The spec language, declared: each key once, with its type and one sentence about it in both languages.
//!
//! Shape faults ([`shape`](crate::load)), reading ([`Key::read`]), the JSON Schema and the reference of the language
//! ([`crate::language`]) all come out of these declarations, so that an editor, a page and the generator cannot
//! disagree. What a declaration cannot say (names that must exist, codes that must differ) is checked on the
//! lowered draft.

/// Declares mappings with known keys. The first line of each comment is English, the second Chinese; `use` puts
/// keys here that are declared elsewhere. Each makes a constant by whose fields the keys are read, and the
/// [`Table`] of them all, in the order in which they are best written.
///
/// Behind the form of a key may stand what the loader takes it for where it is not there (`default`), an example in YAML,
/// which a kind of which any value is as good has of itself, and the faults that more than its kind can raise.
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
            /// Its name in prose and in the schema.
            pub const NAME: &'static str = $name;
            /// All of its keys.
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
pub(crate) use form::Form;
pub(crate) use glossary::*;
pub(crate) use key::Key;
pub(crate) use kind::{AnyKey, Doc, Kind, Table};
pub(crate) use operation::*;
pub(crate) use refers::*;
pub(crate) use waiver::*;
pub(crate) use wire::*;
