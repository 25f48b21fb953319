//! Reduces a model to the part for one audience, as a complete model.
//!
//! **Architecture invariant.** The products for an audience come from its reduced model. No emitter checks audiences to leave things out.

mod operation;

use super::{
    Answer, Asked, Available, Condition, Constraints, EnumType, Example, Field, FieldDetails,
    Model, OneOf, Operation, RetiredCode, Scalar, StructType, Subject, Text, Type, TypeDef,
    TypeRef, TypeShape, Types, Unlinked, Value, Variant,
};
use crate::{text, text_error};
use std::collections::HashSet;

/// The reason why a projection failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProjectionError {
    /// The spec declares no audience of this name.
    Unknown {
        /// The name.
        name: String,
        /// The declared audiences.
        known: Vec<String>,
    },
    /// A remaining part refers to a removed part. A checked spec has no such reference.
    Unlinked(Unlinked),
}

impl ProjectionError {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Unknown { name, known } if known.is_empty() => text!(
                "没有受众 `{name}`；规范没有声明任何受众",
                "there is no audience `{name}`; the spec declares none"
            ),
            Self::Unknown { name, known } => text!(
                "没有受众 `{name}`；规范声明的受众有：{known}",
                "there is no audience `{name}`; the spec declares {known}",
                known = Text::listed(known.iter().map(|name| format!("`{name}`")))
            ),
            Self::Unlinked(Unlinked { missing, user }) => text!(
                "{user} 用到了 {missing}，而这个受众没有它",
                "{user} names {missing}, which the audience does not have"
            ),
        }
    }
}

text_error!(ProjectionError);

impl Model {
    /// Returns the model for this audience.
    ///
    /// The model lacks the operations, fields, values and variants for other audiences, and everything that only these use. The codes of
    /// removed operations become retired codes, so they stay taken.
    ///
    /// # Errors
    ///
    /// [`ProjectionError`] if the spec does not declare the audience.
    pub fn for_audience(&self, audience: &str) -> Result<Self, ProjectionError> {
        let Some(declared) = self.availability.audience(audience) else {
            let known = self.availability.audiences.iter();
            return Err(ProjectionError::Unknown {
                name: audience.to_owned(),
                known: known.map(|it| it.name.clone()).collect(),
            });
        };
        let view = View {
            audience,
            model: self,
        };
        let mut model = self.clone();
        let has = |operation: &Operation| view.has(operation.available.as_ref());
        model.operations.retain(has);
        let names: HashSet<String> = (model.operations.iter().map(|it| it.name.clone())).collect();
        for operation in &mut model.operations {
            view.operation(operation, &names);
        }
        let others = self.operations.iter().filter(|it| !has(it));
        let taken = others.filter_map(|operation| {
            Some(RetiredCode {
                code: operation.code.value?,
                spelling: operation.code.spelling.clone(),
                text: Text {
                    zh: format!("由不面向“{}”的接口使用", declared.title.zh),
                    en: format!(
                        "Used by an operation that is not for: {}",
                        declared.title.en
                    ),
                },
            })
        });
        model.retired.extend(taken);
        model.retired.sort_by_key(|retired| retired.code);
        for table in &mut model.tables {
            let row = Type::Named(TypeRef::clone(&table.row));
            let rows = table.rows.iter();
            table.rows = rows.filter_map(|value| view.value(value, &row)).collect();
        }
        model.types = view.types(&model);
        for operation in &mut model.operations {
            operation::keep_states(operation, &model.types);
        }
        model.leave_out_unused_types();
        model.link().map_err(ProjectionError::Unlinked)
    }

    /// Removes unused groups, entities, coordinate systems and stores. Removes answers, questions and conflicts about removed things.
    fn leave_out_unused_types(&mut self) {
        self.retain_named();
        let asked: HashSet<String> = ids(&self.answers).collect();
        let (types, operations) = (&self.types, &self.operations);
        let is_here = |subject: &Subject| match subject {
            Subject::Operation(name) => operations.iter().any(|it| it.name == *name),
            Subject::Type(name) => types.named(name).is_some(),
            Subject::Field { owner, key } => types.named(owner).is_some_and(|ty| {
                let shape = ty.shape.structure();
                shape.is_none_or(|shape| shape.field(key).is_some())
            }),
            _ => true,
        };
        self.answers.retain(|it| is_here(&it.subject));
        self.questions.retain(|it| is_here(&it.subject));
        let answered: HashSet<String> = ids(&self.answers).collect();
        let is_for_others = |id: &String| asked.contains(id) && !answered.contains(id);
        self.conflicts.retain(|it| !is_for_others(&it.id));
    }
}

/// Returns the ids of the conflicts that these answers settle.
fn ids(answers: &[Answer]) -> impl Iterator<Item = String> + '_ {
    answers.iter().flat_map(|answer| answer.ids.iter().cloned())
}

/// The view of an audience on a model.
struct View<'m> {
    audience: &'m str,
    /// The whole model.
    model: &'m Model,
}

impl View<'_> {
    /// Returns `true` if the audience has a thing that is available like this.
    fn has(&self, available: Option<&Available>) -> bool {
        available.is_none_or(|it| it.is_for(self.audience))
    }

    /// Returns the remaining types without their parts for other audiences.
    fn types(&self, model: &Model) -> Types {
        let types = self.model.types.iter();
        let types: Vec<TypeDef> = types.map(|ty| self.type_def(ty)).collect();
        let mut used = vec![false; types.len()];
        let bodies = model.operations.iter().flat_map(Operation::bodies);
        let bodies = bodies.map(|body| &*body.ty);
        let rows = model.tables.iter().map(|table| &*table.row);
        let sides = [&model.envelope.request, &model.envelope.response];
        let keys = sides.into_iter().flatten();
        let keys = keys.filter_map(|field| field.ty.innermost());
        let mut open: Vec<usize> = (bodies.chain(rows).chain(keys))
            .map(|ty| ty.id().index())
            .collect();
        while let Some(index) = open.pop() {
            if let (Some(used @ false), Some(ty)) = (used.get_mut(index), types.get(index)) {
                *used = true;
                open.extend(references(&ty.shape).map(|ty| ty.id().index()));
            }
        }
        let mut used = used.into_iter();
        let types = types.into_iter().filter(|_| used.next() == Some(true));
        Types::new(types.collect())
    }

    fn type_def(&self, ty: &TypeDef) -> TypeDef {
        let shape = match &ty.shape {
            TypeShape::Struct(shape) => TypeShape::Struct(StructType {
                fields: self.fields(shape).collect(),
                ..shape.clone()
            }),
            TypeShape::Enum(shape) => TypeShape::Enum(self.enumeration(shape)),
            TypeShape::OneOf(choice) => TypeShape::OneOf(OneOf {
                variants: self.variants(choice).cloned().collect(),
            }),
        };
        TypeDef {
            shape,
            ..ty.clone()
        }
    }

    fn fields(&self, shape: &StructType) -> impl Iterator<Item = Field> {
        let fields = shape.fields.iter();
        let fields = fields.filter(|field| self.has_field(shape, field));
        fields.map(|field| self.field(shape, field))
    }

    fn has_field(&self, shape: &StructType, field: &Field) -> bool {
        let is_there = !matches!(self.condition(shape, field), Left::Never if field.optional);
        is_there && self.has(field.details().available.as_ref())
    }

    /// Returns the condition of a field without the values for other audiences.
    fn condition(&self, shape: &StructType, field: &Field) -> Left {
        let Some(condition) = &field.details().condition else {
            return Left::Always;
        };
        let asked = condition.asked().iter().map(|asked| {
            let ty = shape.field(&asked.wire).map(|field| &field.ty);
            let known = asked
                .values
                .iter()
                .filter(|value| ty.is_none_or(|ty| self.value(&Value::from(*value), ty).is_some()));
            Asked {
                wire: asked.wire.clone(),
                values: known.cloned().collect(),
            }
        });
        let asked: Vec<Asked> = asked.collect();
        let holds_at_times = asked.iter().all(|asked| !asked.values.is_empty());
        match condition {
            Condition::When(_) if holds_at_times => Left::Some(Condition::When(asked)),
            Condition::When(_) => Left::Never,
            Condition::Unless(_) if holds_at_times => Left::Some(Condition::Unless(asked)),
            Condition::Unless(_) => Left::Always,
        }
    }

    /// Returns the field with only the values of this audience in its details and its example.
    fn field(&self, shape: &StructType, field: &Field) -> Field {
        let knows = |scalar: &Scalar| self.value(&Value::from(scalar), &field.ty).is_some();
        let example = match &field.example {
            Example::Given(value) => {
                let value = self.value(value, &field.ty);
                value.map_or(Example::Derived, Example::Given)
            }
            other => other.clone(),
        };
        let details = field.details.as_deref().map(|details| {
            let only = details.constraints.only.iter().filter(|value| knows(value));
            Box::new(FieldDetails {
                constraints: Constraints {
                    only: only.cloned().collect(),
                    ..details.constraints.clone()
                },
                default: details.default.clone().filter(knows),
                condition: match self.condition(shape, field) {
                    Left::Some(condition) => Some(condition),
                    Left::Always | Left::Never => None,
                },
                ..details.clone()
            })
        });
        Field {
            example,
            details,
            ..field.clone()
        }
    }

    fn enumeration(&self, shape: &EnumType) -> EnumType {
        let values = shape.values.iter();
        let values = values.filter(|value| self.has(value.available.as_ref()));
        let mut values: Vec<_> = values.cloned().collect();
        let names: HashSet<String> = values.iter().map(|value| value.name.clone()).collect();
        for value in &mut values {
            value.then.retain(|next| names.contains(next));
        }
        let leads = values.iter().any(|value| !value.then.is_empty());
        EnumType {
            order: shape.order.filter(|_| leads),
            values,
            ..*shape
        }
    }

    fn variants<'c>(&self, choice: &'c OneOf) -> impl Iterator<Item = &'c Variant> {
        let variants = choice.variants.iter();
        variants.filter(|variant| self.has(variant.available.as_ref()))
    }

    /// Returns a value without the keys for other audiences. `None` if a required part of it is for other audiences.
    fn value(&self, value: &Value, ty: &Type) -> Option<Value> {
        match (ty, value) {
            (Type::Array(item), Value::Array(items)) => {
                let items = items.iter().map(|value| self.value(value, item));
                items.collect::<Option<Vec<Value>>>().map(Value::Array)
            }
            (Type::Named(named), _) => self.named(value, self.model.types.get(named)),
            _ => Some(value.clone()),
        }
    }

    fn named(&self, value: &Value, ty: &TypeDef) -> Option<Value> {
        match &ty.shape {
            TypeShape::Enum(shape) => {
                let mut values = shape.values.iter();
                let known = values.find(|known| Value::from(&known.wire) == *value);
                let available = known.and_then(|known| known.available.as_ref());
                self.has(available).then(|| value.clone())
            }
            TypeShape::Struct(shape) => self.object(value, shape),
            TypeShape::OneOf(choice) => {
                let taken = choice.variants.iter().find(|variant| {
                    let fields = &self.model.types.structure(&variant.ty).fields;
                    let mut required = fields.iter().filter(|field| !field.optional);
                    required.all(|field| value.get(&field.wire).is_some())
                })?;
                let is_here = self.variants(choice).any(|it| it.name == taken.name);
                let shape = self.model.types.structure(&taken.ty);
                is_here.then(|| self.object(value, shape))?
            }
        }
    }

    fn object(&self, value: &Value, shape: &StructType) -> Option<Value> {
        let Value::Object(entries) = value else {
            return Some(value.clone());
        };
        let mut kept = Vec::new();
        for (key, value) in entries {
            match shape.fields.iter().find(|field| field.wire == *key) {
                Some(field) if !self.has_field(shape, field) => {}
                Some(field) => kept.push((key.clone(), self.value(value, &field.ty)?)),
                None => kept.push((key.clone(), value.clone())),
            }
        }
        Some(Value::Object(kept))
    }
}

/// A condition for one audience.
enum Left {
    Some(Condition),
    /// The condition always holds.
    Always,
    /// The condition never holds, because all values of one of its fields are for other audiences.
    Never,
}

/// Returns the types that a type refers to.
fn references(shape: &TypeShape) -> impl Iterator<Item = &TypeRef> {
    let (fields, variants): (&[Field], &[Variant]) = match shape {
        TypeShape::Struct(shape) => (&shape.fields, &[]),
        TypeShape::OneOf(choice) => (&[], &choice.variants),
        TypeShape::Enum(_) => (&[], &[]),
    };
    let fields = fields.iter().filter_map(|field| field.ty.innermost());
    fields.chain(variants.iter().map(|variant| &*variant.ty))
}
