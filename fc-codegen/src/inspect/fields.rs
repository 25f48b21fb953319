//! The flat list of a body's fields, by paths of wire keys.

use crate::sample::{Profile, Samples};
use fc_spec::model::{
    Body, EnumRepr, Field, FieldDetails, Text, Type, TypeDef, TypeShape, Types, Value, WireForm,
};
use serde::Serialize;
use std::collections::HashMap;

/// Returns all fields of a body, in order.
pub(super) fn of_body<'m>(samples: &Samples<'m>, body: &'m Body) -> Vec<Entry<'m>> {
    let mut walk = Walk {
        samples,
        entries: Vec::new(),
        at: HashMap::new(),
    };
    let ty = samples.model().types.get(&body.ty);
    let example = samples.named(ty, Profile::Example);
    walk.named(ty, "", Some(&example), None);
    walk.entries
}

/// A field of a body, or the item of a list.
#[derive(Serialize)]
pub(super) struct Entry<'m> {
    path: String,
    #[serde(rename = "type")]
    ty: &'m Type,
    optional: bool,
    wire: &'static str,
    example: Value,
    variants: Vec<&'m str>,
    #[serde(flatten)]
    text: &'m Text,
    /// The name in code; `None` for the item of a list.
    name: Option<&'m str>,
    sensitive: bool,
    #[serde(flatten)]
    details: &'m FieldDetails,
}

/// A walk over a body and its contents.
struct Walk<'s, 'm> {
    samples: &'s Samples<'m>,
    entries: Vec<Entry<'m>>,
    /// The index of each path's entry. Variants of a choice share keys.
    at: HashMap<String, usize>,
}

impl<'m> Walk<'_, 'm> {
    /// Adds the fields of a named type at `path`.
    fn named(
        &mut self,
        ty: &'m TypeDef,
        path: &str,
        example: Option<&Value>,
        variant: Option<&'m str>,
    ) {
        match &ty.shape {
            TypeShape::Enum(_) => {}
            TypeShape::Struct(shape) => {
                for field in &shape.fields {
                    self.field(field, path, example, variant);
                }
            }
            TypeShape::OneOf(choice) => {
                for variant in &choice.variants {
                    let ty = self.samples.model().types.get(&variant.ty);
                    let example = self.samples.named(ty, Profile::Example);
                    self.named(ty, path, Some(&example), Some(&variant.name));
                }
            }
        }
    }

    fn field(
        &mut self,
        field: &'m Field,
        path: &str,
        example: Option<&Value>,
        variant: Option<&'m str>,
    ) {
        let path = match path {
            "" => field.wire.clone(),
            path => format!("{path}.{}", field.wire),
        };
        let example = example.and_then(|example| example.get(&field.wire));
        if let (Some(variant), Some(entry)) = (
            variant,
            self.at.get(&path).and_then(|at| self.entries.get_mut(*at)),
        ) {
            entry.variants.push(variant);
            return;
        }
        self.add(Entry {
            path: path.clone(),
            ty: &field.ty,
            optional: field.optional || variant.is_some(),
            wire: wire(&self.samples.model().types, &field.ty, field.wire_form),
            example: example.cloned().unwrap_or(Value::Null),
            variants: variant.into_iter().collect(),
            text: &field.text,
            name: Some(&field.name),
            sensitive: field.sensitive,
            details: field.details(),
        });
        self.inside(&field.ty, &path, field, example);
    }

    /// Adds the fields inside a value of this type.
    fn inside(&mut self, ty: &'m Type, path: &str, field: &'m Field, example: Option<&Value>) {
        match ty {
            Type::Named(named) => {
                self.named(self.samples.model().types.get(named), path, example, None);
            }
            Type::Array(item) => {
                let path = format!("{path}[]");
                let example = match example {
                    Some(Value::Array(items)) => items.first(),
                    _ => None,
                };
                let text = match &**item {
                    Type::Named(named) => Some(&self.samples.model().types.get(named).title),
                    _ => None,
                };
                self.add(Entry {
                    path: path.clone(),
                    ty: item,
                    optional: false,
                    wire: wire(&self.samples.model().types, item, field.wire_form),
                    example: example.cloned().unwrap_or(Value::Null),
                    variants: Vec::new(),
                    text: text.unwrap_or(&field.text),
                    name: None,
                    sensitive: false,
                    details: FieldDetails::none(),
                });
                self.inside(item, &path, field, example);
            }
            _ => {}
        }
    }

    fn add(&mut self, entry: Entry<'m>) {
        self.at.insert(entry.path.clone(), self.entries.len());
        self.entries.push(entry);
    }
}

/// Returns the JSON type of a value on the wire.
pub(super) fn wire(types: &Types, ty: &Type, form: WireForm) -> &'static str {
    match ty {
        Type::Array(_) => "array",
        Type::Bool | Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS
            if form == WireForm::String =>
        {
            "string"
        }
        Type::Bool if form == WireForm::Number => "number",
        Type::Bool => "bool",
        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS => "number",
        Type::String | Type::Base64 => "string",
        Type::Json => "any",
        Type::Named(named) => match &types.get(named).shape {
            TypeShape::Enum(shape) => match shape.repr {
                EnumRepr::Int(_) => "number",
                EnumRepr::String => "string",
            },
            TypeShape::Struct(_) | TypeShape::OneOf(_) => "object",
        },
    }
}
