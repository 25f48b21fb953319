//! Edits a spec so that it describes messages that peers really send.
//!
//! New fields, values and results say where they come from. The owner of the protocol writes their meaning.

use crate::format::Revised;
use crate::index::{DefId, Index, entry_at};
use crate::language::grammar::{
    COMMAND, ENUM, ENUM_VALUE, Enum, EnumValue, FIELD, FILE, Field, ITEMS, OBJECT, REPORT, Struct,
    Table,
};
use crate::load::{Trees, yaml_scalar};
use crate::model::{Direction, Kind, Model, Number, Scalar};
use crate::names;
use crate::source::{Edits, SourceFile, Sources, Span};
use crate::syntax::{Entry, Node, quoted};

/// A change of a spec.
#[derive(Clone, Debug, PartialEq)]
pub enum Amendment {
    /// A struct gets an optional field.
    AddField {
        /// The struct.
        owner: String,
        /// The wire key.
        key: String,
        /// The type of the field, as the spec writes it.
        ty: &'static str,
    },
    /// A key of a field gets a value, or is removed.
    SetKey {
        /// The struct.
        owner: String,
        /// The wire key of the field.
        field: String,
        /// The key.
        key: FieldKey,
        /// The value as YAML, or `None` to remove the key.
        value: Option<String>,
    },
    /// A field gets another type. Keys that belong to the old type are removed, unless both are numbers.
    SetType {
        /// The struct.
        owner: String,
        /// The wire key of the field.
        field: String,
        /// The type, as the spec writes it.
        ty: String,
    },
    /// An enum gets a value.
    AddValue {
        /// The enum.
        owner: String,
        /// The value on the wire.
        value: Scalar,
    },
    /// A state of an enum gets a successor.
    AddSuccessor {
        /// The enum.
        owner: String,
        /// The name of the state.
        state: String,
        /// The name of the successor.
        successor: String,
    },
    /// The protocol gets a result code.
    AddResult(
        /// The code.
        i64,
    ),
}

/// A key of a field that an amendment sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldKey(&'static str);

impl FieldKey {
    /// `true` if it may be absent.
    pub const OPTIONAL: Self = Self(FIELD.optional.name);
    /// The smallest number.
    pub const MIN: Self = Self(FIELD.min.name);
    /// The largest number.
    pub const MAX: Self = Self(FIELD.max.name);
    /// The number of characters, bytes or items.
    pub const LENGTH: Self = Self(FIELD.length.name);
    /// The pattern of a string.
    pub const PATTERN: Self = Self(FIELD.pattern.name);
    /// The values of an enum that the field takes.
    pub const ONLY: Self = Self(FIELD.only.name);
    /// The leniencies of the decoder.
    pub const QUIRK: Self = Self(FIELD.quirk.name);
}

/// Makes an amendment. `model` is the model of `sources`.
///
/// Returns `None` if the spec has no such type, field or state, or if the field is in the short form. It does not check the
/// result: [`load`](crate::load::load) reports a name that is taken.
#[must_use]
pub fn amend(sources: &Sources, model: &Model, amendment: &Amendment) -> Option<Revised> {
    let index = Index::new(Trees::new(sources));
    let editor = Editor {
        index: &index,
        model,
    };
    let edits = editor.edits(amendment)?;
    let file = sources.get(edits.place()?.file)?;
    Some(Revised::new(sources, file, &edits))
}

struct Editor<'e> {
    index: &'e Index,
    model: &'e Model,
}

impl Editor<'_> {
    fn edits(&self, amendment: &Amendment) -> Option<Edits> {
        match amendment {
            Amendment::AddField { owner, key, ty } => self.add_field(owner, key, ty),
            Amendment::SetKey {
                owner,
                field,
                key,
                value,
            } => self.with(Field::TABLE, Some(owner), field, |file, entry| {
                set(file, entry.value, key.0, value.as_deref())
            }),
            Amendment::SetType { owner, field, ty } => {
                self.with(Field::TABLE, Some(owner), field, |file, entry| {
                    set_type(file, entry.value, ty)
                })
            }
            Amendment::AddValue { owner, value } => {
                let (name, wire) = (value_name(value), wire_text(value));
                let texts = texts(&format!("取值 {wire}"), &format!("Value {wire}"));
                let entry = format!("{wire}: {{ {}: {name}, {texts} }}", ENUM_VALUE.name.name);
                self.with(Enum::TABLE, None, owner, |file, declared| {
                    add_entry(file, ENUM.values.of(declared.value)?, &entry)
                })
            }
            Amendment::AddSuccessor {
                owner,
                state,
                successor,
            } => self.with(
                EnumValue::TABLE,
                Some(owner),
                state,
                |file, entry| match ENUM_VALUE.then.of(entry.value) {
                    Some(list) => {
                        let mut edits = Edits::default();
                        edits.insert_after(list.items().last()?.span(), format!(", {successor}"));
                        is_flow(file, list).then_some(edits)
                    }
                    None => add_entry(
                        file,
                        entry.value,
                        &format!("{}: [{successor}]", ENUM_VALUE.then.name),
                    ),
                },
            ),
            Amendment::AddResult(code) => {
                let texts = texts(&format!("结果 {code}"), &format!("Result {code}"));
                let name = format!("result_{code}").replace('-', "minus_");
                let entry = format!("{code}: {{ {}: {name}, {texts} }}", ENUM_VALUE.name.name);
                let trees = self.index.trees();
                let files = trees.sources().iter();
                files.into_iter().find_map(|(id, file)| {
                    let tree = trees.tree(id)?;
                    add_entry(file, FILE.results.of(tree.root())?, &entry)
                })
            }
        }
    }

    fn add_field(&self, owner: &str, key: &str, ty: &str) -> Option<Edits> {
        let texts = texts(&format!("字段 {key}"), &format!("Key {key}"));
        let key = yaml_scalar(key);
        let field = format!("{key}: {{ {}: \"{ty}?\", {texts} }}", FIELD.r#type.name);
        let body = self.model.types.named(owner)?.body_of.as_ref();
        let is_body = body.is_some_and(|body| body.path.is_empty());
        self.with(Struct::TABLE, None, owner, |file, entry| {
            let node = entry.value;
            // A body without keys is declared by its operation.
            if is_body && body.is_some_and(|body| body.operation == entry.name()) {
                let name = match body?.side {
                    Direction::Response => COMMAND.response.name,
                    Direction::Request => match self.model.operation(&body?.operation)?.kind() {
                        Kind::Command => COMMAND.request.name,
                        Kind::Report | Kind::Stream => REPORT.body.name,
                    },
                };
                return match node.get(name) {
                    Some(fields) => add_entry(file, fields, &field),
                    None => add_entry(file, node, &format!("{name}: {{ {field} }}")),
                };
            }
            let fields = OBJECT.fields.of(node).or(ITEMS.items.of(node));
            add_entry(file, fields.unwrap_or(node), &field)
        })
    }

    /// Returns the edits inside the declaration of a thing.
    fn with(
        &self,
        kind: &'static Table,
        owner: Option<&String>,
        name: &str,
        edit: impl Fn(&SourceFile, Entry<'_>) -> Option<Edits>,
    ) -> Option<Edits> {
        let definitions = self.index.definitions();
        let site = definitions.get(&DefId {
            kind: kind.name,
            owner: owner.cloned(),
            name: name.to_owned(),
        })?;
        let trees = self.index.trees();
        let tree = trees.tree(site.key.file)?;
        let entry = entry_at(tree.root(), site.key)?;
        edit(trees.sources().get(site.key.file)?, entry)
    }
}

/// Adds an entry at the end of a mapping.
fn add_entry(file: &SourceFile, mapping: Node<'_>, entry: &str) -> Option<Edits> {
    mapping.as_mapping()?;
    let mut edits = Edits::default();
    match mapping.entries().last() {
        None => edits.replace(mapping.span(), format!("{{ {entry} }}")),
        Some(last) if is_flow(file, mapping) => {
            edits.insert_after(last.span(), format!(", {entry}"));
        }
        Some(last) => {
            let column = file.line_col(last.key.span().start).column;
            let indent = " ".repeat(column.saturating_sub(1));
            edits.add_line(file, last.span(), &format!("{indent}{entry}"));
        }
    }
    Some(edits)
}

/// Sets or removes a key of a field. A field in the short form has no keys.
fn set(file: &SourceFile, field: Node<'_>, key: &str, value: Option<&str>) -> Option<Edits> {
    field.as_mapping()?;
    let mut edits = Edits::default();
    match (field.get(key), value) {
        (Some(old), Some(value)) => edits.replace(old.span(), value),
        (None, Some(value)) => return add_entry(file, field, &format!("{key}: {value}")),
        (_, None) => remove(file, field, key, &mut edits),
    }
    Some(edits)
}

/// Sets the type of a field, and removes the keys that belong to its old type.
fn set_type(file: &SourceFile, field: Node<'_>, ty: &str) -> Option<Edits> {
    let mut edits = Edits::default();
    if field.as_mapping().is_none() {
        edits.replace(field.span(), quoted(ty));
        return Some(edits);
    }
    let old = FIELD.r#type.of(field)?;
    edits.replace(old.span(), quoted(ty));
    let is_number = |ty: &str| ty.starts_with(['i', 'u', 'f']);
    if !(is_number(ty) && old.as_str().is_some_and(is_number)) {
        for key in OF_THE_TYPE {
            remove(file, field, key, &mut edits);
        }
    }
    Some(edits)
}

/// Keys of a field that only some types can have.
const OF_THE_TYPE: [&str; 12] = [
    FIELD.only.name,
    FIELD.refers.name,
    FIELD.wire.name,
    FIELD.coordinates.name,
    FIELD.min.name,
    FIELD.max.name,
    FIELD.length.name,
    FIELD.pattern.name,
    FIELD.unit.name,
    FIELD.quirk.name,
    FIELD.default.name,
    FIELD.example.name,
];

/// Removes a key of a field, if it exists. The type precedes all keys that can be removed.
fn remove(file: &SourceFile, field: Node<'_>, key: &str, edits: &mut Edits) {
    let mut before = None;
    for entry in field.entries() {
        if entry.name() == key {
            let span = entry.span();
            match before {
                _ if !is_flow(file, field) => edits.remove_lines(file, span),
                Some(before) => edits.replace(Span::new(span.file, before, span.end), ""),
                None => {}
            }
        }
        before = Some(entry.span().end);
    }
}

fn is_flow(file: &SourceFile, node: Node<'_>) -> bool {
    file.slice(node.span()).starts_with(['{', '['])
}

/// Returns the texts of a thing that was only seen in a recording.
fn texts(zh: &str, en: &str) -> String {
    let (zh, en) = (
        format!("录包中出现的{zh}"),
        format!("{en}, seen in a recording"),
    );
    format!("zh: {}, en: {}", quoted(&zh), quoted(&en))
}

fn wire_text(value: &Scalar) -> String {
    match value {
        Scalar::Bool(value) => value.to_string(),
        Scalar::Number(Number::Int(value)) => value.to_string(),
        Scalar::Number(Number::Float(value)) => value.to_string(),
        Scalar::String(text) => quoted(text),
    }
}

fn value_name(value: &Scalar) -> String {
    let text = match value {
        Scalar::String(text) => names::snake(text),
        other => wire_text(other).replace('-', "minus_"),
    };
    format!("value_{text}")
}
