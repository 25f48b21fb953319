//! Builds the reference of the language from the grammar tables, in both languages.

use super::{example, faults};
use crate::diagnostic::FaultCode;
use crate::language::grammar::unit::UNITS;
use crate::language::grammar::{AnyKey, Doc, FIELD_KIND, File, Kind, Table};
use crate::model::Text;
use crate::vocabulary::{FloatKind, IntKind, Meaning};

/// A part of the language: a mapping with its keys, or a set of words.
#[derive(Clone, Debug)]
pub struct Part {
    /// The unique name in errors and in the schema, such as "header field".
    pub id: &'static str,
    /// The display name.
    pub name: Text,
    /// The description.
    pub text: Text,
    /// A small example, as YAML. `None` for a set of words.
    pub example: Option<&'static str>,
    /// The errors of a mapping as a whole.
    pub faults: Vec<FaultCode>,
    /// The keys, in the recommended order.
    pub keys: Vec<Key>,
    /// The words.
    pub words: Vec<Word>,
}

/// A key of a mapping.
#[derive(Clone, Debug)]
pub struct Key {
    /// The name.
    pub name: &'static str,
    /// `true` if the mapping must have the key.
    pub required: bool,
    /// The documentation.
    pub text: Text,
    /// The forms of the value. The value has one of them.
    pub takes: Vec<Takes>,
    /// The value that the loader uses for a missing key.
    pub default: Option<&'static str>,
    /// An example of the value, as YAML. `None` if the value is a mapping of another part, because that part has an example.
    pub example: Option<String>,
    /// The errors of the value.
    pub faults: Vec<FaultCode>,
}

/// A form of a value.
#[derive(Clone, Debug)]
pub struct Takes {
    /// The description. Empty if the parts or words describe the form.
    pub text: Text,
    /// The names of the parts that describe its content.
    pub parts: Vec<&'static str>,
    /// The words. The value is one of them.
    pub words: Vec<Word>,
}

/// A word and its meaning.
#[derive(Clone, Debug)]
pub struct Word {
    /// The word.
    pub word: &'static str,
    /// The meaning.
    pub text: Text,
}

/// Returns the reference of the whole language, beginning with a file of the spec.
#[must_use]
pub fn reference() -> Vec<Part> {
    let parts = tables().into_iter().map(|table| Part {
        id: table.name,
        name: both(Doc::new(table.name, table.name_zh)),
        text: both(table.doc),
        example: Some(table.example),
        faults: faults::of_table(table),
        keys: table.keys.iter().map(|one| key(table, one)).collect(),
        words: Vec::new(),
    });
    parts.chain([types(), units()]).collect()
}

/// Returns all mappings of the language.
pub(crate) fn tables() -> Vec<&'static Table> {
    let mut tables: Vec<&Table> = vec![File::TABLE];
    let mut at = 0;
    while let Some(table) = tables.get(at).copied() {
        at += 1;
        let mut found = Vec::new();
        table
            .keys
            .iter()
            .for_each(|key| inside(&key.kind, &mut found));
        for table in found {
            if !tables.iter().any(|known| known.name == table.name) {
                tables.push(table);
            }
        }
    }
    tables
}

/// Returns the words that a value of this kind can be.
pub(crate) fn words(kind: &Kind) -> Vec<Word> {
    match kind {
        Kind::Type => types().words,
        Kind::Unit => units().words,
        Kind::Word(words) => words.iter().map(word).collect(),
        _ => Vec::new(),
    }
}

const TYPE: &str = "type";
const UNIT: &str = "unit";

fn types() -> Part {
    let numbers = IntKind::WORDS.iter().chain(FloatKind::WORDS);
    Part {
        id: TYPE,
        name: both(Doc::new(TYPE, "类型")),
        text: both(Doc::new(
            "A built-in type or the name of a declared one. `[T]` is a list of `T`. A `?` at the end marks an optional field.",
            "内置类型或已声明的类型名；`[T]` 是 `T` 的列表；末尾加 `?` 表示字段可选。",
        )),
        example: None,
        faults: Vec::new(),
        keys: Vec::new(),
        words: PLAIN.iter().chain(numbers).map(word).collect(),
    }
}

/// Built-in types that are not numbers.
const PLAIN: [Meaning; 6] = [
    ("bool", "`true` or `false`.", "`true` 或 `false`。"),
    ("string", "A text.", "文本。"),
    (
        "base64",
        "Bytes, as a base64 string.",
        "字节，写成 base64 字符串。",
    ),
    (
        "timestamp_ms",
        "Milliseconds since 1970-01-01T00:00:00Z.",
        "从 1970-01-01T00:00:00Z 起的毫秒数。",
    ),
    (
        "timestamp_s",
        "Seconds since 1970-01-01T00:00:00Z.",
        "从 1970-01-01T00:00:00Z 起的秒数。",
    ),
    (
        "json",
        "Any JSON value, kept unchanged.",
        "任意 JSON 值，原样保留。",
    ),
];

fn units() -> Part {
    Part {
        id: UNIT,
        name: both(Doc::new(UNIT, "单位")),
        text: both(Doc::new(
            "A unit of measurement, as the pages print it.",
            "计量单位，写法与页面上显示的相同。",
        )),
        example: None,
        faults: Vec::new(),
        keys: Vec::new(),
        words: UNITS.iter().map(word).collect(),
    }
}

fn key(table: &Table, key: &AnyKey) -> Key {
    Key {
        name: key.name,
        required: key.required,
        text: both(key.doc),
        takes: takes(&key.kind),
        default: key.said.default,
        example: example::for_key(key),
        faults: faults::of_key(table, key),
    }
}

/// Collects the tables that a kind contains.
fn inside(kind: &Kind, found: &mut Vec<&'static Table>) {
    match kind {
        Kind::Map(table) => found.push(table),
        Kind::List { of, .. } => inside(of, found),
        Kind::Entries { value, .. } => inside(value, found),
        Kind::Either(kinds) => kinds.iter().for_each(|kind| inside(kind, found)),
        Kind::ByKey { tables, .. } => found.extend(tables.iter().map(|(_, table)| *table)),
        Kind::Body => inside(&FIELD_KIND, found),
        _ => {}
    }
}

fn takes(kind: &Kind) -> Vec<Takes> {
    if let Kind::Either(kinds) = kind {
        return kinds.iter().flat_map(takes).collect();
    }
    let parts = match kind {
        Kind::Type => vec![TYPE],
        Kind::Unit => vec![UNIT],
        _ => {
            let mut tables = Vec::new();
            inside(kind, &mut tables);
            tables.iter().map(|table| table.name).collect()
        }
    };
    let words = match kind {
        Kind::Word(words)
        | Kind::List {
            of: Kind::Word(words),
            ..
        } => words,
        _ => [].as_slice(),
    };
    vec![Takes {
        text: describe(kind),
        parts,
        words: words.iter().map(word).collect(),
    }]
}

/// Describes a kind that has no part and no words.
fn describe(kind: &Kind) -> Text {
    let (en, zh) = match kind {
        Kind::Ref { name, .. } => return describe(name),
        Kind::Text => ("text", "文本"),
        Kind::Bool => ("`true` or `false`", "`true` 或 `false`"),
        Kind::Int { min, .. } if *min == i64::MIN.into() => ("integer", "整数"),
        Kind::Int { min, max } => {
            return Text {
                en: format!("integer, {min} to {max}"),
                zh: format!("整数，{min} 到 {max}"),
            };
        }
        Kind::Number => ("number", "数值"),
        Kind::Scalar => ("boolean, number or text", "布尔值、数值或文本"),
        Kind::Json => ("any JSON value", "任意 JSON 值"),
        Kind::Code => (
            "`0x` and four upper-case hex digits",
            "`0x` 加四位大写十六进制数字",
        ),
        Kind::Date => ("`YYYY-MM` or `YYYY-MM-DD`", "`YYYY-MM` 或 `YYYY-MM-DD`"),
        Kind::Name => ("`snake_case` name", "`snake_case` 名称"),
        Kind::TypeName => ("`PascalCase` name of a type", "`PascalCase` 类型名"),
        Kind::ConflictId => ("id such as `C040`", "编号，例如 `C040`"),
        Kind::MediaType => (
            "media type such as `image/png`",
            "媒体类型，例如 `image/png`",
        ),
        Kind::WireKey => ("wire key", "报文中的键名"),
        Kind::Body => ("wire keys, under each", "报文中的键名，其下为"),
        Kind::List { of, min, max } => {
            let of = describe(of);
            let (en, zh) = match (min, max) {
                (2, 2) => ("list of two: ", "两项的列表："),
                (0, _) => ("list, possibly empty: ", "列表，可以为空："),
                _ => ("list: ", "列表："),
            };
            return Text {
                en: en.to_owned() + &of.en,
                zh: zh.to_owned() + &of.zh,
            };
        }
        Kind::Entries { key, value, .. } => {
            let (key, value) = (describe(key), describe(value));
            return Text {
                en: format!("mapping; keys: {}; under each: {}", key.en, value.en),
                zh: format!("映射；键：{}；其下为：{}", key.zh, value.zh),
            };
        }
        // The page adds a link for each part.
        Kind::Either(kinds) => {
            let texts: Vec<Text> = kinds.iter().map(describe).collect();
            let en: Vec<&str> = texts.iter().map(|text| &*text.en).collect();
            let zh: Vec<&str> = texts.iter().map(|text| &*text.zh).collect();
            return Text {
                en: en.join(" or ").trim_end().to_owned(),
                zh: zh.join("或"),
            };
        }
        Kind::Type | Kind::Unit | Kind::Word(_) | Kind::Map(_) | Kind::ByKey { .. } => ("", ""),
    };
    both(Doc::new(en, zh))
}

fn word((word, en, zh): &Meaning) -> Word {
    Word {
        word,
        text: both(Doc::new(en, zh)),
    }
}

fn both(doc: Doc) -> Text {
    Text {
        zh: doc.zh.to_owned(),
        en: doc.en.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Type;

    #[test]
    fn every_built_in_type_is_told() {
        let told = types().words;
        for name in Type::built_in() {
            assert!(told.iter().any(|word| word.word == name), "{name}");
        }
        assert_eq!(told.len(), Type::built_in().count());
    }

    #[test]
    fn reference_is_bilingual_and_links_resolve() {
        let parts = reference();
        let is_known = |id: &str| parts.iter().any(|part| part.id == id);
        let said = |text: &Text| !text.zh.is_ascii() && text.zh != text.en;
        for part in &parts {
            assert!(said(&part.text) && said(&part.name), "{}", part.id);
            for word in &part.words {
                assert!(said(&word.text), "{} of {}", word.word, part.id);
            }
            for key in &part.keys {
                assert!(said(&key.text), "{} of {}", key.name, part.id);
                for takes in &key.takes {
                    assert!(takes.parts.iter().all(|id| is_known(id)), "{}", key.name);
                    let words = takes.words.iter();
                    assert!(words.clone().all(|word| said(&word.text)), "{}", key.name);
                }
            }
        }
    }
}
