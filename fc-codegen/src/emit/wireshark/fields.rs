//! The keys of bodies, each with its filter name, type and values.

use super::in_languages;
use super::lua::{Table, quoted};
use crate::package::joined::Joined;
use fc_spec::model::{
    EnumRepr, EnumType, EnvelopeRole, IntKind, Languages, Model, Number, Scalar, StructType, Text,
    Type, TypeShape,
};
use std::collections::BTreeMap;

/// The deepest objects whose keys have a filter name. Types can contain themselves.
const DEEPEST: usize = 12;

/// A filter field.
struct Filter {
    /// The type as Wireshark names it.
    ty: &'static str,
    text: String,
    /// The wire values with their names.
    values: Vec<(String, String)>,
}

/// Returns the filter fields of all bodies. Keys of the envelope have no operation in their path.
pub(super) fn table(model: &Model, languages: Languages) -> Table {
    let mut filters = Filters {
        model,
        languages,
        found: BTreeMap::new(),
        types: Vec::new(),
    };
    let envelope = &model.envelope;
    for field in envelope.request.iter().chain(&envelope.response) {
        let mut values = Vec::new();
        if field.role == EnvelopeRole::ResultCode {
            values = results(model);
        }
        filters.leaf(field.wire.clone(), &field.ty, &field.text, values);
    }
    for operation in &model.operations {
        for body in operation
            .directions()
            .iter()
            .filter_map(|it| operation.body(*it))
        {
            filters.keys(&operation.name, model.types.structure(&body.ty));
        }
    }
    let mut table = Table::new(1);
    for (path, filter) in &filters.found {
        let (path, ty, text) = (quoted(path), filter.ty, quoted(&filter.text));
        let values = filter.values.iter();
        let values = values.map(|(value, name)| format!("[{}] = {}", quoted(value), quoted(name)));
        let mut values = values.joined(", ");
        if !values.is_empty() {
            values = format!(", {{ {values} }}");
        }
        table.push(format_args!("{{ {path}, \"{ty}\", {text}{values} }}"));
    }
    table
}

fn results(model: &Model) -> Vec<(String, String)> {
    let results = model.results.iter();
    results
        .map(|result| (result.code.to_string(), result.name.clone()))
        .collect()
}

struct Filters<'m> {
    model: &'m Model,
    languages: Languages,
    found: BTreeMap<String, Filter>,
    /// The structs that lead to the current one.
    types: Vec<*const StructType>,
}

impl<'m> Filters<'m> {
    fn keys(&mut self, path: &str, shape: &'m StructType) {
        if self.types.len() >= DEEPEST || self.types.iter().any(|it| std::ptr::eq(*it, shape)) {
            return;
        }
        self.types.push(shape);
        for field in &shape.fields {
            let path = format!("{path}.{}", field.wire);
            match field.ty.item() {
                Type::Named(named) => match &self.model.types.get(named).shape {
                    TypeShape::Struct(shape) => self.keys(&path, shape),
                    TypeShape::OneOf(choice) => {
                        for variant in &choice.variants {
                            self.keys(&path, self.model.types.structure(&variant.ty));
                        }
                    }
                    TypeShape::Enum(shape) => self.leaf(path, &field.ty, &field.text, names(shape)),
                },
                _ => self.leaf(path, &field.ty, &field.text, Vec::new()),
            }
        }
        self.types.pop();
    }

    /// Adds a key. Keys with the same path and different types are strings.
    fn leaf(&mut self, path: String, ty: &Type, text: &Text, values: Vec<(String, String)>) {
        let ty = self.filter_type(ty);
        let text = in_languages(text, self.languages);
        let filter = self
            .found
            .entry(path)
            .or_insert(Filter { ty, text, values });
        if filter.ty != ty {
            filter.ty = "string";
        }
    }

    fn filter_type(&self, ty: &Type) -> &'static str {
        match ty.item() {
            Type::Bool => "boolean",
            Type::Int(kind) => integer_type(*kind),
            Type::TimestampMs | Type::TimestampS => "int64",
            Type::Float(_) => "double",
            Type::String | Type::Base64 | Type::Json | Type::Array(_) => "string",
            Type::Named(named) => match &self.model.types.get(named).shape {
                TypeShape::Enum(EnumType {
                    repr: EnumRepr::Int(kind),
                    ..
                }) => integer_type(*kind),
                _ => "string",
            },
        }
    }
}

fn integer_type(kind: IntKind) -> &'static str {
    match kind {
        IntKind::I8 | IntKind::I16 | IntKind::I32 => "int32",
        IntKind::U8 | IntKind::U16 | IntKind::U32 => "uint32",
        IntKind::I64 => "int64",
        IntKind::U64 => "uint64",
    }
}

fn names(shape: &EnumType) -> Vec<(String, String)> {
    let values = shape.values.iter();
    values
        .map(|value| {
            let wire = match &value.wire {
                Scalar::Bool(value) => value.to_string(),
                Scalar::Number(Number::Int(value)) => value.to_string(),
                Scalar::Number(Number::Float(value)) => value.to_string(),
                Scalar::String(text) => text.clone(),
            };
            (wire, value.name.clone())
        })
        .collect()
}
