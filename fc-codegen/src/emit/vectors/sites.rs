//! Finds the type of each place in a composed value.

use super::edit::Path;
use crate::sample::Samples;
use fc_spec::model::{Field, OneOf, StructRef, StructType, Type, TypeShape, Value};

/// A place in a body, with its description in the spec.
#[derive(Clone, Debug)]
pub(super) struct Site<'m> {
    /// The path of the place.
    pub(super) path: Path,
    /// The type of the value.
    pub(super) ty: &'m Type,
    /// The field. For an item it is the field of the array, because its constraints also apply to the items.
    pub(super) field: &'m Field,
    /// The struct that contains the field.
    pub(super) beside: &'m StructType,
    /// `true` for an item of an array.
    pub(super) is_item: bool,
    /// `true` if the value has the place. An absent optional field is a site too.
    pub(super) present: bool,
    /// `true` if the field belongs to a variant of a one-of. Its absence would select another variant.
    pub(super) in_variant: bool,
}

/// Returns every place of a struct's value, outer before inner. Only the first item of an array is searched.
pub(super) fn sites<'m>(samples: &Samples<'m>, ty: &StructRef, value: &Value) -> Vec<Site<'m>> {
    let mut walk = Walk {
        samples,
        sites: Vec::new(),
    };
    let shape = samples.model().types.structure(ty);
    walk.fields(shape, &Path::default(), value, false);
    walk.sites
}

/// Returns the shape of a named type.
pub(super) fn shape_of<'m>(samples: &Samples<'m>, ty: &Type) -> Option<&'m TypeShape> {
    match ty {
        Type::Named(named) => Some(&samples.model().types.get(named).shape),
        _ => None,
    }
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
        if let Some(variant) = self.samples.variant_of(choice, value) {
            let shape = self.samples.model().types.structure(&variant.ty);
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
                beside: shape,
                is_item: false,
                present: inner.is_some(),
                in_variant,
            });
            if let Some(inner) = inner {
                self.inside((shape, field), &field.ty, &path, inner);
            }
        }
    }

    fn inside(
        &mut self,
        (beside, field): (&'m StructType, &'m Field),
        ty: &'m Type,
        path: &Path,
        value: &Value,
    ) {
        match (ty, value) {
            (Type::Named(named), _) => {
                self.shape(&self.samples.model().types.get(named).shape, path, value);
            }
            (Type::Array(item), Value::Array(items)) => {
                if let Some(first) = items.first() {
                    let path = path.item(0);
                    self.sites.push(Site {
                        path: path.clone(),
                        ty: item,
                        field,
                        beside,
                        is_item: true,
                        present: true,
                        in_variant: false,
                    });
                    self.inside((beside, field), item, &path, first);
                }
            }
            _ => {}
        }
    }
}
