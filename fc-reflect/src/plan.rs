//! Prepares a model for reading and writing.
//!
//! **Architecture invariant.** Only this module looks up names and roles in the model. The other modules use its
//! results, so reading a value never looks up a name of the spec.

use crate::tree::About;
use fc_spec::model::{
    self, ByteOrder, Constraints, Direction, EnumType, FloatKind, FrameKind, IntKind, Model,
    Operation, Quirk, Type, TypeDef, TypeShape, Variant, WireForm,
};
use std::collections::HashMap;

/// A prepared model.
pub(crate) struct Plan<'m> {
    pub(crate) frame: FramePlan<'m>,
    /// The envelope keys of requests.
    request: Vec<FieldPlan<'m>>,
    /// The envelope keys of responses and acknowledgements.
    response: Vec<FieldPlan<'m>>,
    shapes: Vec<Shape<'m>>,
    operations: Vec<OperationPlan<'m>>,
    by_code: HashMap<(u8, u16), usize>,
    by_name: HashMap<&'m str, usize>,
}

/// The layout of a frame.
pub(crate) struct FramePlan<'m> {
    pub(crate) layout: &'m model::Frame,
    pub(crate) header_len: usize,
    pub(crate) big_endian: bool,
}

/// An operation with its bodies.
pub(crate) struct OperationPlan<'m> {
    pub(crate) operation: &'m Operation,
    kind: u8,
    request: Option<usize>,
    response: Option<usize>,
}

/// A key of an object or of the envelope.
pub(crate) struct FieldPlan<'m> {
    pub(crate) wire: &'m str,
    also: &'m [String],
    pub(crate) about: About<'m>,
    pub(crate) ty: TypePlan<'m>,
    pub(crate) optional: bool,
    pub(crate) form: Form,
    /// The constraints that a value must satisfy.
    pub(crate) constraints: Option<&'m Constraints>,
}

/// The form of a value in messages, and the other forms that a reader accepts.
#[derive(Clone, Copy)]
pub(crate) struct Form {
    pub(crate) wire: WireForm,
    pub(crate) empty_is_absent: bool,
    /// `true` if the quirk `lenient_number` or `lenient_bool` accepts other forms.
    pub(crate) lenient: bool,
}

impl Form {
    /// Only the form of the type.
    pub(crate) const PLAIN: Self = Self {
        wire: WireForm::Plain,
        empty_is_absent: false,
        lenient: false,
    };
}

/// A type of the spec, and the way to read its values.
pub(crate) struct TypePlan<'m> {
    pub(crate) ty: &'m Type,
    pub(crate) read: Read<'m>,
}

/// The way to read a value.
pub(crate) enum Read<'m> {
    Bool,
    Int(IntKind),
    Float(FloatKind),
    Text,
    Base64,
    Json,
    List(Box<TypePlan<'m>>),
    /// The shape with this index.
    Shape(usize),
}

/// A named type.
pub(crate) enum Shape<'m> {
    Struct(Vec<FieldPlan<'m>>),
    Enum(&'m EnumType),
    /// The variants, each with the index of its struct.
    Choice(Vec<(&'m Variant, usize)>),
}

impl<'m> Plan<'m> {
    pub(crate) fn new(model: &'m Model) -> Self {
        let shapes = model.types.iter().map(shape).collect();
        let operations: Vec<_> = model
            .operations
            .iter()
            .map(|operation| OperationPlan {
                operation,
                kind: model.frame.kinds.of(operation.kind()).value,
                request: struct_of(operation, Direction::Request),
                response: struct_of(operation, Direction::Response),
            })
            .collect();
        let numbered = || operations.iter().zip(0..);
        let by_code = numbered().filter_map(|(plan, number)| Some((plan.place()?, number)));
        let by_name = numbered().map(|(plan, number)| (plan.operation.name.as_str(), number));
        Self {
            frame: FramePlan::new(&model.frame),
            request: envelope(&model.envelope.request),
            response: envelope(&model.envelope.response),
            shapes,
            by_code: by_code.collect(),
            by_name: by_name.collect(),
            operations,
        }
    }

    /// Returns the envelope keys of a request or a response.
    pub(crate) fn envelope(&self, response: bool) -> &[FieldPlan<'m>] {
        if response {
            &self.response
        } else {
            &self.request
        }
    }

    /// Returns the operation with this kind and code.
    pub(crate) fn with_code(&self, kind: u8, code: u16) -> Option<&OperationPlan<'m>> {
        self.operations.get(*self.by_code.get(&(kind, code))?)
    }

    /// Returns the operation with this name.
    pub(crate) fn named(&self, name: &str) -> Option<&OperationPlan<'m>> {
        self.operations.get(*self.by_name.get(name)?)
    }

    /// Returns the keys of one side of an operation, without the envelope. Returns none for raw bytes.
    pub(crate) fn body(&self, operation: &OperationPlan<'m>, response: bool) -> &[FieldPlan<'m>] {
        let number = if response {
            operation.response
        } else {
            operation.request
        };
        number.map_or(&[], |number| self.fields(number))
    }

    /// Returns the fields of the struct with this index.
    pub(crate) fn fields(&self, number: usize) -> &[FieldPlan<'m>] {
        match self.shapes.get(number) {
            Some(Shape::Struct(fields)) => fields,
            _ => &[],
        }
    }

    /// Returns the shape with this index.
    pub(crate) fn shape(&self, number: usize) -> Option<&Shape<'m>> {
        self.shapes.get(number)
    }
}

impl OperationPlan<'_> {
    /// Returns the kind and the code in the header, or `None` while the operation has no code.
    pub(crate) fn place(&self) -> Option<(u8, u16)> {
        Some((self.kind, self.operation.code.value?))
    }
}

impl<'m> FramePlan<'m> {
    fn new(layout: &'m model::Frame) -> Self {
        Self {
            layout,
            header_len: layout.header_len(),
            big_endian: layout.byte_order == ByteOrder::Big,
        }
    }

    /// Returns the kind with this value.
    pub(crate) fn kind(&self, value: u8) -> Option<&'m FrameKind> {
        self.layout.kinds.with_value(value)
    }

    /// Returns `true` if frames of this kind belong to streams.
    pub(crate) fn is_stream(&self, kind: u8) -> bool {
        self.layout.kinds.stream.value == kind
    }
}

impl FieldPlan<'_> {
    /// Returns `true` if the field has this key, or accepts it as another key.
    pub(crate) fn is_named(&self, key: &str) -> bool {
        self.wire == key || self.also.iter().any(|other| other == key)
    }
}

/// Returns the index of the struct of one side, or `None` for raw bytes.
fn struct_of(operation: &Operation, direction: Direction) -> Option<usize> {
    Some(operation.body(direction)?.ty.id().index())
}

fn envelope<'m>(fields: &'m [model::EnvelopeField]) -> Vec<FieldPlan<'m>> {
    let plan = |field: &'m model::EnvelopeField| FieldPlan {
        wire: &field.wire,
        also: &[],
        about: About::Envelope(field),
        ty: type_plan(&field.ty),
        optional: field.optional,
        form: Form::PLAIN,
        constraints: None,
    };
    fields.iter().map(plan).collect()
}

fn shape(ty: &TypeDef) -> Shape<'_> {
    match &ty.shape {
        TypeShape::Struct(shape) => Shape::Struct(shape.fields.iter().map(own).collect()),
        TypeShape::Enum(shape) => Shape::Enum(shape),
        TypeShape::OneOf(shape) => {
            let variants = shape.variants.iter();
            let variants = variants.map(|variant| (variant, variant.ty.id().index()));
            Shape::Choice(variants.collect())
        }
    }
}

fn own(field: &model::Field) -> FieldPlan<'_> {
    let details = field.details();
    let mut form = Form {
        wire: field.wire_form,
        ..Form::PLAIN
    };
    for quirk in &details.quirks {
        match quirk {
            Quirk::EmptyIsAbsent => form.empty_is_absent = true,
            Quirk::LenientNumber | Quirk::LenientBool => form.lenient = true,
        }
    }
    FieldPlan {
        wire: &field.wire,
        also: &details.also,
        about: About::Field(field),
        ty: type_plan(&field.ty),
        optional: field.optional,
        form,
        constraints: Some(&details.constraints),
    }
}

fn type_plan(ty: &Type) -> TypePlan<'_> {
    let read = match ty {
        Type::Bool => Read::Bool,
        Type::Int(kind) => Read::Int(*kind),
        Type::TimestampMs | Type::TimestampS => Read::Int(IntKind::I64),
        Type::Float(kind) => Read::Float(*kind),
        Type::String => Read::Text,
        Type::Base64 => Read::Base64,
        Type::Json => Read::Json,
        Type::Array(item) => Read::List(Box::new(type_plan(item))),
        Type::Named(named) => Read::Shape(named.id().index()),
    };
    TypePlan { ty, read }
}
