//! Reads bodies into values with the types of the spec.

use crate::constraint;
use crate::limits::Limits;
use crate::message::Message;
use crate::plan::{FieldPlan, Form, Plan, Read, Shape, TypePlan};
use crate::tree::{About, Key, Leniency, Node, Value};
use fc_runtime::json::{
    self, Allowance, AsNumber, BodyError, BodyErrorKind, Bytes64, FromJson, Quotable,
    ReadLenientBool, ReadLenientNumber, Reader,
};
use fc_spec::model::{
    EnumRepr, EnumType, FloatKind, IntKind, Number, Quirk, Scalar, Variant, WireForm,
};
use std::borrow::Cow;

/// Reads the text of a message. The keys can have any order.
pub(crate) fn message<'m>(
    plan: &Plan<'m>,
    envelope: &[FieldPlan<'m>],
    own: &[FieldPlan<'m>],
    bytes: &[u8],
    limits: &Limits,
) -> Result<Message<'m>, BodyError> {
    let allowance = Allowance {
        depth: limits.json_depth,
        values: limits.json_values,
        ..Allowance::ANY
    };
    // The limits also count the part after an error.
    json::read_object(bytes, allowance, |reader| {
        reader.skip_value()?;
        reader.end()
    })?;
    let reading = |fields, others| {
        json::read_object(bytes, Allowance::ANY, |reader| {
            let reader = reader.clone();
            Reading { plan, reader }.object(fields, others)
        })
    };
    // The envelope stays readable if the body has an error.
    Ok(Message {
        envelope: reading(envelope, None)?,
        body: reading(own, Some(envelope)),
    })
}

/// A value, and the quirk that accepted it.
type Found<'m> = (Value<'m>, Option<Quirk>);

struct Reading<'p, 'm, 't> {
    plan: &'p Plan<'m>,
    /// A reader of text that is valid JSON.
    reader: Reader<'t>,
}

impl<'m> Reading<'_, 'm, '_> {
    /// Reads an object with these fields. Skips other keys, or keeps all except those of the fields in `others`.
    fn object(
        &mut self,
        fields: &[FieldPlan<'m>],
        others: Option<&[FieldPlan<'m>]>,
    ) -> Result<Vec<Node<'m>>, BodyError> {
        self.reader.peek();
        let start = self.reader.clone();
        self.reader.begin_object()?;
        let mut nodes: Vec<Node<'m>> = Vec::new();
        // For each field, `true` if its key was read.
        let mut seen = vec![false; fields.len()];
        while !self.reader.end_object() {
            let key = self.reader.key()?;
            let found = fields.iter().zip(&mut seen).enumerate();
            let mut found = found.filter(|(_, (field, _))| field.is_named(&key));
            if let Some((slot, (field, seen))) = found.next() {
                self.reader.peek();
                if std::mem::replace(seen, true) {
                    let detail = "the key came before; send it once";
                    return Err(self.reader.fault(BodyErrorKind::DuplicateKey, detail));
                }
                nodes.push(self.field(field, slot, key)?);
            } else if let Some(skipped) = others
                && !skipped.iter().any(|field| field.is_named(&key))
            {
                nodes.push(self.unknown(key)?);
            } else {
                self.reader.skip_value()?;
            }
            self.reader.end_value()?;
        }
        for (field, seen) in fields.iter().zip(seen) {
            if !seen && !field.optional {
                let detail = "the key is required; send it";
                let fault = start.fault(BodyErrorKind::MissingField, detail);
                return Err(fault.in_key(field.wire));
            }
        }
        constraint::check(fields, &nodes, &start)?;
        Ok(nodes)
    }

    fn field(
        &mut self,
        field: &FieldPlan<'m>,
        slot: usize,
        key: Cow<'_, str>,
    ) -> Result<Node<'m>, BodyError> {
        let start = self.reader.offset();
        let (value, quirk) = self.optional(field)?;
        let mut lenient: Vec<_> = quirk.map(Leniency::Quirk).into_iter().collect();
        if field.wire != key {
            lenient.push(Leniency::OtherKey);
        }
        Ok(Node {
            key: Key::Name(key.into_owned()),
            about: field.about,
            ty: Some(field.ty.ty),
            span: start..self.reader.offset(),
            value,
            lenient,
            slot,
        })
    }

    fn unknown(&mut self, key: Cow<'_, str>) -> Result<Node<'m>, BodyError> {
        let text = self.reader.value_text()?;
        let end = self.reader.offset();
        Ok(Node {
            key: Key::Name(key.into_owned()),
            about: About::Unknown,
            ty: None,
            span: end - text.len()..end,
            value: Value::Json(text.to_owned()),
            lenient: Vec::new(),
            slot: usize::MAX,
        })
    }

    /// Reads the value of a field, which can be absent.
    fn optional(&mut self, field: &FieldPlan<'m>) -> Result<Found<'m>, BodyError> {
        if field.optional && self.reader.take_null() {
            return Ok((Value::Absent, None));
        }
        if field.form.empty_is_absent && self.reader.take_empty() {
            return Ok((Value::Absent, Some(Quirk::EmptyIsAbsent)));
        }
        self.value(&field.ty, field.form)
    }

    /// Reads the next value as this type.
    fn value(&mut self, ty: &TypePlan<'m>, form: Form) -> Result<Found<'m>, BodyError> {
        let value = match &ty.read {
            Read::Bool => return self.bool(form),
            Read::Int(kind) => {
                let (value, quirk) = self.int(*kind, form)?;
                return Ok((Value::Int(value), quirk));
            }
            Read::Float(FloatKind::F32) => {
                let (value, quirk) = widened(self.number::<f32>(form)?);
                return Ok((Value::Float(value), quirk));
            }
            Read::Float(FloatKind::F64) => {
                let (value, quirk) = self.number(form)?;
                return Ok((Value::Float(value), quirk));
            }
            Read::Text => Value::Text(self.reader.string()?.into_owned()),
            Read::Base64 => Value::Bytes(Bytes64::read(&mut self.reader)?.0),
            Read::Json => Value::Json(self.reader.value_text()?.to_owned()),
            Read::List(item) => Value::List(self.list(item)?),
            Read::Shape(number) => match self.plan.shape(*number) {
                Some(Shape::Struct(fields)) => Value::Object(self.object(fields, Some(&[]))?),
                Some(Shape::Enum(shape)) => self.choice_of_values(shape)?,
                Some(Shape::Choice(variants)) => self.choice_of_objects(variants)?,
                None => Value::Json(self.reader.value_text()?.to_owned()),
            },
        };
        Ok((value, None))
    }

    fn list(&mut self, item: &TypePlan<'m>) -> Result<Vec<Node<'m>>, BodyError> {
        self.reader.begin_array()?;
        let mut nodes = Vec::new();
        if self.reader.end_array() {
            return Ok(nodes);
        }
        loop {
            self.reader.peek();
            let start = self.reader.offset();
            let (value, _) = self.value(item, Form::PLAIN)?;
            nodes.push(Node {
                key: Key::Item(nodes.len()),
                about: About::Item,
                ty: Some(item.ty),
                span: start..self.reader.offset(),
                value,
                lenient: Vec::new(),
                slot: nodes.len(),
            });
            if !self.reader.next_item()? {
                return Ok(nodes);
            }
        }
    }

    /// Reads a value of an enum.
    fn choice_of_values(&mut self, shape: &'m EnumType) -> Result<Value<'m>, BodyError> {
        self.reader.peek();
        let start = self.reader.clone();
        let wire = match shape.repr {
            EnumRepr::Int(kind) => Scalar::Number(Number::Int(self.int(kind, Form::PLAIN)?.0)),
            EnumRepr::String => Scalar::String(self.reader.string()?.into_owned()),
        };
        let named = shape.values.iter().find(|value| value.wire == wire);
        if named.is_none() && shape.closed {
            let detail = "this is none of the values of this field";
            return Err(start.fault(BodyErrorKind::UnknownValue, detail));
        }
        Ok(Value::Enum { wire, named })
    }

    /// Reads an object as the first variant whose required keys are all there.
    fn choice_of_objects(
        &mut self,
        variants: &[(&'m Variant, usize)],
    ) -> Result<Value<'m>, BodyError> {
        self.reader.peek();
        let start = self.reader.clone();
        let mut ahead = start.clone();
        ahead.begin_object()?;
        // For each variant, the fields whose keys were read.
        let mut seen: Vec<Vec<bool>> = variants
            .iter()
            .map(|(_, number)| vec![false; self.plan.fields(*number).len()])
            .collect();
        while !ahead.end_object() {
            let key = ahead.key()?;
            for ((_, number), seen) in variants.iter().zip(&mut seen) {
                let mut fields = self.plan.fields(*number).iter().zip(seen);
                if let Some((_, seen)) = fields.find(|(field, _)| field.is_named(&key)) {
                    *seen = true;
                }
            }
            ahead.skip_value()?;
            ahead.end_value()?;
        }
        let is_whole = |(fields, seen): (&[FieldPlan<'m>], &Vec<bool>)| {
            let mut fields = fields.iter().zip(seen);
            fields.all(|(field, seen)| field.optional || *seen)
        };
        let mut found = variants.iter().zip(&seen);
        let found = found.find(|((_, number), seen)| is_whole((self.plan.fields(*number), *seen)));
        let Some(((variant, number), _)) = found else {
            let detail = "the object has the required keys of no variant";
            return Err(start.fault(BodyErrorKind::NoVariant, detail));
        };
        Ok(Value::OneOf {
            variant,
            keys: self.object(self.plan.fields(*number), Some(&[]))?,
        })
    }

    fn bool(&mut self, form: Form) -> Result<Found<'m>, BodyError> {
        let first = self.reader.peek();
        let value = match (form.lenient, form.wire) {
            (true, _) => bool::read_lenient(&mut self.reader),
            (false, WireForm::Plain) => self.reader.bool(),
            (false, WireForm::String) => bool::read_quoted(&mut self.reader),
            (false, WireForm::Number) => bool::read_number(&mut self.reader),
        }?;
        let found = match first {
            Some(b'"') => WireForm::String,
            Some(b't' | b'f') => WireForm::Plain,
            _ => WireForm::Number,
        };
        let is_canonical = found == form.wire;
        let quirk = (!is_canonical).then_some(Quirk::LenientBool);
        Ok((Value::Bool(value), quirk))
    }

    fn int(&mut self, kind: IntKind, form: Form) -> Result<(i128, Option<Quirk>), BodyError> {
        Ok(match kind {
            IntKind::I8 => widened(self.number::<i8>(form)?),
            IntKind::I16 => widened(self.number::<i16>(form)?),
            IntKind::I32 => widened(self.number::<i32>(form)?),
            IntKind::I64 => widened(self.number::<i64>(form)?),
            IntKind::U8 => widened(self.number::<u8>(form)?),
            IntKind::U16 => widened(self.number::<u16>(form)?),
            IntKind::U32 => widened(self.number::<u32>(form)?),
            IntKind::U64 => widened(self.number::<u64>(form)?),
        })
    }

    /// Reads a number in this form.
    fn number<T: FromJson + Quotable + ReadLenientNumber>(
        &mut self,
        form: Form,
    ) -> Result<(T, Option<Quirk>), BodyError> {
        self.reader.peek();
        let mut sent = self.reader.clone();
        let quoted = form.wire == WireForm::String;
        let value = match form {
            Form { lenient: true, .. } => T::read_lenient(&mut self.reader),
            _ if quoted => T::read_quoted(&mut self.reader),
            _ => T::read(&mut self.reader),
        }?;
        let in_string = sent.peek() == Some(b'"');
        let is_hexadecimal = in_string && sent.string()?.contains(['x', 'X']);
        let is_canonical = in_string == quoted && !is_hexadecimal;
        Ok((value, (!is_canonical).then_some(Quirk::LenientNumber)))
    }
}

fn widened<T: Into<W>, W>((value, quirk): (T, Option<Quirk>)) -> (W, Option<Quirk>) {
    (value.into(), quirk)
}
