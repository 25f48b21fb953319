//! Checks that values of the spec could occur in a message.

use crate::diagnostic::{Diagnostic, FaultCode, nearest};
use crate::language::ambiguous_scalar::misread;
use crate::language::scalar::{self, value};
use crate::load::draft::Draft;
use crate::model::{
    Argument, EnumType, Field, FloatKind, Judged, Number, OneOf, Scalar, StructType, Text, Type,
    TypeShape, Value, WireForm,
};
use crate::syntax::{self, Node, NodeKind};
use crate::text;

/// Returns the mismatch of an example.
fn mismatch(node: Node<'_>, message: Text) -> Diagnostic {
    Diagnostic::error(FaultCode::ExampleType, node.span(), message)
}

/// Returns the mismatches of a field's value, which is in wire form.
pub(super) fn check_field(draft: &Draft<'_>, field: &Field, node: Node<'_>) -> Vec<Diagnostic> {
    let named = field.ty.innermost();
    if is_doubtful(node) || named.is_some_and(|ty| !draft.knows(ty.name())) {
        return Vec::new();
    }
    match (field.wire_form, &field.ty) {
        (WireForm::String, _) => return check_in_string(field, node),
        (WireForm::Number, Type::Bool) => return Vec::from_iter(check_bool_as_number(node)),
        // On any other type `wire: number` is the error, not the value.
        (WireForm::Number | WireForm::Plain, _) => {}
    }
    let found = check_type(draft, &field.ty, node);
    // A value of the wrong type breaks every constraint; one error is enough.
    if found.is_empty() && field.details.is_some() {
        return check_constraints(field, node, &value(node));
    }
    found
}

/// Returns `true` for a spelling that YAML readers disagree about. It has its own error.
fn is_doubtful(node: Node<'_>) -> bool {
    node.as_plain()
        .is_some_and(|text| misread(text).is_some() || scalar::has_leading_zero(text))
}

/// Checks a field with `wire: string`, whose string holds a number or bool.
fn check_in_string(field: &Field, node: Node<'_>) -> Vec<Diagnostic> {
    let Value::String(text) = value(node) else {
        let fault = mismatch(
            node,
            text!(
                "应为字符串：这个字段以字符串发送",
                "expected a string: the field is sent as one"
            ),
        );
        return vec![with_quotes(fault, node)];
    };
    let number = match (&field.ty, text.as_str()) {
        // A bool has no constraints.
        (Type::Bool, "true" | "false") => return Vec::new(),
        (Type::Bool, _) => Err(text!(
            "应为 \"true\" 或 \"false\"",
            "expected \"true\" or \"false\""
        )),
        (_, text) => {
            let number = scalar::number_text(text).filter(|_| !text.contains('x'));
            number.map(Value::Number).ok_or_else(|| {
                text!(
                    "字符串中应为十进制数值",
                    "expected a decimal number inside the string"
                )
            })
        }
    };
    match number {
        Err(message) => vec![mismatch(node, message)],
        Ok(number) => match check_number(&field.ty, &number, node) {
            Some(fault) => vec![fault],
            None => check_constraints(field, node, &number),
        },
    }
}

/// Proposes quotes around a plain scalar.
fn with_quotes(fault: Diagnostic, node: Node<'_>) -> Diagnostic {
    match node.as_plain() {
        Some(text) => fault.quote(text),
        None => fault,
    }
}

/// Checks a field with `wire: number`: 1 is true, 0 is false. A bool has no constraints.
fn check_bool_as_number(node: Node<'_>) -> Option<Diagnostic> {
    let message = text!(
        "应为 1 或 0：这个字段以数值发送",
        "expected 1 or 0: the field is sent as a number"
    );
    match value(node) {
        Value::Number(Number::Int(0 | 1)) => None,
        Value::Bool(truth) => Some(mismatch(node, message).write(u8::from(truth).to_string())),
        _ => Some(mismatch(node, message)),
    }
}

/// Returns the mismatches between a value and a type.
pub(super) fn check_type(draft: &Draft<'_>, ty: &Type, node: Node<'_>) -> Vec<Diagnostic> {
    if is_doubtful(node) {
        return Vec::new();
    }
    let wrong = |expected: Text| {
        let message = text!(
            "应为{expected}，实际为{found}",
            "expected {expected}, found {found}",
            found = describe(node),
            expected = expected.spaced()
        );
        mismatch(node, message)
    };
    let fault = match ty {
        Type::Json => None,
        Type::Bool if scalar::bool(node).is_some() => None,
        Type::Bool => Some(wrong(text!("`true` 或 `false`", "`true` or `false`"))),
        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS => {
            check_number(ty, &value(node), node)
        }
        Type::String | Type::Base64 => match text_of(node) {
            None => Some(with_quotes(wrong(text!("文本", "text")), node)),
            Some(text) if *ty == Type::Base64 && base64_len(text).is_none() => Some(wrong(text!(
                "base64（RFC 4648，带填充）",
                "base64 (RFC 4648 with padding)"
            ))),
            Some(_) => None,
        },
        Type::Array(item) => match node.as_sequence() {
            Some(items) => return items.flat_map(|it| check_type(draft, item, it)).collect(),
            None => Some(wrong(text!("列表", "a list"))),
        },
        Type::Named(named) if !draft.knows(named.name()) => None,
        Type::Named(named) => match draft.shape(ty) {
            Some(TypeShape::Enum(shape)) => check_enum(named.name(), shape, node),
            Some(TypeShape::Struct(shape)) => return check_struct(draft, shape, node),
            Some(TypeShape::OneOf(choice)) => return check_one_of(draft, choice, node),
            None => None,
        },
    };
    Vec::from_iter(fault)
}

fn check_number(ty: &Type, value: &Value, node: Node<'_>) -> Option<Diagnostic> {
    let Value::Number(number) = value else {
        let expected = match ty {
            Type::Float(_) => text!("数值", "a number"),
            _ => text!("整数", "an integer"),
        };
        let message = text!(
            "应为{expected}，实际为{found}",
            "expected {expected}, found {found}",
            found = describe(node),
            expected = expected
        );
        let text = node.as_str().unwrap_or_default();
        let is_quoted = node.as_plain().is_none() && scalar::number_text(text).is_some();
        let fault = mismatch(node, message);
        return Some(if is_quoted {
            fault.unquote(text)
        } else {
            fault
        });
    };
    let (least, most) = match ty {
        Type::Int(kind) => kind.range(),
        Type::Float(kind) => {
            let is_f32 = *kind == FloatKind::F32;
            let is_beyond = is_f32 && scalar::float(number).abs() > f64::from(f32::MAX);
            return is_beyond.then(|| {
                let message = text!("超出 f32 的范围", "this value does not fit into f32");
                mismatch(node, message)
            });
        }
        _ => (i64::MIN.into(), i64::MAX.into()),
    };
    let message = match number {
        Number::Int(value) if (least..=most).contains(value) => return None,
        Number::Int(value) => text!(
            "{value} 不在 {least}..={most} 之内",
            "{value} is outside {least}..={most}"
        ),
        Number::Float(_) => text!(
            "应为整数，实际为小数",
            "expected an integer, found a fraction"
        ),
    };
    Some(mismatch(node, message))
}

fn check_enum(name: &str, shape: &EnumType, node: Node<'_>) -> Option<Diagnostic> {
    let wire = match value(node) {
        Value::Number(number) => Scalar::Number(number),
        Value::String(text) => Scalar::String(text),
        _ => {
            let message = text!(
                "应为 `{name}` 的取值，实际为{found}",
                "expected a value of `{name}`, found {found}",
                found = describe(node)
            );
            return Some(mismatch(node, message));
        }
    };
    if shape.values.is_empty() || shape.values.iter().any(|value| value.wire == wire) {
        return None;
    }
    let text = node.as_str().unwrap_or_default();
    let message = text!(
        "`{text}` 不是 `{name}` 的取值",
        "`{text}` is not a value of `{name}`"
    );
    let fault = Diagnostic::error(FaultCode::ExampleValue, node.span(), message);
    // Often the spec has the name in code instead of the wire value.
    let Some(named) = shape.values.iter().find(|value| value.name == text) else {
        return Some(fault);
    };
    let spelling = match &named.wire {
        Scalar::Number(Number::Int(number)) => number.to_string(),
        Scalar::String(text) => syntax::quoted(text),
        Scalar::Bool(_) | Scalar::Number(Number::Float(_)) => text.to_owned(),
    };
    let message = text!(
        "`{text}` 是它的名称；发送的值是 {spelling}",
        "`{text}` is its name; the value sent is {spelling}"
    );
    Some(fault.fix(node.span(), spelling, message))
}

fn check_struct(draft: &Draft<'_>, shape: &StructType, node: Node<'_>) -> Vec<Diagnostic> {
    let Some(entries) = node.as_mapping() else {
        let message = text!(
            "应为对象，实际为{found}",
            "expected an object, found {found}",
            found = describe(node)
        );
        return vec![mismatch(node, message)];
    };
    let mut found = Vec::new();
    for entry in entries {
        let name = entry.name();
        if let Some(field) = shape.fields.iter().find(|field| field.wire == name) {
            found.extend(check_field(draft, field, entry.value));
            continue;
        }
        let message = text!("对象没有键 `{name}`", "the object has no key `{name}`");
        let keys = shape.fields.iter().map(|field| field.wire.as_str());
        found.push(mismatch(entry.key, message).suggest(nearest(name, keys), None));
    }
    let required = shape.fields.iter().filter(|field| !field.optional);
    for field in required.filter(|field| node.get(&field.wire).is_none()) {
        let message = text!(
            "缺少必填的键 `{key}`",
            "the required key `{key}` is missing",
            key = field.wire
        );
        found.push(mismatch(node, message));
    }
    found
}

/// Checks the first variant whose required keys are all present, like a decoder.
fn check_one_of(draft: &Draft<'_>, choice: &OneOf, node: Node<'_>) -> Vec<Diagnostic> {
    let variants = choice.variants.iter();
    let mut shapes = variants.filter_map(|variant| draft.struct_named(variant.ty.name()));
    let is_taken = |shape: &&StructType| {
        let mut required = shape.fields.iter().filter(|field| !field.optional);
        node.as_mapping().is_some() && required.all(|field| node.get(&field.wire).is_some())
    };
    let message = text!(
        "没有任何一个选项的全部必填键",
        "the object lacks the required keys of every variant"
    );
    match shapes.find(is_taken) {
        Some(shape) => check_struct(draft, shape, node),
        None => vec![mismatch(node, message)],
    }
}

/// Returns an error for each constraint of the field that a value of the correct type breaks.
pub(super) fn check_constraints(field: &Field, node: Node<'_>, value: &Value) -> Vec<Diagnostic> {
    let constraints = &field.details().constraints;
    let Some(value) = judged(&field.ty, value) else {
        return Vec::new();
    };
    // Inverted bounds admit no value, so they are not applied.
    if constraints.is_inverted() && matches!(value, Judged::Number(_)) {
        return Vec::new();
    }
    let broken = constraints.iter().filter_map(|constraint| {
        let message = constraint.broken(&value)?;
        let code = match constraint.argument() {
            Argument::Number(_) => FaultCode::ExampleRange,
            Argument::Range(..) => FaultCode::ExampleLength,
            Argument::Pattern(_) => FaultCode::ExamplePattern,
            Argument::Values(_) => FaultCode::ExampleValue,
        };
        Some(Diagnostic::error(code, node.span(), message))
    });
    broken.collect()
}

/// Returns the part of a value that constraints judge. `None` for a value without constraints.
fn judged<'v>(ty: &Type, value: &'v Value) -> Option<Judged<'v>> {
    Some(match (ty, value) {
        (Type::Named(_), Value::Number(number)) => {
            Judged::EnumValue(Scalar::Number(number.clone()))
        }
        (Type::Named(_), Value::String(text)) => Judged::EnumValue(Scalar::String(text.clone())),
        (Type::String, Value::String(text)) => Judged::String(text),
        (Type::Base64, Value::String(text)) => Judged::Bytes(base64_len(text)?),
        (Type::Array(_), Value::Array(items)) => Judged::Items(items.len()),
        (_, Value::Number(number)) => Judged::Number(number.clone()),
        _ => return None,
    })
}

/// Describes a value in its wire form.
fn describe(node: Node<'_>) -> Text {
    match node.kind() {
        NodeKind::Null => text!("空值", "null"),
        NodeKind::Sequence(_) => text!("列表", "a list"),
        NodeKind::Mapping(_) => text!("对象", "an object"),
        NodeKind::Scalar(_) => match value(node) {
            Value::Bool(_) => text!("布尔值", "a boolean"),
            Value::Number(Number::Int(_)) => text!("整数", "an integer"),
            Value::Number(Number::Float(_)) => text!("数值", "a number"),
            _ => text!("文本", "a text"),
        },
    }
}

/// Returns the text of a node that is a string on the wire.
fn text_of(node: Node<'_>) -> Option<&str> {
    let is_other = scalar::bool(node).is_some() || scalar::number(node).is_some();
    node.as_str().filter(|_| !is_other)
}

/// Returns the number of bytes in a base64 string; `None` if it is malformed.
fn base64_len(text: &str) -> Option<usize> {
    let data = text.trim_end_matches('=');
    let padding = text.len() - data.len();
    let is_digit = |b: u8| b.is_ascii_alphanumeric() || b == b'+' || b == b'/';
    let well_formed = text.len().is_multiple_of(4) && padding <= 2 && data.bytes().all(is_digit);
    well_formed.then(|| text.len() / 4 * 3 - padding)
}
