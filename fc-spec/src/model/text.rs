//! Texts in two languages, and the notes that any part of the spec can have.

use super::{Confirmation, Governed, HeaderType, Type, Value};
use crate::names;
use crate::vocabulary::AnswerKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A language of texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Lang {
    /// Chinese.
    Zh,
    /// English.
    En,
}

impl Lang {
    /// Both languages.
    pub const ALL: [Self; 2] = [Self::Zh, Self::En];

    /// Returns the first value for Chinese and the second for English.
    pub fn pick<T>(self, zh: T, en: T) -> T {
        match self {
            Self::Zh => zh,
            Self::En => en,
        }
    }

    /// Returns the text in this language.
    #[must_use]
    pub fn text(self, text: &Text) -> &str {
        self.pick(&text.zh, &text.en)
    }

    /// Returns the aliases in this language.
    #[must_use]
    pub fn aliases(self, aliases: &Aliases) -> Vec<String> {
        self.pick(&aliases.zh, &aliases.en).clone()
    }
}

/// The languages that each text of a spec requires. A missing text is a copy of the text in the other language.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Languages {
    /// Both languages.
    #[default]
    All,
    /// Only this language.
    Only(Lang),
    /// Either language is enough. For a spec with unknown settings, such as an old version in git.
    Any,
}

impl Languages {
    /// Returns `true` if a text needs this language, with or without the other one.
    #[must_use]
    pub fn require(self, lang: Lang, has_other: bool) -> bool {
        match self {
            Self::All => true,
            Self::Only(only) => lang == only,
            Self::Any => !has_other,
        }
    }

    /// Limits a text of the generator to the languages of a spec.
    #[must_use]
    pub fn limit(self, text: Text) -> Text {
        match self {
            Self::Only(lang) => {
                let text = lang.text(&text);
                Text {
                    zh: text.to_owned(),
                    en: text.to_owned(),
                }
            }
            Self::All | Self::Any => text,
        }
    }

    /// Returns `true` if new texts are written in this language.
    #[must_use]
    pub fn include(self, lang: Lang) -> bool {
        self.require(lang, false)
    }
}

/// A sentence in both languages. [`text!`](crate::text) writes one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Text {
    /// Chinese.
    #[serde(deserialize_with = "names::read_text")]
    pub zh: String,
    /// English.
    #[serde(deserialize_with = "names::read_text")]
    pub en: String,
}

/// Builds a [`Text`] from two formats, the Chinese one first: `text!("没有 `{name}`", "there is no `{name}`")`.
///
/// An argument that is a [`Text`] is inserted in the matching language: `text!("应为{kind}", "expected {kind}", kind = describe(kind))`.
#[macro_export]
macro_rules! text {
    ($zh:literal, $en:literal $(,)?) => {
        $crate::model::Text {
            zh: ::std::fmt::format(::std::format_args!($zh)),
            en: ::std::fmt::format(::std::format_args!($en)),
        }
    };
    ($zh:literal, $en:literal, $($name:ident = $part:expr),+ $(,)?) => {
        match ($(&$part,)+) {
            ($($name,)+) => $crate::model::Text {
                zh: {
                    $(let $name = $crate::model::Part::part($name, $crate::model::Lang::Zh);)+
                    $(let _ = &$name;)+
                    ::std::fmt::format(::std::format_args!($zh))
                },
                en: {
                    $(let $name = $crate::model::Part::part($name, $crate::model::Lang::En);)+
                    $(let _ = &$name;)+
                    ::std::fmt::format(::std::format_args!($en))
                },
            },
        }
    };
}

/// Implements `Display` and `Error` for an error whose method `text` returns a [`Text`]. It shows the English sentence.
#[macro_export]
macro_rules! text_error {
    ($Error:ty) => {
        impl ::std::fmt::Display for $Error {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.write_str(&self.text().en)
            }
        }

        impl ::std::error::Error for $Error {}
    };
}

impl Text {
    /// Joins several texts with a separator for each language.
    #[must_use]
    pub fn joined(parts: impl IntoIterator<Item = Self>, zh: &str, en: &str) -> Self {
        let (in_zh, in_en): (Vec<_>, Vec<_>) =
            parts.into_iter().map(|part| (part.zh, part.en)).unzip();
        Self {
            zh: in_zh.join(zh),
            en: in_en.join(en),
        }
    }

    /// Returns a list of words that are the same in both languages.
    #[must_use]
    pub fn listed(words: impl IntoIterator<Item = impl std::fmt::Display>) -> Self {
        let words = words.into_iter();
        Self::joined(words.map(|word| text!("{word}", "{word}")), "、", ", ")
    }

    /// Returns the text with a missing language copied from the other one.
    #[must_use]
    pub fn completed(mut self) -> Self {
        if self.zh.is_empty() {
            self.zh.clone_from(&self.en);
        } else if self.en.is_empty() {
            self.en.clone_from(&self.zh);
        }
        self
    }

    /// Returns the text for use after Chinese characters. A Chinese text that begins with an ASCII character gets a space in front.
    #[must_use]
    pub fn spaced(mut self) -> Self {
        if self.zh.starts_with(|first: char| first.is_ascii()) {
            self.zh.insert(0, ' ');
        }
        self
    }

    /// Returns `true` if both texts are empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.zh.is_empty() && self.en.is_empty()
    }
}

/// A value that [`text!`](crate::text) can insert into a text.
pub trait Part {
    /// Returns the form of the value in a text of this language.
    fn part(&self, lang: Lang) -> impl std::fmt::Display + '_;
}

impl Part for Text {
    fn part(&self, lang: Lang) -> impl std::fmt::Display + '_ {
        lang.text(self)
    }
}

impl<T: Part + ?Sized> Part for &T {
    fn part(&self, lang: Lang) -> impl std::fmt::Display + '_ {
        (**self).part(lang)
    }
}

/// Implements [`Part`] for types with the same form in both languages, such as names and numbers.
macro_rules! same_in_both {
    ($($Type:ty),+) => {
        $(impl Part for $Type {
            fn part(&self, _: Lang) -> impl std::fmt::Display + '_ {
                self
            }
        })+
    };
}

same_in_both!(
    str, String, i64, i128, u8, u16, u32, u64, usize, Type, HeaderType, Value
);

/// Other words for a thing: `{ zh: […], en: […] }`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Aliases {
    /// Chinese.
    #[serde(deserialize_with = "names::read_text")]
    pub zh: Vec<String>,
    /// English.
    #[serde(deserialize_with = "names::read_text")]
    pub en: Vec<String>,
}

/// A place in the spec, for links from generated text back to its source.
///
/// Committed text names it by file and name alone: a line number would change with every line above it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Location {
    /// Path from the project's root with `/` between its parts, such as `spec/commands/station.yaml`.
    #[serde(deserialize_with = "names::read_place")]
    pub file: String,
    /// Name in the file: the keys that lead to the entry, such as `commands.get_station` or `frame`.
    /// An answer with ids has its first id as name.
    /// Later answers of the file with the same id have a number: `C040.2`.
    #[serde(deserialize_with = "names::read_place")]
    pub name: String,
    /// Line, counted from 1.
    pub line: usize,
}

/// A dated change: `{ date: 2024-01, zh: …, en: … }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Change {
    /// `YYYY-MM` or `YYYY-MM-DD`.
    #[serde(deserialize_with = "names::read_date")]
    pub date: String,
    /// Description of the change.
    #[serde(flatten)]
    pub text: Text,
}

/// `deprecated: { since, sunset, note: { zh, en }, replaced_by }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Deprecation {
    /// `YYYY-MM` or `YYYY-MM-DD`, where the source gives it.
    #[serde(default, deserialize_with = "names::read_date")]
    pub since: Option<String>,
    /// Last day or month in which it works, `YYYY-MM-DD` or `YYYY-MM`; `null` if not stated.
    #[serde(default, deserialize_with = "names::read_date")]
    pub sunset: Option<String>,
    /// Reason and replacement.
    #[serde(flatten)]
    pub note: Text,
    /// Name of the operation to use instead.
    pub replaced_by: Option<String>,
}

/// The subject of an answer.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The protocol as a whole.
    Protocol,
    /// Ports and host.
    Transport,
    /// The frame, or one header field.
    Frame(Option<String>),
    /// The envelope, or one of its keys.
    Envelope(Option<String>),
    /// The result codes, or one of them.
    Results(Option<i64>),
    /// A code range or the code map.
    Codes,
    /// An operation, by name.
    Operation(String),
    /// A field: `owner` is the name of the type that holds it, `key` its wire key.
    Field {
        /// Name of the struct type.
        owner: String,
        /// Wire key in it.
        key: String,
    },
    /// A named type.
    Type(String),
    /// A table, by id.
    Table(String),
    /// A section that is missing from the source.
    Section(u16),
}

/// One entry of an `answers:` list.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// Ids of the conflicts it answers, such as `C040`. Empty if the source has lost its subject.
    #[serde(deserialize_with = "names::read_conflict_id")]
    pub ids: Vec<String>,
    /// Decision, quirk, note or question.
    pub kind: AnswerKind,
    /// The answer or the question.
    #[serde(flatten)]
    pub text: Text,
    /// The facts it governs.
    pub about: Vec<Governed>,
    /// `true` if it describes the runtime. No value of the spec changes this behaviour.
    pub runtime: bool,
    /// The owner's confirmation, which settles it; `null` while there is none.
    pub confirmed: Option<Confirmation>,
    /// Its subject.
    pub subject: Subject,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}
