//! The types inside the types of a package.

use super::items::{Item, Shape};
use fc_spec::model::{Type, TypeRef};

/// Returns the named types of the fields of a struct, or of the variants of a one-of.
pub fn parts<'m>(item: &Item<'m>) -> Vec<&'m TypeRef> {
    match &item.shape {
        Shape::Record(_, fields) => {
            let fields = fields.iter();
            fields.filter_map(|it| it.of.ty.innermost()).collect()
        }
        Shape::Choice(_, variants) => variants.iter().map(|it| &*it.of.ty).collect(),
        Shape::Enum(..) => Vec::new(),
    }
}

/// Returns `item` in as many lists as `ty` has. `list` spells a list of an item.
pub fn in_lists(ty: &Type, item: &str, list: fn(&str) -> String) -> String {
    match ty {
        Type::Array(inner) => in_lists(inner, &list(item), list),
        _ => item.to_owned(),
    }
}
