//! What reading and writing need to know of a model, looked up once.
//!
//! **Architecture invariant.** This is the one module that asks the model what its names and roles refer to; all others
//! go by what stands here. After it no name of the spec is looked up, however many values are read.

use crate::tree::About;
use fc_spec::model::{
    self, ByteOrder, EncodingRole, EnumRepr, EnumType, FloatKind, FrameKind, HeaderField,
    HeaderRole, Kind, KindRole, Model, Number, Operation, Quirk, Type, TypeDef, TypeShape, Variant,
    WireForm,
};
use regex_lite::Regex;
use std::collections::HashMap;

/// A model, prepared.
pub(crate) struct Plan<'m> {
    pub(crate) frame: FramePlan<'m>,
    /// Keys of the envelope of requests.
    request: Vec<FieldPlan<'m>>,
    /// Keys of the envelope of responses and acknowledgements.
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
    plain: Option<u8>,
    gzip: Option<u8>,
}

/// How the data of a frame is packed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Packed {
    Plain,
    Gzip,
}

/// An operation with its bodies.
pub(crate) struct OperationPlan<'m> {
    pub(crate) operation: &'m Operation,
    kind: Option<u8>,
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
    pub(crate) limits: Constraints<'m>,
}

/// How a value travels, and what else is taken for it.
#[derive(Clone, Copy, Default)]
pub(crate) struct Form {
    pub(crate) quoted: bool,
    pub(crate) empty_is_absent: bool,
    /// Whether the other spellings of its type are taken: `lenient_number`, `lenient_bool`.
    pub(crate) lenient: bool,
}

/// What a value must satisfy beyond its type.
#[derive(Default)]
pub(crate) struct Constraints<'m> {
    pub(crate) min: Option<&'m Number>,
    pub(crate) max: Option<&'m Number>,
    pub(crate) length: Option<(u64, u64)>,
    pub(crate) pattern: Option<Pattern<'m>>,
}

/// A regular expression that a string matches as a whole.
pub(crate) struct Pattern<'m> {
    pub(crate) source: &'m str,
    regex: Option<Regex>,
}

impl Pattern<'_> {
    /// One that is not a regular expression matches nothing; a checked model has none.
    pub(crate) fn matches(&self, text: &str) -> bool {
        self.regex
            .as_ref()
            .is_some_and(|regex| regex.is_match(text))
    }
}

/// A type of the spec, and what a value of it is read as.
pub(crate) struct TypePlan<'m> {
    pub(crate) ty: &'m Type,
    pub(crate) read: Read<'m>,
}

/// What a value is read as.
pub(crate) enum Read<'m> {
    Bool,
    /// The smallest and largest value.
    Int(i128, i128),
    Float(FloatKind),
    Text,
    Base64,
    Json,
    List(Box<TypePlan<'m>>),
    /// The shape of this number.
    Shape(usize),
}

/// A named type.
pub(crate) enum Shape<'m> {
    Struct(Vec<FieldPlan<'m>>),
    Enum(&'m EnumType),
    /// Each with the number of its struct.
    Choice(Vec<(&'m Variant, usize)>),
}

impl<'m> Plan<'m> {
    pub(crate) fn new(model: &'m Model) -> Self {
        let numbers: HashMap<&str, usize> = model
            .types
            .iter()
            .enumerate()
            .map(|(number, ty)| (ty.name.as_str(), number))
            .collect();
        let named = |name: &str| numbers.get(name).copied();
        let shapes = model.types.iter().map(|ty| shape(ty, &named)).collect();
        let operations: Vec<_> = model
            .operations
            .iter()
            .map(|operation| OperationPlan {
                operation,
                kind: model
                    .frame
                    .kind(role_of(operation.kind))
                    .map(|kind| kind.value),
                request: operation.request.ty.as_deref().and_then(named),
                response: operation.response.ty.as_deref().and_then(named),
            })
            .collect();
        let by_code = operations
            .iter()
            .enumerate()
            .filter_map(|(number, plan)| Some(((plan.kind?, plan.operation.code.value?), number)));
        let by_name = operations
            .iter()
            .enumerate()
            .map(|(number, plan)| (plan.operation.name.as_str(), number));
        Self {
            frame: FramePlan::new(&model.frame),
            request: envelope(&model.envelope.request, &named),
            response: envelope(&model.envelope.response, &named),
            shapes,
            by_code: by_code.collect(),
            by_name: by_name.collect(),
            operations,
        }
    }

    /// The keys of the envelope of a request or a response.
    pub(crate) fn envelope(&self, response: bool) -> &[FieldPlan<'m>] {
        if response {
            &self.response
        } else {
            &self.request
        }
    }

    /// The operation with this code among those of a kind.
    pub(crate) fn with_code(&self, kind: u8, code: u16) -> Option<&OperationPlan<'m>> {
        self.operations.get(*self.by_code.get(&(kind, code))?)
    }

    /// The operation of this name.
    pub(crate) fn named(&self, name: &str) -> Option<&OperationPlan<'m>> {
        self.operations.get(*self.by_name.get(name)?)
    }

    /// The own keys of one side of an operation; none of a stream.
    pub(crate) fn body(&self, operation: &OperationPlan<'m>, response: bool) -> &[FieldPlan<'m>] {
        let number = if response {
            operation.response
        } else {
            operation.request
        };
        number.map_or(&[], |number| self.fields(number))
    }

    /// The fields of the struct of this number.
    pub(crate) fn fields(&self, number: usize) -> &[FieldPlan<'m>] {
        match self.shapes.get(number) {
            Some(Shape::Struct(fields)) => fields,
            _ => &[],
        }
    }

    /// The shape of this number.
    pub(crate) fn shape(&self, number: usize) -> Option<&Shape<'m>> {
        self.shapes.get(number)
    }
}

impl OperationPlan<'_> {
    /// Kind and code in the header; `None` while it has no code.
    pub(crate) fn place(&self) -> Option<(u8, u16)> {
        Some((self.kind?, self.operation.code.value?))
    }
}

impl<'m> FramePlan<'m> {
    fn new(layout: &'m model::Frame) -> Self {
        let value = |role| layout.encoding(role).map(|encoding| encoding.value);
        Self {
            layout,
            header_len: layout.header_len(),
            big_endian: layout.byte_order == ByteOrder::Big,
            plain: value(EncodingRole::Plain),
            gzip: value(EncodingRole::Gzip),
        }
    }

    /// The header field with this role.
    pub(crate) fn field(&self, role: HeaderRole) -> Option<&'m HeaderField> {
        self.layout
            .header
            .iter()
            .find(|field| field.role == Some(role))
    }

    /// The kind with this value.
    pub(crate) fn kind(&self, value: u8) -> Option<&'m FrameKind> {
        self.layout.kinds.iter().find(|kind| kind.value == value)
    }

    /// Whether frames of this kind carry raw bytes.
    pub(crate) fn is_stream(&self, kind: u8) -> bool {
        let kind = self.kind(kind);
        kind.is_some_and(|kind| kind.role == KindRole::Stream)
    }

    /// How data is packed under this value of the encoding field.
    pub(crate) fn packed(&self, encoding: u8) -> Option<Packed> {
        if self.plain == Some(encoding) {
            Some(Packed::Plain)
        } else if self.gzip == Some(encoding) {
            Some(Packed::Gzip)
        } else {
            None
        }
    }

    /// The value of the encoding field for data that is packed so.
    pub(crate) fn encoding(&self, packed: Packed) -> Option<u8> {
        match packed {
            Packed::Plain => self.plain,
            Packed::Gzip => self.gzip,
        }
    }
}

impl FieldPlan<'_> {
    /// Whether this is the field of a key.
    pub(crate) fn is_named(&self, key: &str) -> bool {
        self.wire == key || self.also.iter().any(|other| other == key)
    }
}

fn role_of(kind: Kind) -> KindRole {
    match kind {
        Kind::Command => KindRole::Command,
        Kind::Report => KindRole::Report,
        Kind::Stream => KindRole::Stream,
    }
}

fn envelope<'m>(
    fields: &'m [model::EnvelopeField],
    named: &impl Fn(&str) -> Option<usize>,
) -> Vec<FieldPlan<'m>> {
    let plan = |field: &'m model::EnvelopeField| FieldPlan {
        wire: &field.wire,
        also: &[],
        about: About::Envelope(field),
        ty: type_plan(&field.ty, named),
        optional: field.optional,
        form: Form::default(),
        limits: Constraints::default(),
    };
    fields.iter().map(plan).collect()
}

fn shape<'m>(ty: &'m TypeDef, named: &impl Fn(&str) -> Option<usize>) -> Shape<'m> {
    match &ty.shape {
        TypeShape::Struct(shape) => {
            Shape::Struct(shape.fields.iter().map(|field| own(field, named)).collect())
        }
        TypeShape::Enum(shape) => Shape::Enum(shape),
        TypeShape::OneOf(shape) => {
            let variants = shape.variants.iter();
            let known = variants.filter_map(|variant| Some((variant, named(&variant.ty)?)));
            Shape::Choice(known.collect())
        }
    }
}

fn own<'m>(field: &'m model::Field, named: &impl Fn(&str) -> Option<usize>) -> FieldPlan<'m> {
    let details = field.details();
    let has = |quirk| details.quirks.contains(&quirk);
    FieldPlan {
        wire: &field.wire,
        also: &details.also,
        about: About::Field(field),
        ty: type_plan(&field.ty, named),
        optional: field.optional,
        form: Form {
            quoted: field.wire_form == WireForm::String,
            empty_is_absent: has(Quirk::EmptyIsAbsent),
            lenient: has(Quirk::LenientNumber) || has(Quirk::LenientBool),
        },
        limits: Constraints {
            min: details.min.as_ref(),
            max: details.max.as_ref(),
            length: details.length,
            pattern: details.pattern.as_deref().map(|source| Pattern {
                source,
                regex: Regex::new(&format!("^(?:{source})$")).ok(),
            }),
        },
    }
}

fn type_plan<'m>(ty: &'m Type, named: &impl Fn(&str) -> Option<usize>) -> TypePlan<'m> {
    let read = match ty {
        Type::Bool => Read::Bool,
        Type::Int(kind) => {
            let (least, most) = kind.range();
            Read::Int(least, most)
        }
        Type::TimestampMs | Type::TimestampS => Read::Int(i64::MIN.into(), i64::MAX.into()),
        Type::Float(kind) => Read::Float(*kind),
        Type::String => Read::Text,
        Type::Base64 => Read::Base64,
        Type::Json => Read::Json,
        Type::Array(item) => Read::List(Box::new(type_plan(item, named))),
        // A loaded model has every type that it names.
        Type::Named(name) => named(name).map_or(Read::Json, Read::Shape),
    };
    TypePlan { ty, read }
}

/// The smallest and largest number of an enum of integers; `None` of one of strings.
pub(crate) fn enum_range(shape: &EnumType) -> Option<(i128, i128)> {
    match shape.repr {
        EnumRepr::Int(kind) => Some(kind.range()),
        EnumRepr::String => None,
    }
}
