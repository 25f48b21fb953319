//! Lowers declared types and tables.

use super::Lowering;
use super::available::available;
use super::body::Owner;
use super::text::own_changes;
use crate::language::grammar::{
    CHOICE, COMMON, ENUM, ENUM_VALUE, FIELD, OBJECT, TABLE, both_languages as text,
};
use crate::language::scalar;
use crate::load::draft::{Origin, Part, Sourced};
use crate::model::{
    BodyState, EnumRepr, EnumType, EnumValue, Number, Scalar, StructRef, StructType, Subject,
    Table, TypeDef, TypeShape,
};
use crate::syntax::{Entry, Node};

impl<'a> Lowering<'a, '_> {
    pub(super) fn type_def(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let name = origin.key.as_str().unwrap_or_default().to_owned();
        self.answers(node, &Subject::Type(name.clone()));
        let owner = Owner {
            type_name: name.clone(),
            body_of: None,
        };
        let def = TypeDef {
            name,
            group: self.group.clone(),
            title: text(node),
            about: COMMON.about.read(node),
            shape: TypeShape::Struct(StructType::new(
                BodyState::Stated,
                FIELD.coordinates.read(node),
            )),
            body_of: None,
            since: COMMON.since.read(node),
            changes: own_changes(node),
            location: self.location(origin.name()),
        };
        let index = self.push_type(def, origin);
        if let Some(repr) = ENUM.r#enum.of(node) {
            self.fill_enum(index, repr, node);
        } else if let Some(variants) = CHOICE.one_of.of(node) {
            self.fill_one_of(index, &owner, variants);
        } else {
            let fields = OBJECT.fields.get(node);
            self.fill_struct(index, &owner, fields);
        }
    }

    fn fill_enum(&mut self, index: usize, repr: Node<'_>, node: Node<'a>) {
        let repr = repr.as_str().and_then(|repr| repr.parse().ok());
        let entries = ENUM.values.get(node);
        let (values, parts) = entries.map(|entry| enum_value(repr, entry)).unzip();
        if let Some(draft) = self.draft.types.get_mut(index) {
            draft.def.shape = TypeShape::Enum(EnumType {
                repr: repr.unwrap_or(EnumRepr::String),
                closed: ENUM.closed.get(node),
                order: ENUM.order.read(node),
                values,
            });
            draft.parts = parts;
        }
    }

    pub(super) fn table(&mut self, origin: Origin<'a>) {
        let node = origin.node;
        let id = origin.key.as_str().unwrap_or_default().to_owned();
        self.answers(node, &Subject::Table(id.clone()));
        let title = text(node);
        let item = Table {
            id,
            about: COMMON.about.read(node).unwrap_or_else(|| title.clone()),
            title,
            row: StructRef::named(TABLE.row.get(node)),
            rows: TABLE.rows.get(node),
            kept: COMMON.kept.read(node),
            location: self.location(origin.name()),
        };
        self.draft.tables.push(Sourced { item, origin });
    }
}

fn enum_value(repr: Option<EnumRepr>, entry: Entry<'_>) -> (EnumValue, Part<'_>) {
    // A string among the values of an integer enum stays a string; a check reports it.
    let wire = match (repr, scalar::int(entry.key)) {
        (Some(EnumRepr::Int(_)), Some(value)) => Scalar::Number(Number::Int(value)),
        _ => Scalar::String(entry.name().to_owned()),
    };
    let value = EnumValue {
        wire,
        name: ENUM_VALUE.name.get(entry.value),
        text: text(entry.value),
        start: ENUM_VALUE.start.get(entry.value),
        then: ENUM_VALUE.then.get(entry.value),
        is_final: ENUM_VALUE.r#final.get(entry.value),
        is_error: ENUM_VALUE.error.get(entry.value),
        since: COMMON.since.read(entry.value),
        available: available(entry.value),
    };
    let part = Part {
        origin: Origin::from(entry),
        ty: entry.key.span(),
        broken: repr.is_none(),
        borrows_text: false,
    };
    (value, part)
}
