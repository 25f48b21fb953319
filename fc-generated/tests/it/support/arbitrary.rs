//! Generates arbitrary JSON that a type of the spec allows.

use fc_reflect::sample::{Profile, Samples};
use fc_spec::model::{
    EnumRepr, EnumType, Example, Field, FloatKind, Number, Quirk, Scalar, StructType, Type,
    TypeDef, TypeShape, Value, WireForm,
};

/// Below this depth, optional keys are left out.
const DEPTH: usize = 5;

/// An endless sequence of numbers from one seed (`SplitMix64`).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Returns a number below `bound`.
    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % u64::try_from(bound.max(1)).unwrap()).unwrap()
    }

    fn one_in(&mut self, bound: usize) -> bool {
        self.below(bound) == 0
    }

    fn pick<'a, T>(&mut self, items: &'a [T]) -> &'a T {
        let index = self.below(items.len());
        items.get(index).expect("there is something to pick")
    }

    fn int(&mut self, least: i128, most: i128) -> i128 {
        match self.below(4) {
            0 => least,
            1 => most,
            _ => least + i128::from(self.next()) % (most - least + 1),
        }
    }
}

/// Generates values of named types.
pub struct Arbitrary<'m> {
    samples: Samples<'m>,
}

impl<'m> Arbitrary<'m> {
    pub fn new(samples: Samples<'m>) -> Self {
        Self { samples }
    }

    /// Returns a value as an encoder writes it: keys in order, and no quirk.
    pub fn value(&self, ty: &TypeDef, random: &mut Random) -> Value {
        self.named(ty, random, DEPTH)
    }

    fn named(&self, ty: &TypeDef, random: &mut Random, depth: usize) -> Value {
        let types = &self.samples.model().types;
        match &ty.shape {
            TypeShape::Struct(shape) => self.object(shape, random, depth),
            TypeShape::Enum(shape) => enumeration(shape, random),
            TypeShape::OneOf(choice) => {
                let variant = random.pick(&choice.variants);
                let value = self.named(types.get(&variant.ty), random, depth);
                let read_as = self.samples.variant_of(choice, &value);
                if read_as.is_some_and(|read_as| read_as.ty == variant.ty) {
                    value
                } else {
                    self.samples.named(ty, Profile::Example)
                }
            }
        }
    }

    fn object(&self, shape: &StructType, random: &mut Random, depth: usize) -> Value {
        let mut entries: Vec<(String, Value)> = Vec::new();
        for field in &shape.fields {
            let deep = depth == 0 || field.optional && random.one_in(3);
            if field.optional && deep {
                continue;
            }
            let value = self.field(field, random, depth);
            let empty = matches!(&value, Value::Object(entries) if entries.is_empty())
                || matches!(&value, Value::Array(items) if items.is_empty())
                || value == Value::String(String::new())
                || value == Value::Null;
            // An optional key with null reads as absent.
            if field.optional && value == Value::Null {
                continue;
            }
            if !(empty && field.details().quirks.contains(&Quirk::EmptyIsAbsent)) {
                entries.push((field.wire.clone(), value));
            }
        }
        for number in 0..random.below(3) {
            entries.push((format!("未知 \"key\" {number}"), json(random, 3)));
        }
        Value::Object(entries)
    }

    fn field(&self, field: &Field, random: &mut Random, depth: usize) -> Value {
        let value = self.typed(&field.ty, field, random, depth);
        match (field.wire_form, value) {
            (WireForm::String, Value::Array(items)) => Value::Array(
                items
                    .into_iter()
                    .map(|item| Value::String(item.to_string()))
                    .collect(),
            ),
            (WireForm::String, value) => Value::String(value.to_string()),
            (WireForm::Number, Value::Bool(truth)) => Value::Number(Number::Int(truth.into())),
            (WireForm::Number | WireForm::Plain, value) => value,
        }
    }

    fn typed(&self, ty: &Type, field: &Field, random: &mut Random, depth: usize) -> Value {
        match ty {
            Type::Bool => Value::Bool(random.one_in(2)),
            Type::Int(kind) => integer(kind.range(), field, random),
            Type::TimestampMs | Type::TimestampS => {
                integer((i64::MIN.into(), i64::MAX.into()), field, random)
            }
            Type::Float(kind) => float(*kind, field, random),
            // There is no generator for patterns: the example serves as the value.
            Type::String if field.details().constraints.pattern.is_some() => match &field.example {
                Example::Given(value) => value.clone(),
                Example::Derived | Example::Absent => Value::String(String::new()),
            },
            Type::String => {
                let length = count(field, random, 12);
                Value::String((0..length).map(|_| character(random)).collect())
            }
            Type::Base64 => {
                let length = count(field, random, 9);
                let bytes: Vec<u8> = (0..length)
                    .map(|_| random.next().to_le_bytes()[0])
                    .collect();
                Value::String(base64(&bytes))
            }
            Type::Json => json(random, 3),
            Type::Array(item) => {
                let length = if depth == 0 {
                    field
                        .details()
                        .constraints
                        .length
                        .map_or(0, |(least, _)| least)
                } else {
                    count(field, random, 3)
                };
                (0..length)
                    .map(|_| self.typed(item, field, random, depth.saturating_sub(1)))
                    .collect()
            }
            // The field allows only some values of the enum.
            Type::Named(_) if !field.details().constraints.only.is_empty() => {
                scalar(random.pick(&field.details().constraints.only))
            }
            Type::Named(named) => {
                let ty = self.samples.model().types.get(named);
                self.named(ty, random, depth.saturating_sub(1))
            }
        }
    }
}

fn enumeration(shape: &EnumType, random: &mut Random) -> Value {
    if shape.closed || random.one_in(2) {
        return scalar(&random.pick(&shape.values).wire);
    }
    match shape.repr {
        EnumRepr::Int(kind) => {
            let (least, most) = kind.range();
            Value::Number(Number::Int(random.int(least, most)))
        }
        EnumRepr::String => Value::String((0..4).map(|_| character(random)).collect()),
    }
}

fn scalar(scalar: &Scalar) -> Value {
    match scalar {
        Scalar::Number(number) => Value::Number(number.clone()),
        Scalar::String(text) => Value::String(text.clone()),
        Scalar::Bool(value) => Value::Bool(*value),
    }
}

fn integer((least, most): (i128, i128), field: &Field, random: &mut Random) -> Value {
    let bound = |number: Option<&Number>, otherwise: i128| match number {
        Some(Number::Int(value)) => *value,
        _ => otherwise,
    };
    let (least, most) = (
        bound(field.details().constraints.min.as_ref(), least),
        bound(field.details().constraints.max.as_ref(), most),
    );
    Value::Number(Number::Int(random.int(least, most)))
}

#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "any float will do"
)]
fn float(kind: FloatKind, field: &Field, random: &mut Random) -> Value {
    let bound = |number: Option<&Number>| match number {
        Some(Number::Int(value)) => Some(*value as f64),
        Some(Number::Float(value)) => Some(*value),
        None => None,
    };
    let share = random.next() as f64 / u64::MAX as f64;
    let value = match (
        bound(field.details().constraints.min.as_ref()),
        bound(field.details().constraints.max.as_ref()),
    ) {
        (Some(least), Some(most)) => least + (most - least) * share,
        (Some(least), None) => least + share * 1e6,
        (None, Some(most)) => most - share * 1e6,
        (None, None) => {
            let any = f64::from_bits(random.next());
            if any.is_finite() { any } else { share }
        }
    };
    Value::Number(Number::Float(match kind {
        FloatKind::F64 => value,
        FloatKind::F32 if f64::from(value as f32).is_finite() => {
            // The shortest decimal that reads as this f32 again.
            format!("{:?}", value as f32).parse().unwrap()
        }
        FloatKind::F32 => share,
    }))
}

/// Returns an allowed number of items, characters or bytes.
fn count(field: &Field, random: &mut Random, most: usize) -> u64 {
    match field.details().constraints.length {
        Some((least, most)) => least + random.next() % (most.min(least + 40) - least + 1),
        None if field.details().quirks.contains(&Quirk::EmptyIsAbsent) => 1,
        None => u64::try_from(random.below(most)).unwrap(),
    }
}

fn character(random: &mut Random) -> char {
    match random.below(5) {
        0 => *random.pick(&[
            '"', '\\', '/', '\n', '\u{0}', '\u{1f}', '\u{7f}', '\u{2028}', '😀',
        ]),
        1 => *random.pick(&['站', '点', '（', 'é']),
        _ => *random.pick(&['a', 'Z', '0', ' ', '_']),
    }
}

/// Returns any JSON value.
fn json(random: &mut Random, depth: usize) -> Value {
    match random.below(if depth == 0 { 5 } else { 7 }) {
        0 => Value::Null,
        1 => Value::Bool(random.one_in(2)),
        2 => Value::Number(Number::Int(random.int(i64::MIN.into(), u64::MAX.into()))),
        3 => Value::Number(Number::Float(0.5)),
        4 => Value::String((0..random.below(6)).map(|_| character(random)).collect()),
        5 => (0..random.below(3))
            .map(|_| json(random, depth - 1))
            .collect(),
        _ => {
            let keys = 0..random.below(3);
            Value::Object(
                keys.map(|n| (format!("k{n}"), json(random, depth - 1)))
                    .collect(),
            )
        }
    }
}

fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word = chunk
            .iter()
            .fold(0u32, |word, &byte| word << 8 | u32::from(byte));
        let word = word << (8 * (3 - chunk.len()));
        for place in 0..4 {
            let digit = usize::try_from(word >> (18 - 6 * place) & 63).unwrap();
            out.push(if place <= chunk.len() {
                char::from(ALPHABET[digit])
            } else {
                '='
            });
        }
    }
    out
}
