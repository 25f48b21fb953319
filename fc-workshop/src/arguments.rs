//! Arguments of a call as text: `key=value` with the keys and names of the spec.

use crate::error::InputError;
use crate::paths;
use fc_reflect::sample::constraint::on_the_wire;
use fc_spec::model::{
    EnumType, Field, Model, Number, StructRef, StructType, Text, Type, TypeShape, Value, WireForm,
};
use fc_spec::text;

/// The largest index of a list in a key.
const MOST_ITEMS: usize = 4096;

/// The least similarity of a suggested key, from 0 to 1.
const SIMILAR: f64 = 0.8;

/// Reads the values of arguments by the types of a model.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'m> {
    model: &'m Model,
}

impl<'m> Arguments<'m> {
    /// Uses the types of a model.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        Self { model }
    }

    /// Returns the object with these arguments. A key is a wire key or the name of a field; dots lead into objects, and
    /// indexes into lists, such as `list[0]` or `list.0`.
    ///
    /// # Errors
    /// [`InputError`] for an unknown key, or a value of another type.
    pub fn object<'t>(
        self,
        body: &StructRef,
        arguments: impl IntoIterator<Item = &'t str>,
    ) -> Result<Value, InputError> {
        let shape = self.model.types.structure(body);
        let mut object = Value::Object(Vec::new());
        for argument in arguments {
            let Some((key, text)) = argument.split_once('=') else {
                return Err(InputError(text!(
                    "参数应为 `键=值`，实际为 `{argument}`",
                    "expected `key=value`, found `{argument}`"
                )));
            };
            // `list[0]` is `list.0`.
            let path = key.replace('[', ".").replace(']', "");
            let steps: Vec<&str> = path.split('.').collect();
            self.set_key(shape, &mut object, &steps, key, text)?;
        }
        Ok(object)
    }

    /// Sets the value at the end of a path that begins with a key of an object.
    fn set_key(
        self,
        shape: &StructType,
        object: &mut Value,
        steps: &[&str],
        key: &str,
        text: &str,
    ) -> Result<(), InputError> {
        let Some((step, rest)) = steps.split_first() else {
            return Ok(());
        };
        let field = named(shape, step).ok_or_else(|| unknown_key(shape, step, key))?;
        if object.get(&field.wire).is_none() {
            object.set(&field.wire, Value::Null);
        }
        match object.get_mut(&field.wire) {
            Some(value) => self.set(&field.ty, field, value, rest, key, text),
            None => Ok(()),
        }
    }

    fn set(
        self,
        ty: &Type,
        field: &Field,
        value: &mut Value,
        steps: &[&str],
        key: &str,
        text: &str,
    ) -> Result<(), InputError> {
        let Some((step, rest)) = steps.split_first() else {
            let read = self.value(ty, text);
            let read = read.ok_or_else(|| self.wrong_value(ty, key, text))?;
            *value = on_the_wire(read, field.wire_form);
            return Ok(());
        };
        let Type::Array(item) = ty else {
            let shapes = paths::shapes(self.model, ty);
            let mut fitting = shapes.iter().filter(|shape| named(shape, step).is_some());
            let Some(shape) = fitting.next().or(shapes.first()) else {
                return Err(InputError(text!(
                    "`{key}`：`{step}` 之前的值不是对象",
                    "`{key}`: the value before `{step}` is not an object"
                )));
            };
            if !matches!(value, Value::Object(_)) {
                *value = Value::Object(Vec::new());
            }
            return self.set_key(shape, value, steps, key, text);
        };
        let index: usize = step.parse().map_err(|_| {
            InputError(text!(
                "`{key}`：`{step}` 应为列表中从 0 开始的序号",
                "`{key}`: expected an index from 0 instead of `{step}`"
            ))
        })?;
        if !matches!(value, Value::Array(_)) {
            *value = Value::Array(Vec::new());
        }
        let Value::Array(items) = value else {
            return Ok(());
        };
        if index >= MOST_ITEMS {
            return Err(InputError(text!(
                "`{key}`：序号应小于 {MOST_ITEMS}",
                "`{key}`: expected an index below {MOST_ITEMS}"
            )));
        }
        if items.len() <= index {
            items.resize(index + 1, Value::Null);
        }
        match items.get_mut(index) {
            Some(value) => self.set(item, field, value, rest, key, text),
            None => Ok(()),
        }
    }

    /// Reads a value. Returns `None` if the text does not fit the type.
    fn value(self, ty: &Type, text: &str) -> Option<Value> {
        Some(match ty {
            Type::Bool => Value::Bool(text.parse().ok()?),
            Type::Int(_) | Type::TimestampMs | Type::TimestampS => {
                Value::Number(Number::Int(integer(text)?))
            }
            Type::Float(_) => {
                let number: f64 = text.parse().ok()?;
                Value::Number(Number::Float(Some(number).filter(|it| it.is_finite())?))
            }
            Type::String | Type::Base64 => Value::String(text.to_owned()),
            Type::Json => json(text)?,
            Type::Array(_) if text.trim_start().starts_with('[') => json(text)?,
            Type::Array(item) => {
                let items = text.split(',').filter(|item| !item.is_empty());
                Value::Array(
                    items
                        .map(|text| self.value(item, text))
                        .collect::<Option<_>>()?,
                )
            }
            Type::Named(named) => match &self.model.types.get(named).shape {
                TypeShape::Enum(shape) => enum_value(shape, text)?,
                TypeShape::Struct(_) | TypeShape::OneOf(_) => json(text)?,
            },
        })
    }

    fn wrong_value(self, ty: &Type, key: &str, text: &str) -> InputError {
        let expected = self.expected(ty);
        InputError(text!(
            "`{key}` 应为{expected}，实际为 `{text}`",
            "expected {expected} for `{key}`, found `{text}`",
            expected = expected
        ))
    }

    /// Returns the accepted values of a type in words.
    fn expected(self, ty: &Type) -> Text {
        match ty {
            Type::Bool => text!(" `true` 或 `false`", "`true` or `false`"),
            Type::Int(kind) => {
                let (least, most) = kind.range();
                text!(
                    " {least} 到 {most} 的整数",
                    "an integer from {least} to {most}"
                )
            }
            Type::TimestampMs => text!("毫秒时间戳", "a time in milliseconds since 1970"),
            Type::TimestampS => text!("秒时间戳", "a time in seconds since 1970"),
            Type::Float(_) => text!("数字", "a number"),
            Type::String => text!("文本", "a text"),
            Type::Base64 => text!(" base64", "base64"),
            Type::Json => text!(" JSON", "JSON"),
            Type::Array(item) => {
                let item = self.expected(item.item());
                text!(
                    "以逗号分隔的列表或 JSON 数组，每项为{item}",
                    "a list with commas or a JSON array, of which each item is {item}",
                    item = item
                )
            }
            Type::Named(named) => match &self.model.types.get(named).shape {
                TypeShape::Enum(shape) => {
                    let known = shape.values.iter().map(|value| {
                        let wire = Value::from(&value.wire);
                        format!("{} ({wire})", value.name)
                    });
                    let known = known.collect::<Vec<_>>().join(", ");
                    text!("以下之一：{known}", "one of {known}")
                }
                TypeShape::Struct(_) | TypeShape::OneOf(_) => text!(
                    " JSON 对象；也可以用点号写它的键",
                    "a JSON object, or its keys after a dot"
                ),
            },
        }
    }
}

/// Returns the field with a wire key or a name.
fn named<'s>(shape: &'s StructType, key: &str) -> Option<&'s Field> {
    let mut fields = shape.fields.iter();
    fields.find(|field| field.wire == key || field.name == key)
}

fn unknown_key(shape: &StructType, step: &str, key: &str) -> InputError {
    let known = Text::listed(shape.fields.iter().map(|field| &field.wire));
    if shape.fields.is_empty() {
        return InputError(text!(
            "`{key}`：规范在这里没有键；未知的键用 --json 发送",
            "`{key}`: the spec has no keys here; send unknown keys with --json"
        ));
    }
    let similar = shape.fields.iter().map(|field| &field.wire);
    let similar = similar.max_by(|one, two| {
        let one = strsim::jaro_winkler(one, step);
        one.total_cmp(&strsim::jaro_winkler(two, step))
    });
    let similar = similar.filter(|wire| strsim::jaro_winkler(wire, step) > SIMILAR);
    let similar = similar.map_or_else(Text::default, |wire| {
        text!("是否要写 `{wire}`？", "did you mean `{wire}`? ")
    });
    InputError(text!(
        "`{key}`：没有键 `{step}`；{similar}可用的键：{known}",
        "`{key}`: there is no key `{step}`; {similar}the keys are {known}",
        similar = similar,
        known = known
    ))
}

fn integer(text: &str) -> Option<i128> {
    match text.strip_prefix("0x") {
        Some(digits) => i128::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

/// Reads an enum value by its name or its wire value.
fn enum_value(shape: &EnumType, text: &str) -> Option<Value> {
    let mut values = shape.values.iter();
    let found = values.find(|value| {
        let wire = on_the_wire(Value::from(&value.wire), WireForm::String);
        value.name == text || wire == Value::String(text.to_owned())
    });
    found.map(|value| Value::from(&value.wire))
}

/// Reads any JSON.
#[must_use]
pub fn json(text: &str) -> Option<Value> {
    serde_json::from_str(text).ok()
}
