//! Naming rules of each language: case, reserved words and escapes.
//!
//! The emitters decide the layout of files. This module covers only the names that a spec can collide with.

mod cpp;
mod java;
mod kotlin;
mod python;
mod rust;
mod typescript;

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::OnceLock;

pub use cpp::CPP;
pub use java::JAVA;
pub use kotlin::KOTLIN;
pub use python::PYTHON;
pub use rust::RUST;
pub use typescript::TYPESCRIPT;

/// The kind of element that a name denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A struct, enum or one-of, and the protocol itself.
    Type,
    /// A field of a struct.
    Field,
    /// A value of an enum, or a variant of a one-of.
    Value,
    /// A command, report or stream, as a method of the stubs.
    Method,
    /// A group.
    Module,
    /// A table.
    Function,
}

/// The way to join the words of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// `get_station`.
    Snake,
    /// `getStation`.
    Camel,
    /// `GetStation`.
    Pascal,
    /// `GET_STATION`.
    Screaming,
}

impl Case {
    /// Converts a spec name, `snake_case` or `PascalCase`, to this case. Pascal keeps a `PascalCase` name.
    #[must_use]
    pub fn apply(self, name: &str) -> Cow<'_, str> {
        match self {
            Self::Snake => Cow::Borrowed(name),
            Self::Pascal if is_pascal(name) => Cow::Borrowed(name),
            Self::Screaming => Cow::Owned(name.to_ascii_uppercase()),
            Self::Pascal => Cow::Owned(joined(name, true)),
            Self::Camel => Cow::Owned(joined(name, false)),
        }
    }
}

fn is_pascal(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_uppercase()) && !name.contains('_')
}

/// Joins the words of a name. Each word starts with a capital; the first only if `first` is set.
fn joined(name: &str, first: bool) -> String {
    let mut out = String::with_capacity(name.len());
    for (index, word) in name.split('_').enumerate() {
        let mut characters = word.chars();
        match characters.next() {
            Some(initial) if first || index > 0 => out.push(initial.to_ascii_uppercase()),
            Some(initial) => out.push(initial),
            None => {}
        }
        out.push_str(characters.as_str());
    }
    out
}

/// A set of reserved words.
#[derive(Debug)]
struct Words {
    /// The words, separated by white space.
    text: &'static str,
    set: OnceLock<HashSet<&'static str>>,
}

impl Words {
    const fn new(text: &'static str) -> Self {
        Self {
            text,
            set: OnceLock::new(),
        }
    }

    fn contains(&self, word: &str) -> bool {
        let set = || self.text.split_ascii_whitespace().collect();
        self.set.get_or_init(set).contains(word)
    }
}

/// A target language, with its rules for names.
#[derive(Debug)]
pub struct Language {
    /// The name in `fc.yaml`.
    pub name: &'static str,
    /// The display name.
    pub title: &'static str,
    /// The case of each role.
    case: fn(Role) -> Case,
    /// Words that cannot be names.
    keywords: Words,
    /// Types that every program has, and those of the package. They have no escaped form.
    types: Words,
    /// Members that every object has in addition to its fields. A field with such a name gets a `_`.
    fields: Words,
    /// Methods that every stub has. A method with such a name gets a `_`.
    methods: Words,
    /// Escapes a keyword for a role; `None` if no escaped form exists.
    escape: fn(Role, &str) -> Option<String>,
    /// Suffixes of the types that each group has, in words.
    pub group_types: &'static [&'static str],
    /// `true` if each type has a file with its name.
    pub has_file_per_type: bool,
    /// `true` if the ids of each entity have a type.
    pub has_id_types: bool,
    /// The same language with a type for the ids of each entity.
    with_ids: Option<&'static Self>,
    /// `true` if several required fields of a struct get a type whose name ends in `Fields`.
    pub has_field_types: bool,
}

impl Language {
    /// All languages.
    pub const ALL: [&'static Self; 6] = [&RUST, &TYPESCRIPT, &KOTLIN, &JAVA, &CPP, &PYTHON];

    /// Returns the language with this name in `fc.yaml`.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::ALL.into_iter().find(|language| language.name == name)
    }

    /// Returns the language with a type for the ids of each entity, if it has such types.
    #[must_use]
    pub fn with_ids(&'static self) -> &'static Self {
        self.with_ids.unwrap_or(self)
    }

    /// Returns a name of the spec in this language. It is unescaped if no escaped form exists.
    #[must_use]
    pub fn spelled<'n>(&self, role: Role, name: &'n str) -> Cow<'n, str> {
        let (Ok(name) | Err(name)) = self.spelling(role, name);
        name
    }

    /// Returns a name of the spec in this language. Reserved words are escaped.
    ///
    /// # Errors
    ///
    /// Returns the unescaped name if no escaped form exists.
    pub fn spelling<'n>(&self, role: Role, name: &'n str) -> Result<Cow<'n, str>, Cow<'n, str>> {
        let cased = (self.case)(role).apply(name);
        if role == Role::Type && self.types.contains(&cased) {
            return Err(cased);
        }
        if self.keywords.contains(&cased) {
            return (self.escape)(role, &cased).map(Cow::Owned).ok_or(cased);
        }
        let is_taken = match role {
            Role::Field => self.fields.contains(&cased),
            Role::Method => self.methods.contains(&cased),
            Role::Type | Role::Value | Role::Module | Role::Function => false,
        };
        Ok(if is_taken { cased + "_" } else { cased })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_word_is_listed_once() {
        for language in Language::ALL {
            let Language {
                keywords,
                types,
                fields,
                methods,
                ..
            } = language;
            for words in [keywords, types, fields, methods] {
                let mut seen = HashSet::new();
                let again = words
                    .text
                    .split_ascii_whitespace()
                    .find(|word| !seen.insert(*word));
                assert_eq!(again, None, "{}", language.name);
            }
        }
    }

    #[test]
    fn words_are_joined() {
        for (case, expected) in [
            (Case::Snake, "at_undock_1"),
            (Case::Camel, "atUndock1"),
            (Case::Pascal, "AtUndock1"),
            (Case::Screaming, "AT_UNDOCK_1"),
        ] {
            assert_eq!(case.apply("at_undock_1"), expected);
        }
        assert_eq!(Case::Pascal.apply("GetStation"), "GetStation");
    }
}
