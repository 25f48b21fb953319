//! C++ types, and the order of the spec's types in files. A type comes after the types that it contains.

use crate::package::context::Context;
use crate::package::cycles::{Needs, first_of_circle, reached};
use crate::package::items::{Item, Shape};
use crate::package::language::{CPP, Role};
use crate::package::process::set_off;
use crate::package::source::Source;
use crate::package::types::{in_lists, parts};
use fc_spec::model::{Accepted, Direction, Field, Type, TypeRef};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Returns the namespace and folder of the package.
pub fn namespace<'c>(context: &'c Context<'_>) -> Cow<'c, str> {
    CPP.spelled(Role::Module, &context.model().protocol.id)
}

/// Returns the C++ type of a type of the spec, inside the package's namespace.
pub fn name_of(context: &Context<'_>, ty: &Type) -> String {
    name_in(context, "", ty)
}

/// Returns a C++ type with `space` before each name of the package, such as `fc::`.
pub fn name_in(context: &Context<'_>, space: &str, ty: &Type) -> String {
    match ty {
        Type::Bool => "bool".to_owned(),
        Type::Int(kind) => integer_type(kind.name()),
        Type::Float(kind) => match kind.name() {
            "f32" => "float",
            _ => "double",
        }
        .to_owned(),
        Type::String => "std::string".to_owned(),
        Type::TimestampMs | Type::TimestampS => "std::int64_t".to_owned(),
        Type::Base64 => "fc_runtime::Bytes".to_owned(),
        Type::Json => "fc_runtime::Json".to_owned(),
        Type::Array(item) => format!("std::vector<{}>", name_in(context, space, item)),
        Type::Named(named) => [space, context.name_of(named)].concat(),
    }
}

/// Returns the C++ type of a field without `std::optional`. An id field has its id type, if one exists.
pub fn field_type(context: &Context<'_>, field: &Field) -> String {
    field_type_in(context, "", field)
}

/// Returns the C++ type of a field with `space` before each name of the package.
pub fn field_type_in(context: &Context<'_>, space: &str, field: &Field) -> String {
    let Some(id) = context.package.id_of(field) else {
        return name_in(context, space, &field.ty);
    };
    let id = [space, &*id.name].concat();
    in_lists(&field.ty, &id, |item| format!("std::vector<{item}>"))
}

/// Converts an integer type: `u16` to `std::uint16_t`.
pub fn integer_type(name: &str) -> String {
    let (sign, bits) = name.split_at(1);
    let unsigned = if sign == "u" { "u" } else { "" };
    format!("std::{unsigned}int{bits}_t")
}

/// A header: a group's types and operations, or those of several groups that need each other.
#[derive(Default)]
pub struct Header<'p, 'm> {
    /// The name of the header.
    pub id: &'p str,
    /// The types, each after the types that it contains.
    pub items: Vec<&'p Item<'m>>,
    /// The ids of the headers that it includes.
    pub needs: BTreeSet<&'p str>,
}

impl Header<'_, '_> {
    /// Instantiates the codecs of the types, with `word` before each.
    pub fn codecs(&self, out: &mut Source, space: &str, word: &str) {
        for item in &self.items {
            let template = match &item.shape {
                Shape::Record(..) => "Codec",
                Shape::Enum(..) => "EnumCodec",
                Shape::Choice(..) => continue,
            };
            let name = &item.ty.name;
            out.line(format!("{word} struct {template}<{space}::{name}>;"));
        }
    }
}

/// Returns the headers with their types, and the header of each group.
pub fn headers<'p, 'm>(
    context: &'p Context<'m>,
) -> (Vec<Header<'p, 'm>>, BTreeMap<&'p str, &'p str>) {
    let package = &context.package;
    let needs = package.modules.iter().map(|module| {
        let held = module.items.iter().flat_map(|item| held_by(context, item));
        let modules = held.map(|ty| package.module_of(ty).id.as_str());
        (module.id.as_str(), modules.collect())
    });
    let needs = reached(&needs.collect::<Needs<'_>>());
    let homes = needs.keys().map(|id| (*id, first_of_circle(&needs, id)));
    let mut homes: BTreeMap<&str, &str> = homes.collect();
    let mut headers: BTreeMap<&str, Header<'p, 'm>> = BTreeMap::new();
    for module in &package.modules {
        let home = homes.get(module.id.as_str()).copied().unwrap_or(&module.id);
        let needed = needs.get(module.id.as_str()).into_iter().flatten();
        let needed = needed.filter_map(|id| homes.get(id)).copied();
        let header = headers.entry(home).or_default();
        header.items.extend(&module.items);
        header.needs.extend(needed.filter(|id| *id != home));
    }
    // A group that has only streams has no types, but needs a header.
    for operation in &context.model().operations {
        let id = operation.group.as_str();
        headers.entry(homes.entry(id).or_insert(id)).or_default();
    }
    let headers = headers.into_iter();
    let mut headers: Vec<_> = headers
        .map(|(id, header)| Header { id, ..header })
        .collect();
    for header in &mut headers {
        let mut ordered = Vec::new();
        for item in header.items.clone() {
            place(context, item, &header.items, &mut Vec::new(), &mut ordered);
        }
        header.items = ordered;
    }
    (headers, homes)
}

/// Adds a type to `ordered`, after the types of the same header that it contains.
fn place<'p, 'm>(
    context: &'p Context<'m>,
    item: &'p Item<'m>,
    here: &[&'p Item<'m>],
    open: &mut Vec<&'p str>,
    ordered: &mut Vec<&'p Item<'m>>,
) {
    let name = &*item.ty.name;
    if open.contains(&name) || ordered.iter().any(|placed| placed.ty.name == name) {
        return;
    }
    open.push(name);
    for ty in held_by(context, item) {
        let held = context.package.item(ty);
        if here.iter().any(|other| other.ty.name == held.ty.name) {
            place(context, held, here, open, ordered);
        }
    }
    open.pop();
    ordered.push(item);
}

/// Returns the types that must be declared before a type.
fn held_by<'p>(context: &'p Context<'_>, item: &'p Item<'_>) -> Vec<&'p TypeRef> {
    let mut held: Vec<&TypeRef> = parts(item);
    if let Some((operation, Direction::Request)) = item.body_of()
        && context.package.call(operation).is_some()
        && let Some(messages) = operation.messages()
    {
        held.push(&messages.response.ty);
        let accepted = operation.accepted();
        held.extend(
            accepted
                .into_iter()
                .flat_map(Accepted::state_sets)
                .map(|set| &set.ty),
        );
        held.extend(set_off(context, operation).map(|(_, _, report)| &*report.request.ty));
    }
    held
}
