//! Which type each place of a composed value has.

use super::{Path, Samples};
use fc_spec::model::{Field, OneOf, StructType, Type, TypeShape, Value};

/// A place in a body at which the spec says what may stand.
#[derive(Clone, Debug)]
pub struct Site<'m> {
    /// Where.
    pub path: Path,
    /// What may stand there.
    pub ty: &'m Type,
    /// The field, or that of the array around an item: its constraints hold for its items too.
    pub field: &'m Field,
    /// Whether this is an item of an array.
    pub is_item: bool,
    /// Whether the value has something there; an absent optional field is a site too.
    pub present: bool,
    /// Whether the field belongs to a variant of a one-of, so that its absence chooses another.
    pub in_variant: bool,
}

/// Every place of a value of a named struct, outer before inner. Of an array's items only the first
/// is looked into.
#[must_use]
pub fn sites<'m>(samples: &Samples<'m>, type_name: &str, value: &Value) -> Vec<Site<'m>> {
    let mut walk = Walk {
        samples,
        sites: Vec::new(),
    };
    if let Some(ty) = samples.type_named(type_name) {
        walk.shape(&ty.shape, &Path::default(), value);
    }
    walk.sites
}

struct Walk<'a, 'm> {
    samples: &'a Samples<'m>,
    sites: Vec<Site<'m>>,
}

impl<'m> Walk<'_, 'm> {
    fn shape(&mut self, shape: &'m TypeShape, path: &Path, value: &Value) {
        match shape {
            TypeShape::Struct(shape) => self.fields(shape, path, value, false),
            TypeShape::OneOf(choice) => self.choice(choice, path, value),
            TypeShape::Enum(_) => {}
        }
    }

    fn choice(&mut self, choice: &'m OneOf, path: &Path, value: &Value) {
        if let Some(shape) = self.samples.variant_of(choice, value) {
            self.fields(shape, path, value, true);
        }
    }

    fn fields(&mut self, shape: &'m StructType, path: &Path, value: &Value, in_variant: bool) {
        for field in &shape.fields {
            let path = path.key(&field.wire);
            let inner = value.get(&field.wire);
            self.sites.push(Site {
                path: path.clone(),
                ty: &field.ty,
                field,
                is_item: false,
                present: inner.is_some(),
                in_variant,
            });
            if let Some(inner) = inner {
                self.inside(field, &field.ty, &path, inner);
            }
        }
    }

    fn inside(&mut self, field: &'m Field, ty: &'m Type, path: &Path, value: &Value) {
        match (ty, value) {
            (Type::Named(name), _) => {
                if let Some(ty) = self.samples.type_named(name) {
                    self.shape(&ty.shape, path, value);
                }
            }
            (Type::Array(item), Value::Array(items)) => {
                if let Some(first) = items.first() {
                    let path = path.item(0);
                    self.sites.push(Site {
                        path: path.clone(),
                        ty: item,
                        field,
                        is_item: true,
                        present: true,
                        in_variant: false,
                    });
                    self.inside(field, item, &path, first);
                }
            }
            _ => {}
        }
    }
}
