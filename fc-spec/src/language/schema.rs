//! The JSON Schema (draft 2020-12) of the spec language, built from the grammar tables.

use crate::diagnostic::Faults;
use crate::language::grammar::unit::UNITS;
use crate::language::grammar::{AnyKey, FIELD_KIND, File, Kind, Project, STATED, TEXT, Table};
use crate::language::scalar;
use crate::model::{Lang, Languages, Number, Type, Value};
use crate::source::FileId;
use crate::syntax::parse;
use crate::vocabulary::Meaning;
use std::collections::BTreeMap;

const SNAKE: &str = "^[a-z][a-z0-9]*(_[a-z0-9]+)*$";
const PASCAL: &str = "^[A-Z][A-Za-z0-9]*$";
const CONFLICT_ID: &str = "^C[0-9]{3,}$";
const MEDIA_TYPE: &str = "^[a-z0-9][a-z0-9!#$&^_.+-]*/[a-z0-9][a-z0-9!#$&^_.+-]*$";
const DATE: &str = "^[0-9]{4}-[0-9]{2}(-[0-9]{2})?$";
const INTEGER_KEY: &str = "^(-?[0-9]+|0x[0-9A-Fa-f]+)$";
/// The maximum nesting of lists in a type. Deeper types are not expected.
const LISTS_IN_TYPE: usize = 4;

/// Returns the schema for specs whose texts are in these languages, indented, with a newline at its end.
#[must_use]
pub fn schema(texts: Languages) -> String {
    document("Protocol spec", File::TABLE, texts)
}

/// Returns the schema of `fc.yaml`, like [`schema`].
#[must_use]
pub fn project_schema() -> String {
    document("Project settings", Project::TABLE, Languages::All)
}

fn document(title: &str, table: &'static Table, texts: Languages) -> String {
    let mut definitions = Definitions {
        texts,
        done: BTreeMap::new(),
    };
    let root = definitions.table_entries(table);
    let draft = string("https://json-schema.org/draft/2020-12/schema");
    let mut entries = vec![entry("$schema", draft), entry("title", string(title))];
    entries.extend(root);
    let done = Value::Object(definitions.done.into_iter().collect());
    entries.push(entry("$defs", done));
    Value::Object(entries).pretty() + "\n"
}

/// The `$defs` built so far, by name.
///
/// A name is entered before its definition is built, so that a table can contain itself.
struct Definitions {
    /// Languages of required texts.
    texts: Languages,
    done: BTreeMap<String, Value>,
}

impl Definitions {
    /// Returns a reference to a definition. Builds the definition first if it does not exist.
    fn add(&mut self, name: &str, make: impl FnOnce(&mut Self) -> Value) -> Value {
        let name = name.replace(' ', "_");
        if !self.done.contains_key(&name) {
            self.done.insert(name.clone(), Value::Null);
            let definition = make(self);
            self.done.insert(name.clone(), definition);
        }
        reference(&name)
    }

    fn table(&mut self, table: &'static Table) -> Value {
        self.add(table.name, |definitions| {
            Value::Object(definitions.table_entries(table))
        })
    }

    fn table_entries(&mut self, table: &'static Table) -> Vec<(String, Value)> {
        let properties = table
            .keys
            .iter()
            .map(|key| (key.name.to_owned(), self.key(key)))
            .collect();
        let is_needed = |key: &AnyKey| match key.name {
            name if name == TEXT.zh.name => self.texts.include(Lang::Zh),
            name if name == TEXT.en.name => self.texts.include(Lang::En),
            _ => true,
        };
        let required = table.keys.iter();
        let required: Vec<_> = required
            .filter(|key| key.required && is_needed(key))
            .map(|key| string(key.name))
            .collect();
        vec![
            entry("description", string(table.doc.en)),
            entry("type", string("object")),
            entry("properties", Value::Object(properties)),
            entry("required", Value::Array(required)),
            entry("additionalProperties", Value::Bool(false)),
        ]
    }

    fn key(&mut self, key: &'static AnyKey) -> Value {
        match self.kind(&key.kind) {
            Value::Object(mut entries) => {
                entries.insert(0, entry("description", string(key.doc.en)));
                let default = key.said.default.filter(|word| *word != STATED.name());
                let default = default.and_then(parsed);
                let examples = key.said.example.and_then(parsed);
                let examples = examples.map(|value| [value].into_iter().collect());
                entries.extend(default.map(|value| entry("default", value)));
                entries.extend(examples.map(|values| entry("examples", values)));
                Value::Object(entries)
            }
            other => other,
        }
    }

    fn kind(&mut self, kind: &'static Kind) -> Value {
        match kind {
            Kind::Ref { name, .. } => self.kind(name),
            Kind::Text | Kind::WireKey => of_type("string"),
            Kind::Bool => of_type("boolean"),
            Kind::Int { min, max } => integer(*min, *max),
            Kind::Code => integer(0, u16::MAX.into()),
            Kind::Number => of_type("number"),
            Kind::Scalar => {
                let types = json_types(kind).iter().map(|ty| string(ty));
                object([("type", types.collect())])
            }
            Kind::Json => object([]),
            Kind::Date => pattern(DATE),
            Kind::Name => pattern(SNAKE),
            Kind::TypeName => pattern(PASCAL),
            Kind::ConflictId => pattern(CONFLICT_ID),
            Kind::MediaType => pattern(MEDIA_TYPE),
            Kind::Type => self.add("type", |definitions| definitions.type_expression(r"\??")),
            Kind::Word(words) => one_of(words),
            Kind::Unit => one_of(UNITS),
            Kind::List { of, min, max } => self.list(of, *min, *max),
            Kind::Map(table) => self.table(table),
            Kind::Entries { key, value, min } => self.entries(key, value, *min),
            Kind::Body => self.add("body", Self::body),
            Kind::Either(kinds) => self.either(kinds),
            Kind::ByKey { tables, otherwise } => self.by_key(tables, otherwise),
        }
    }

    fn body(&mut self) -> Value {
        let text = "Wire keys and their fields, in the order sent.";
        object([
            ("type", string("object")),
            ("description", string(text)),
            ("additionalProperties", self.kind(&FIELD_KIND)),
        ])
    }

    fn list(&mut self, of: &'static Kind, min: usize, max: usize) -> Value {
        let mut entries = vec![
            entry("type", string("array")),
            entry("items", self.kind(of)),
        ];
        if min > 0 {
            entries.push(entry("minItems", size(min)));
        }
        if max < usize::MAX {
            entries.push(entry("maxItems", size(max)));
        }
        Value::Object(entries)
    }

    fn entries(&mut self, key: &Kind, value: &'static Kind, min: usize) -> Value {
        let mut entries = vec![entry("type", string("object"))];
        let names = match key.form() {
            Kind::Name => Some(SNAKE),
            Kind::TypeName => Some(PASCAL),
            Kind::ConflictId => Some(CONFLICT_ID),
            Kind::Int { .. } => Some(INTEGER_KEY),
            _ => None,
        };
        if let Some(names) = names {
            entries.push(entry("propertyNames", object([("pattern", string(names))])));
        }
        if min > 0 {
            entries.push(entry("minProperties", size(min)));
        }
        entries.push(entry("additionalProperties", self.kind(value)));
        Value::Object(entries)
    }

    /// Returns the schema of alternatives.
    ///
    /// The JSON type of the value selects the alternative. An editor then reports an error of that alternative instead of "none of them".
    /// The last alternative applies to every other value, also to a missing one.
    fn either(&mut self, kinds: &'static [Kind]) -> Value {
        let mut by_type: Vec<(&str, Vec<Value>)> = Vec::new();
        for kind in kinds {
            for ty in json_types(kind) {
                let schema = match (kind, *ty) {
                    (Kind::Type, "array") => self.type_list(),
                    (Kind::Type, _) => self.kind(&Kind::Type),
                    _ => self.kind(kind),
                };
                match by_type.iter_mut().find(|(known, _)| known == ty) {
                    Some((_, schemas)) => schemas.push(schema),
                    None => by_type.push((ty, vec![schema])),
                }
            }
        }
        let one = |mut schemas: Vec<Value>| match schemas.len() {
            1 => schemas.remove(0),
            _ => object([("anyOf", schemas.into_iter().collect())]),
        };
        let Some((_, last)) = by_type.pop() else {
            return object([]);
        };
        by_type
            .into_iter()
            .rev()
            .fold(one(last), |rest, (ty, schemas)| {
                either_or(of_type(ty), one(schemas), rest)
            })
    }

    /// Returns the schema of a mapping whose first marking key selects the table.
    ///
    /// Without a marking key, a mapping with a text that is not a type is the long form of a field without its type. It is not an object
    /// with the wire keys `zh` and `en`.
    fn by_key(
        &mut self,
        tables: &'static [(&'static str, &'static Table)],
        otherwise: &'static Kind,
    ) -> Value {
        let mut last = self.kind(otherwise);
        if let (Kind::Body, Some((_, first))) = (otherwise, tables.first()) {
            let key = match self.texts {
                Languages::Only(Lang::En) => TEXT.en.name,
                _ => TEXT.zh.name,
            };
            let text = object([("type", string("string")), ("not", self.kind(&Kind::Type))]);
            let has_text = object([
                ("required", [string(key)].into_iter().collect()),
                ("properties", object([(key, text)])),
            ]);
            last = either_or(has_text, self.table(first), last);
        }
        tables.iter().rev().fold(last, |rest, (mark, table)| {
            let is_marked = object([("required", [string(mark)].into_iter().collect())]);
            either_or(is_marked, self.table(table), rest)
        })
    }

    /// Returns the schema of a type. `mark` is the pattern of the text after it.
    fn type_expression(&mut self, mark: &str) -> Value {
        let word = "[A-Za-z][A-Za-z0-9_]*".to_owned();
        let ty = (0..LISTS_IN_TYPE).fold(word.clone(), |ty, _| format!(r"({word}|\[\s*{ty}\s*\])"));
        object([
            (
                "description",
                string(
                    "A built-in type or the name of a declared one. `[T]` is a list of `T`. A `?` at the end marks an optional field.",
                ),
            ),
            ("if", of_type("array")),
            ("then", self.type_list()),
            (
                "else",
                object([
                    ("type", string("string")),
                    ("pattern", string(&format!("^{ty}{mark}$"))),
                    // An editor offers these types. The schema does not know the names of declared types.
                    ("examples", Type::built_in().map(string).collect()),
                ]),
            ),
        ])
    }

    /// Returns the schema of a list type that is written as a YAML list.
    fn type_list(&mut self) -> Value {
        object([
            ("type", string("array")),
            ("items", self.item_type()),
            ("minItems", size(1)),
            ("maxItems", size(1)),
        ])
    }

    /// Returns the schema of an item type, which has no mark of an optional field.
    fn item_type(&mut self) -> Value {
        self.add("item_type", |definitions| definitions.type_expression(""))
    }
}

/// Returns the JSON types of the values of a kind.
fn json_types(kind: &Kind) -> &'static [&'static str] {
    match kind {
        Kind::Ref { name, .. } => json_types(name),
        Kind::Bool => &["boolean"],
        Kind::Int { .. } | Kind::Code => &["integer"],
        Kind::Number => &["number"],
        Kind::Scalar => &["boolean", "number", "string"],
        Kind::Type => &["string", "array"],
        Kind::List { .. } => &["array"],
        Kind::Map(_) | Kind::Entries { .. } | Kind::ByKey { .. } | Kind::Body => &["object"],
        // The grammar has no alternatives that contain any JSON value or further alternatives.
        Kind::Json | Kind::Either(_) => &[],
        Kind::Text
        | Kind::Date
        | Kind::Name
        | Kind::TypeName
        | Kind::ConflictId
        | Kind::MediaType
        | Kind::Unit
        | Kind::WireKey
        | Kind::Word(_) => &["string"],
    }
}

/// Returns the value of a default or an example. Tests check that it is valid YAML.
fn parsed(yaml: &'static str) -> Option<Value> {
    let tree = parse(FileId(0), yaml, &mut Faults::new())?;
    Some(scalar::value(tree.root()))
}

fn integer(min: i128, max: i128) -> Value {
    object([
        ("type", string("integer")),
        ("minimum", Value::Number(Number::Int(min))),
        ("maximum", Value::Number(Number::Int(max))),
    ])
}

fn pattern(pattern: &str) -> Value {
    object([("type", string("string")), ("pattern", string(pattern))])
}

/// Returns the schema of any value of a JSON type.
fn of_type(ty: &str) -> Value {
    object([("type", string(ty))])
}

/// Returns a schema that depends on a condition.
fn either_or(condition: Value, then: Value, otherwise: Value) -> Value {
    object([("if", condition), ("then", then), ("else", otherwise)])
}

fn reference(name: &str) -> Value {
    object([("$ref", Value::String(format!("#/$defs/{name}")))])
}

fn object<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Object(entries.map(|(key, value)| entry(key, value)).into())
}

fn entry(key: &str, value: Value) -> (String, Value) {
    (key.to_owned(), value)
}

fn string(text: &str) -> Value {
    Value::String(text.to_owned())
}

fn size(size: usize) -> Value {
    Value::Number(Number::Int(i128::try_from(size).unwrap_or(i128::MAX)))
}

/// Returns the schema of a set of words, with the meaning of each.
fn one_of(words: &[Meaning]) -> Value {
    object([
        (
            "enum",
            words.iter().map(|(word, ..)| string(word)).collect(),
        ),
        (
            "markdownEnumDescriptions",
            words.iter().map(|(_, doc, _)| string(doc)).collect(),
        ),
    ])
}
