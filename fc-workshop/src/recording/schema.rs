//! JSON Schema of messages, as viewers of recordings read it: the root is an object, and references are internal.

use crate::paths;
use fc_reflect::sample::Samples;
use fc_spec::model::{
    Direction, EnumRepr, EnumType, Field, Model, Operation, StructType, Type, TypeRef, WireForm,
};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Returns the schema of a message with its envelope.
pub(super) fn of(model: &Model, operation: &Operation, direction: Direction) -> Value {
    let mut schema = Schema {
        model,
        wanted: BTreeSet::new(),
    };
    let mut properties = Map::new();
    for field in Samples::new(model).envelope(direction) {
        let mut property = schema.ty(&field.ty);
        describe(&mut property, &field.text.en);
        properties.insert(field.wire.clone(), property);
    }
    if let Some(body) = operation.body(direction) {
        properties.extend(schema.fields(model.types.structure(&body.ty)));
    }
    let mut definitions = Map::new();
    // A definition may want others.
    while let Some(named) = schema.wanted.pop_first() {
        if !definitions.contains_key(named.name()) {
            definitions.insert(named.name().to_owned(), schema.definition(named));
        }
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": operation.title.en,
        "type": "object",
        "properties": properties,
        "$defs": definitions,
    })
}

fn describe(property: &mut Value, text: &str) {
    if let Value::Object(entries) = property {
        entries.insert("description".to_owned(), text.into());
    }
}

/// A schema with the types that it wants.
struct Schema<'m> {
    model: &'m Model,
    wanted: BTreeSet<TypeRef>,
}

impl Schema<'_> {
    fn fields(&mut self, shape: &StructType) -> Map<String, Value> {
        let fields = shape.fields.iter();
        fields
            .map(|field| (field.wire.clone(), self.field(field)))
            .collect()
    }

    fn field(&mut self, field: &Field) -> Value {
        let mut property = match field.wire_form {
            WireForm::String if is_scalar(&field.ty) => json!({ "type": "string" }),
            WireForm::Number if field.ty == Type::Bool => json!({ "type": "integer" }),
            _ => self.ty(&field.ty),
        };
        let unit = field.details().unit.as_ref();
        let unit = unit.map_or_else(String::new, |unit| format!(" [{unit}]"));
        describe(&mut property, &format!("{}{unit}", field.text.en));
        property
    }

    /// The recursion is as deep as the lists of a type.
    fn ty(&mut self, ty: &Type) -> Value {
        match ty {
            Type::Bool => json!({ "type": "boolean" }),
            Type::Int(_) | Type::TimestampMs | Type::TimestampS => json!({ "type": "integer" }),
            Type::Float(_) => json!({ "type": "number" }),
            Type::String => json!({ "type": "string" }),
            Type::Base64 => json!({ "type": "string", "contentEncoding": "base64" }),
            Type::Json => json!({}),
            Type::Array(item) => json!({ "type": "array", "items": self.ty(item) }),
            Type::Named(named) => self.named(named),
        }
    }

    fn named(&mut self, named: &TypeRef) -> Value {
        if let Some(shape) = self.model.types.get(named).shape.enumeration() {
            return enumeration(shape);
        }
        self.wanted.insert(named.clone());
        json!({ "$ref": format!("#/$defs/{}", named.name()) })
    }

    /// Viewers know no alternatives, so the object of a one-of has the keys of all variants.
    fn definition(&mut self, named: TypeRef) -> Value {
        let shapes = paths::shapes(self.model, &Type::Named(named)).into_iter();
        let properties: Map<_, _> = shapes.flat_map(|shape| self.fields(shape)).collect();
        json!({ "type": "object", "properties": properties })
    }
}

fn is_scalar(ty: &Type) -> bool {
    matches!(ty, Type::Bool | Type::Int(_) | Type::Float(_))
}

/// Returns the schema of an enum, whose names are in the description.
fn enumeration(shape: &EnumType) -> Value {
    let ty = match shape.repr {
        EnumRepr::Int(_) => "integer",
        EnumRepr::String => "string",
    };
    json!({ "type": ty })
}
