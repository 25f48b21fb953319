//! String forms of model types that are one word in the spec and in the dump.

use super::schema::fixed_schema;
use super::{EnumRepr, HeaderType, Subject, Type, TypeRef};
use crate::vocabulary::{FloatKind, IntKind, Word as _};
use std::fmt;
use std::str::FromStr;

/// A string that is not a valid form of the expected type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unreadable {
    text: String,
    wanted: &'static str,
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is no {}", self.text, self.wanted)
    }
}

impl std::error::Error for Unreadable {}

/// Serializes a type as its string form.
macro_rules! as_text {
    ($Type:ty, $wanted:literal) => {
        impl serde::Serialize for $Type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> serde::Deserialize<'de> for $Type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
                text.parse().map_err(serde::de::Error::custom)
            }
        }

        fixed_schema!($Type, { "type": "string" });

        impl FromStr for $Type {
            type Err = Unreadable;

            fn from_str(text: &str) -> Result<Self, Unreadable> {
                Self::read(text).ok_or_else(|| Unreadable {
                    text: text.to_owned(),
                    wanted: $wanted,
                })
            }
        }
    };
}

as_text!(HeaderType, "type of a header field");
as_text!(Type, "type");
as_text!(EnumRepr, "type of enum values");
as_text!(Subject, "subject of an answer");

/// Writes the form of the spec: `u16`, `bytes(16)`.
impl fmt::Display for HeaderType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::U8 => f.write_str("u8"),
            Self::U16 => f.write_str("u16"),
            Self::U32 => f.write_str("u32"),
            Self::U64 => f.write_str("u64"),
            Self::Bytes(length) => write!(f, "bytes({length})"),
        }
    }
}

impl HeaderType {
    fn read(text: &str) -> Option<Self> {
        Some(match text {
            "u8" => Self::U8,
            "u16" => Self::U16,
            "u32" => Self::U32,
            "u64" => Self::U64,
            _ => {
                let length = text.strip_prefix("bytes(")?.strip_suffix(')')?;
                Self::Bytes(length.parse().ok()?)
            }
        })
    }
}

/// The built-in types without parameters, and their names.
const PLAIN: [(&str, Type); 6] = [
    ("bool", Type::Bool),
    ("string", Type::String),
    ("timestamp_ms", Type::TimestampMs),
    ("timestamp_s", Type::TimestampS),
    ("base64", Type::Base64),
    ("json", Type::Json),
];

/// Writes the form of the spec: `u8`, `[Station]`.
impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Int(kind) => f.write_str(kind.name()),
            Self::Float(kind) => f.write_str(kind.name()),
            Self::Array(item) => write!(f, "[{item}]"),
            Self::Named(named) => f.write_str(named.name()),
            plain => {
                let row = PLAIN.iter().find(|(_, ty)| ty == plain);
                f.write_str(row.map_or("", |(name, _)| name))
            }
        }
    }
}

impl Type {
    fn read(text: &str) -> Option<Self> {
        if let Some(item) = text.strip_prefix('[') {
            let item = Self::read(item.strip_suffix(']')?.trim())?;
            return Some(Self::Array(Box::new(item)));
        }
        if let Some((_, ty)) = PLAIN.iter().find(|(name, _)| *name == text) {
            return Some(ty.clone());
        }
        let number = IntKind::named(text).map(Self::Int);
        let number = number.or_else(|| FloatKind::named(text).map(Self::Float));
        number.or_else(|| is_type_word(text).then(|| Self::Named(TypeRef::named(text))))
    }

    /// Returns the names of the built-in types.
    pub(crate) fn built_in<'a>() -> impl Iterator<Item = &'a str> {
        let ints = IntKind::ALL.iter().map(|kind| kind.name());
        let floats = FloatKind::ALL.iter().map(|kind| kind.name());
        let [(first, _), rest @ ..] = &PLAIN;
        let rest = rest.iter().map(|(name, _)| *name);
        std::iter::once(*first)
            .chain(ints)
            .chain(floats)
            .chain(rest)
    }
}

/// Returns `true` if the word can be the name of a type.
///
/// This includes misspelt built-in types such as `int32`. The loader then reports an unknown type with similar names instead of a syntax
/// error.
fn is_type_word(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

impl EnumRepr {
    /// Returns the form of the spec: `u8`, `string`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Int(kind) => kind.name(),
            Self::String => "string",
        }
    }

    fn read(text: &str) -> Option<Self> {
        match text {
            "string" => Some(Self::String),
            _ => IntKind::named(text).map(Self::Int),
        }
    }
}

impl fmt::Display for EnumRepr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Writes a path such as `operation.get_station`, `field.Station.id` or `frame`.
impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Protocol => f.write_str("protocol"),
            Self::Transport => f.write_str("transport"),
            Self::Frame(None) => f.write_str("frame"),
            Self::Frame(Some(field)) => write!(f, "frame.{field}"),
            Self::Envelope(None) => f.write_str("envelope"),
            Self::Envelope(Some(key)) => write!(f, "envelope.{key}"),
            Self::Results(None) => f.write_str("results"),
            Self::Results(Some(code)) => write!(f, "results.{code}"),
            Self::Codes => f.write_str("codes"),
            Self::Operation(name) => write!(f, "operation.{name}"),
            Self::Field { owner, key } => write!(f, "field.{owner}.{key}"),
            Self::Type(name) => write!(f, "type.{name}"),
            Self::Table(id) => write!(f, "table.{id}"),
            Self::Section(number) => write!(f, "section.{number}"),
        }
    }
}

impl Subject {
    fn read(text: &str) -> Option<Self> {
        let Some((whole, part)) = text.split_once('.') else {
            return Some(match text {
                "protocol" => Self::Protocol,
                "transport" => Self::Transport,
                "frame" => Self::Frame(None),
                "envelope" => Self::Envelope(None),
                "results" => Self::Results(None),
                "codes" => Self::Codes,
                _ => return None,
            });
        };
        let owned = || part.to_owned();
        Some(match whole {
            "frame" => Self::Frame(Some(owned())),
            "envelope" => Self::Envelope(Some(owned())),
            "results" => Self::Results(Some(part.parse().ok()?)),
            "operation" => Self::Operation(owned()),
            "field" => {
                let (holder, key) = part.split_once('.')?;
                Self::Field {
                    owner: holder.to_owned(),
                    key: key.to_owned(),
                }
            }
            "type" => Self::Type(owned()),
            "table" => Self::Table(owned()),
            "section" => Self::Section(part.parse().ok()?),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_survive_writing_and_reading() {
        let array = |item| Type::Array(Box::new(item));
        for (text, expected) in [
            ("u8", Some(Type::Int(IntKind::U8))),
            ("timestamp_s", Some(Type::TimestampS)),
            (
                "[Station]",
                Some(array(Type::Named(TypeRef::named("Station")))),
            ),
            ("[[f32]]", Some(array(array(Type::Float(FloatKind::F32))))),
            ("int32", Some(Type::Named(TypeRef::named("int32")))),
            ("[u8", None),
            ("u8?", None),
            ("a b", None),
            ("", None),
        ] {
            assert_eq!(text.parse().ok(), expected, "{text}");
            if let Some(ty) = expected {
                assert_eq!(ty.to_string(), text);
            }
        }
    }

    #[test]
    fn widths_survive_writing_and_reading() {
        for (text, expected) in [
            ("u8", Some(HeaderType::U8)),
            ("bytes(16)", Some(HeaderType::Bytes(16))),
            ("bytes()", None),
            ("i8", None),
        ] {
            assert_eq!(text.parse().ok(), expected, "{text}");
            if let Some(ty) = expected {
                assert_eq!(ty.to_string(), text);
            }
        }
    }

    #[test]
    fn subjects_survive_writing_and_reading() {
        for text in [
            "protocol",
            "frame",
            "frame.GZipDataLength",
            "envelope.cmdTime",
            "results.2002",
            "operation.get_station",
            "field.Station.a.b",
            "section.60",
        ] {
            let subject = text.parse::<Subject>().ok();
            assert_eq!(
                subject.map(|subject| subject.to_string()).as_deref(),
                Some(text)
            );
        }
        assert!("frames".parse::<Subject>().is_err());
        assert!("section.x".parse::<Subject>().is_err());
    }
}
