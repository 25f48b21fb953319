//! Bodies, read as the types of the spec want them.

use crate::error::{BodyError, BodyFault};
use crate::json::{self, Integral, Reader};
use crate::plan::{FieldPlan, Form, Plan, Read, Shape, TypePlan, enum_range};
use crate::tree::{About, Key, Leniency, Node, Value};
use crate::{Limits, Message, constraint};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_spec::model::{EnumType, FloatKind, Number, Quirk, Scalar, Variant};
use std::borrow::Cow;
use std::num::IntErrorKind;

/// Reads the text of a message: the keys of an envelope, own keys and unknown ones in any order.
pub(crate) fn message<'m>(
    plan: &Plan<'m>,
    envelope: &[FieldPlan<'m>],
    own: &[FieldPlan<'m>],
    bytes: &[u8],
    limits: &Limits,
) -> Result<Message<'m>, BodyError> {
    let text = body_text(bytes)?;
    let placed = |error| placed(text, error);
    json::check(text, limits.json_depth, limits.json_values).map_err(placed)?;
    Reader::checked(text).expect_object().map_err(placed)?;
    let reading = |keys| {
        let mut reading = Reading {
            plan,
            reader: Reader::checked(text),
        };
        reading.object(keys).map_err(placed)
    };
    // A body that is at fault must not cost the envelope.
    Ok(Message {
        envelope: reading(Keys {
            fields: envelope,
            others: Others::Skipped,
        })?,
        body: reading(Keys {
            fields: own,
            others: Others::KeptBut(envelope),
        }),
    })
}

fn body_text(bytes: &[u8]) -> Result<&str, BodyError> {
    if bytes.is_empty() {
        return Ok("{}");
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let valid = error.valid_up_to();
        BodyError::new(BodyFault::NotUtf8, valid, "a body is UTF-8 text")
    })
}

/// Puts the path known from the text before that known from the type.
fn placed(text: &str, mut error: BodyError) -> BodyError {
    let mut path = json::path(text, error.offset);
    if !path.is_empty() && !error.path.is_empty() {
        path.push('.');
    }
    path.push_str(&error.path);
    error.path = path;
    error
}

impl Reader<'_> {
    /// A body that is another JSON value than an object has an error of its own.
    fn expect_object(&mut self) -> Result<(), BodyError> {
        if self.peek() == Some(b'{') {
            return Ok(());
        }
        Err(BodyError {
            fault: BodyFault::NotAnObject,
            ..self.unexpected("an object")
        })
    }
}

/// The keys that are read of an object.
#[derive(Clone, Copy)]
struct Keys<'p, 'm> {
    fields: &'p [FieldPlan<'m>],
    others: Others<'p, 'm>,
}

/// What becomes of the other keys.
#[derive(Clone, Copy)]
enum Others<'p, 'm> {
    Skipped,
    /// They are kept, but for those of these fields.
    KeptBut(&'p [FieldPlan<'m>]),
}

/// A value, and where the reader has been lenient to get it.
type Found<'m> = (Value<'m>, Option<Quirk>);

struct Reading<'p, 'm, 't> {
    plan: &'p Plan<'m>,
    /// In a text that is known to be JSON.
    reader: Reader<'t>,
}

impl<'m, 't> Reading<'_, 'm, 't> {
    /// Reads an object with these keys.
    fn object(&mut self, keys: Keys<'_, 'm>) -> Result<Vec<Node<'m>>, BodyError> {
        self.reader.peek();
        let start = self.reader.at();
        self.reader.begin_object()?;
        let mut nodes: Vec<Node<'m>> = Vec::new();
        // One for each field: whether its key has come.
        let mut seen = vec![false; keys.fields.len()];
        while !self.reader.end_object() {
            let key = self.reader.key()?;
            let found = keys.fields.iter().zip(&mut seen).enumerate();
            let mut found = found.filter(|(_, (field, _))| field.is_named(&key));
            if let Some((slot, (field, seen))) = found.next() {
                self.reader.peek();
                if std::mem::replace(seen, true) {
                    let detail = "the key came before; send it once";
                    let at = self.reader.at();
                    return Err(BodyError::new(BodyFault::DuplicateKey, at, detail));
                }
                nodes.push(self.field(field, slot, key)?);
            } else if let Others::KeptBut(skipped) = keys.others
                && !skipped.iter().any(|field| field.is_named(&key))
            {
                nodes.push(self.unknown(key)?);
            } else {
                self.reader.skip_value()?;
            }
            self.reader.end_value()?;
        }
        for (field, seen) in keys.fields.iter().zip(seen) {
            if !seen && !field.optional {
                let detail = "the key is required; send it";
                let fault = BodyFault::MissingField;
                return Err(BodyError::of_key(fault, start, field.wire, detail));
            }
        }
        constraint::check(keys.fields, &nodes, start)?;
        Ok(nodes)
    }

    fn field(
        &mut self,
        field: &FieldPlan<'m>,
        slot: usize,
        key: Cow<'_, str>,
    ) -> Result<Node<'m>, BodyError> {
        let start = self.reader.at();
        let (value, quirk) = self.optional(field)?;
        let mut lenient: Vec<_> = quirk.map(Leniency::Quirk).into_iter().collect();
        if field.wire != key {
            lenient.push(Leniency::OtherKey);
        }
        Ok(Node {
            key: Key::Name(key.into_owned()),
            about: field.about,
            ty: Some(field.ty.ty),
            span: start..self.reader.at(),
            value,
            lenient,
            slot,
        })
    }

    fn unknown(&mut self, key: Cow<'_, str>) -> Result<Node<'m>, BodyError> {
        let text = self.reader.value_text()?;
        let end = self.reader.at();
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

    /// Reads the value of a field, which may be absent.
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
            Read::Int(least, most) => return self.int((*least, *most), form),
            Read::Float(kind) => return self.float(*kind, form),
            Read::Text => Value::Text(self.reader.string()?.into_owned()),
            Read::Base64 => Value::Bytes(self.base64()?),
            Read::Json => Value::Json(self.reader.value_text()?.to_owned()),
            Read::List(item) => Value::List(self.list(item)?),
            Read::Shape(number) => match self.plan.shape(*number) {
                Some(Shape::Struct(fields)) => Value::Object(self.own_object(fields)?),
                Some(Shape::Enum(shape)) => self.choice_of_values(shape)?,
                Some(Shape::Choice(variants)) => self.choice_of_objects(variants)?,
                None => Value::Json(self.reader.value_text()?.to_owned()),
            },
        };
        Ok((value, None))
    }

    fn own_object(&mut self, fields: &[FieldPlan<'m>]) -> Result<Vec<Node<'m>>, BodyError> {
        self.object(Keys {
            fields,
            others: Others::KeptBut(&[]),
        })
    }

    fn list(&mut self, item: &TypePlan<'m>) -> Result<Vec<Node<'m>>, BodyError> {
        self.reader.begin_list()?;
        let mut nodes = Vec::new();
        if self.reader.end_list() {
            return Ok(nodes);
        }
        loop {
            self.reader.peek();
            let start = self.reader.at();
            let (value, _) = self.value(item, Form::default())?;
            nodes.push(Node {
                key: Key::Item(nodes.len()),
                about: About::Item,
                ty: Some(item.ty),
                span: start..self.reader.at(),
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
        let start = self.reader.at();
        let wire = match enum_range(shape) {
            Some(range) => Scalar::Number(Number::Int(self.integer(range)?)),
            None => Scalar::String(self.reader.string()?.into_owned()),
        };
        let named = shape.values.iter().find(|value| value.wire == wire);
        if named.is_none() && shape.closed {
            let detail = "this is none of the values of this field";
            return Err(BodyError::new(BodyFault::UnknownValue, start, detail));
        }
        Ok(Value::Enum { wire, named })
    }

    /// Reads an object as the first variant whose required keys it has all.
    fn choice_of_objects(
        &mut self,
        variants: &[(&'m Variant, usize)],
    ) -> Result<Value<'m>, BodyError> {
        self.reader.peek();
        let start = self.reader.at();
        let mut ahead = self.reader.clone();
        ahead.begin_object()?;
        // For each variant, which of its fields have come.
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
            return Err(BodyError::new(BodyFault::NoVariant, start, detail));
        };
        Ok(Value::OneOf {
            variant,
            keys: self.own_object(self.plan.fields(*number))?,
        })
    }

    fn base64(&mut self) -> Result<Vec<u8>, BodyError> {
        self.reader.peek();
        let start = self.reader.at();
        let text = self.reader.string()?;
        STANDARD.decode(text.as_bytes()).map_err(|error| {
            let detail = format!("{error}; send padded base64 of the standard alphabet");
            BodyError::new(BodyFault::BadBase64, start, detail)
        })
    }

    fn bool(&mut self, form: Form) -> Result<Found<'m>, BodyError> {
        let next = self.reader.peek();
        let start = self.reader.at();
        let (value, quoted) = match next {
            Some(b'"') if form.quoted || form.lenient => match &*self.reader.string()? {
                "true" => (true, true),
                "false" => (false, true),
                _ => return Err(not_held(start, "true or false")),
            },
            Some(b'-' | b'0'..=b'9') if form.lenient => {
                let mut ahead = self.reader.clone();
                let value = self.integer((0, 1));
                let value = value.map_err(|_| ahead.unexpected("true, false, 0 or 1"))?;
                return Ok((Value::Bool(value == 1), Some(Quirk::LenientBool)));
            }
            _ if form.quoted && !form.lenient => {
                return Err(self.reader.unexpected("a bool as a string"));
            }
            _ => {
                let value = self.reader.take_bool();
                let value = value.ok_or_else(|| self.reader.unexpected("true or false"))?;
                (value, false)
            }
        };
        let quirk = (quoted != form.quoted).then_some(Quirk::LenientBool);
        Ok((Value::Bool(value), quirk))
    }

    fn int(&mut self, range: (i128, i128), form: Form) -> Result<Found<'m>, BodyError> {
        let sent = self.number(form, "an integer")?;
        let value = sent.integer(range)?;
        Ok((Value::Int(value), sent.quirk(form)))
    }

    fn float(&mut self, kind: FloatKind, form: Form) -> Result<Found<'m>, BodyError> {
        let sent = self.number(form, "a number")?;
        let value = sent.float(kind)?;
        Ok((Value::Float(value), sent.quirk(form)))
    }

    /// Reads an integer in the form of its type.
    fn integer(&mut self, range: (i128, i128)) -> Result<i128, BodyError> {
        self.number(Form::default(), "an integer")?.integer(range)
    }

    /// Reads a number, or a string in its place where the form takes one.
    fn number(&mut self, form: Form, wanted: &'static str) -> Result<Sent<'t>, BodyError> {
        let next = self.reader.peek();
        let start = self.reader.at();
        let in_string = next == Some(b'"') && (form.quoted || form.lenient);
        if !in_string {
            if form.quoted && !form.lenient {
                return Err(self.reader.unexpected("a number as a string"));
            }
            let digits = Digits::Decimal(self.reader.number(wanted)?.into());
            return Ok(Sent {
                digits,
                start,
                in_string,
                is_all: true,
                wanted,
            });
        }
        let text = self.reader.string()?;
        let mut is_all = true;
        let digits = match hexadecimal(&text).filter(|_| form.lenient) {
            Some(Ok(value)) => Digits::Hexadecimal(value),
            Some(Err(IntErrorKind::PosOverflow)) => Digits::TooLarge,
            Some(Err(_)) => return Err(not_held(start, wanted)),
            None => {
                let mut inside = Reader::checked(&text);
                let digits = inside.number(wanted).map_err(|_| not_held(start, wanted))?;
                // There is no white space around it.
                is_all = inside.is_at_end() && text.starts_with(digits);
                Digits::Decimal(digits.to_owned().into())
            }
        };
        Ok(Sent {
            digits,
            start,
            in_string,
            is_all,
            wanted,
        })
    }
}

/// A number as it was sent.
struct Sent<'t> {
    digits: Digits<'t>,
    start: usize,
    in_string: bool,
    /// Whether nothing else is in the string.
    is_all: bool,
    wanted: &'static str,
}

enum Digits<'t> {
    /// The notation of JSON.
    Decimal(Cow<'t, str>),
    /// What followed `0x`.
    Hexadecimal(u64),
    /// The same, past 64 bits.
    TooLarge,
}

impl Sent<'_> {
    fn integer(&self, range: (i128, i128)) -> Result<i128, BodyError> {
        let value = match &self.digits {
            Digits::Decimal(text) => match json::integral(text) {
                Integral::Value(value) => Some(value),
                Integral::TooLarge => None,
                Integral::Fraction if self.in_string => {
                    return Err(not_held(self.start, self.wanted));
                }
                Integral::Fraction => {
                    let detail = "found a number that is not integral; send an integer";
                    return Err(BodyError::new(BodyFault::WrongType, self.start, detail));
                }
            },
            Digits::Hexadecimal(value) => Some((*value).into()),
            Digits::TooLarge => None,
        };
        let (least, most) = range;
        let value = value.filter(|value| (least..=most).contains(value));
        let value = value.ok_or_else(|| {
            let detail = format!("the number must be from {least} to {most}");
            BodyError::new(BodyFault::OutOfRange, self.start, detail)
        });
        value.and_then(|value| self.if_all(value))
    }

    fn float(&self, kind: FloatKind) -> Result<f64, BodyError> {
        let value = match &self.digits {
            Digits::Decimal(text) => json::float(text, kind),
            #[allow(
                clippy::cast_precision_loss,
                reason = "the nearest value is what is wanted"
            )]
            Digits::Hexadecimal(value) => Some(match kind {
                FloatKind::F32 => f64::from(*value as f32),
                FloatKind::F64 => *value as f64,
            }),
            Digits::TooLarge => None,
        };
        let value = value.ok_or_else(|| {
            let detail = "the number is too large for the floating-point type of the field";
            BodyError::new(BodyFault::OutOfRange, self.start, detail)
        });
        value.and_then(|value| self.if_all(value))
    }

    /// The value, unless the string holds more: that is looked at last.
    fn if_all<T>(&self, value: T) -> Result<T, BodyError> {
        if self.is_all {
            Ok(value)
        } else {
            Err(not_held(self.start, self.wanted))
        }
    }

    fn quirk(&self, form: Form) -> Option<Quirk> {
        let is_canonical =
            self.in_string == form.quoted && matches!(self.digits, Digits::Decimal(_));
        (!is_canonical).then_some(Quirk::LenientNumber)
    }
}

/// The value of a text that is `0x` and hexadecimal digits; `None` of any other.
fn hexadecimal(text: &str) -> Option<Result<u64, IntErrorKind>> {
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))?;
    // The parser of the standard library takes a sign, which has no place behind `0x`.
    let digits = (!digits.starts_with('+')).then_some(digits)?;
    Some(u64::from_str_radix(digits, 16).map_err(|error| *error.kind()))
}

fn not_held(start: usize, wanted: &str) -> BodyError {
    let detail = format!("the string does not hold {wanted}");
    BodyError::new(BodyFault::WrongType, start, detail)
}
