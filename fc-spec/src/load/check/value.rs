//! Checks that values of the spec could occur in a message.

use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::ambiguous_scalar::misread;
use crate::language::scalar::{self, value};
use crate::load::draft::Draft;
use crate::model::{
    Argument, EnumType, Field, FloatKind, Judged, Number, OneOf, Scalar, StructType, Text, Type,
    TypeShape, Value, WireForm,
};
use crate::source::Span;
use crate::syntax::{Node, NodeKind, quoted};
use crate::text;

/// A mismatch between a value and its type or field.
pub(super) struct Mismatch {
    /// Error code for an example.
    pub code: FaultCode,
    /// The smallest mismatched part.
    pub span: Span,
    /// The message, in one sentence.
    pub message: Text,
    /// The replacement and its description, if known.
    pub fix: Option<(String, Text)>,
}

impl Mismatch {
    fn new(code: FaultCode, node: Node<'_>, message: Text) -> Self {
        Self {
            code,
            span: node.span(),
            message,
            fix: None,
        }
    }

    /// Returns the error for an example.
    pub fn into_fault(self) -> Diagnostic {
        let fault = Diagnostic::error(self.code, self.span, self.message);
        match self.fix {
            Some((replacement, message)) => fault.fix(self.span, replacement, message),
            None => fault,
        }
    }
}

/// Reports mismatches of an example whose type has no field constraints.
pub(super) fn check_plain(draft: &Draft<'_>, ty: &Type, node: Node<'_>, faults: &mut Faults) {
    let mut found = Vec::new();
    check_type(draft, ty, node, &mut found);
    faults.extend(found.into_iter().map(Mismatch::into_fault));
}

/// Collects mismatches of a field's value, which is in wire form.
pub(super) fn check_field(
    draft: &Draft<'_>,
    field: &Field,
    node: Node<'_>,
    found: &mut Vec<Mismatch>,
) {
    let is_unknown = field
        .ty
        .innermost()
        .is_some_and(|ty| !draft.knows(ty.name()));
    if is_doubtful(node) || is_unknown {
        return;
    }
    match (field.wire_form, &field.ty) {
        (WireForm::String, _) => return check_in_string(field, node, found),
        (WireForm::Number, Type::Bool) => return check_bool_as_number(node, found),
        // On any other type `wire: number` is the error, not the value.
        (WireForm::Number | WireForm::Plain, _) => {}
    }
    let before = found.len();
    check_type(draft, &field.ty, node, found);
    // A value of the wrong type breaks every constraint; one error is enough.
    if found.len() == before && field.details.is_some() {
        check_constraints(field, node, &value(node), found);
    }
}

/// Returns `true` for a spelling that YAML readers disagree about. It has its own error.
fn is_doubtful(node: Node<'_>) -> bool {
    node.as_plain()
        .is_some_and(|text| misread(text).is_some() || scalar::has_leading_zero(text))
}

/// Checks a field with `wire: string`, whose string holds a number or bool.
fn check_in_string(field: &Field, node: Node<'_>, found: &mut Vec<Mismatch>) {
    let wrong = |message: Text| Mismatch::new(FaultCode::ExampleType, node, message);
    let Some(Value::String(text)) = Some(value(node)) else {
        let mut mismatch = wrong(text!(
            "应为字符串：这个字段以字符串发送",
            "expected a string: the field is sent as one"
        ));
        mismatch.fix = node
            .as_plain()
            .map(|text| (quoted(text), text!("加上引号", "quote it")));
        found.push(mismatch);
        return;
    };
    let inner = match (&field.ty, text.as_str()) {
        // A bool has no constraints.
        (Type::Bool, "true" | "false") => return,
        (Type::Bool, _) => {
            found.push(wrong(text!(
                "应为 \"true\" 或 \"false\"",
                "expected \"true\" or \"false\""
            )));
            return;
        }
        (_, text) => {
            let number = scalar::number_text(text).filter(|_| !text.contains('x'));
            let Some(number) = number else {
                found.push(wrong(text!(
                    "字符串中应为十进制数值",
                    "expected a decimal number inside the string"
                )));
                return;
            };
            Value::Number(number)
        }
    };
    let before = found.len();
    check_number(&field.ty, &inner, node, found);
    if found.len() == before {
        check_constraints(field, node, &inner, found);
    }
}

/// Checks a field with `wire: number`: 1 is true, 0 is false. A bool has no constraints.
fn check_bool_as_number(node: Node<'_>, found: &mut Vec<Mismatch>) {
    let held = value(node);
    if matches!(held, Value::Number(Number::Int(0 | 1))) {
        return;
    }
    let message = text!(
        "应为 1 或 0：这个字段以数值发送",
        "expected 1 or 0: the field is sent as a number"
    );
    let mut mismatch = Mismatch::new(FaultCode::ExampleType, node, message);
    mismatch.fix = match held {
        Value::Bool(truth) => {
            let number = u8::from(truth).to_string();
            let message = text!("改写为 `{number}`", "write `{number}`");
            Some((number, message))
        }
        _ => None,
    };
    found.push(mismatch);
}

/// Collects mismatches between a value and a type.
pub(super) fn check_type(draft: &Draft<'_>, ty: &Type, node: Node<'_>, found: &mut Vec<Mismatch>) {
    if is_doubtful(node) {
        return;
    }
    let wrong = |expected: Text| {
        let message = text!(
            "应为{expected}，实际为{found}",
            "expected {expected}, found {found}",
            found = describe(node),
            expected = expected.spaced()
        );
        Mismatch::new(FaultCode::ExampleType, node, message)
    };
    match ty {
        Type::Json => {}
        Type::Bool => {
            if scalar::bool(node).is_none() {
                found.push(wrong(text!("`true` 或 `false`", "`true` or `false`")));
            }
        }
        Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS => {
            check_number(ty, &value(node), node, found);
        }
        Type::String | Type::Base64 => {
            let Some(text) = text_of(node) else {
                let mut mismatch = wrong(text!("文本", "text"));
                mismatch.fix = node
                    .as_plain()
                    .map(|text| (quoted(text), text!("加上引号", "quote it")));
                found.push(mismatch);
                return;
            };
            if *ty == Type::Base64 && base64_len(text).is_none() {
                found.push(wrong(text!(
                    "base64（RFC 4648，带填充）",
                    "base64 (RFC 4648 with padding)"
                )));
            }
        }
        Type::Array(item) => match node.as_sequence() {
            Some(items) => items.for_each(|node| check_type(draft, item, node, found)),
            None => found.push(wrong(text!("列表", "a list"))),
        },
        Type::Named(named) if !draft.knows(named.name()) => {}
        Type::Named(named) => match draft.type_named(named.name()).map(|ty| &ty.def.shape) {
            Some(TypeShape::Enum(shape)) => check_enum(named.name(), shape, node, found),
            Some(TypeShape::Struct(shape)) => check_struct(draft, shape, node, found),
            Some(TypeShape::OneOf(choice)) => check_one_of(draft, choice, node, found),
            None => {}
        },
    }
}

fn check_number(ty: &Type, value: &Value, node: Node<'_>, found: &mut Vec<Mismatch>) {
    let mismatch = |message: Text| Mismatch::new(FaultCode::ExampleType, node, message);
    let Value::Number(number) = value else {
        let expected = match ty {
            Type::Float(_) => text!("数值", "a number"),
            _ => text!("整数", "an integer"),
        };
        let mut mismatch = mismatch(text!(
            "应为{expected}，实际为{found}",
            "expected {expected}, found {found}",
            found = describe(node),
            expected = expected
        ));
        let text = node.as_str().unwrap_or_default();
        if node.as_plain().is_none() && scalar::number_text(text).is_some() {
            mismatch.fix = Some((text.to_owned(), text!("去掉引号", "remove the quotes")));
        }
        found.push(mismatch);
        return;
    };
    let range = match ty {
        Type::Int(kind) => kind.range(),
        Type::Float(kind) => {
            if *kind == FloatKind::F32 && scalar::float(number).abs() > f64::from(f32::MAX) {
                found.push(mismatch(text!(
                    "超出 f32 的范围",
                    "this value does not fit into f32"
                )));
            }
            return;
        }
        _ => (i64::MIN.into(), i64::MAX.into()),
    };
    match number {
        Number::Int(value) if (range.0..=range.1).contains(value) => {}
        Number::Int(value) => found.push(mismatch(text!(
            "{value} 不在 {least}..={most} 之内",
            "{value} is outside {least}..={most}",
            least = range.0,
            most = range.1
        ))),
        Number::Float(_) => {
            found.push(mismatch(text!(
                "应为整数，实际为小数",
                "expected an integer, found a fraction"
            )));
        }
    }
}

fn check_enum(name: &str, shape: &EnumType, node: Node<'_>, found: &mut Vec<Mismatch>) {
    let wire = match value(node) {
        Value::Number(number) => Scalar::Number(number),
        Value::String(text) => Scalar::String(text),
        _ => {
            let message = text!(
                "应为 `{name}` 的取值，实际为{found}",
                "expected a value of `{name}`, found {found}",
                found = describe(node)
            );
            found.push(Mismatch::new(FaultCode::ExampleType, node, message));
            return;
        }
    };
    if shape.values.is_empty() || shape.values.iter().any(|value| value.wire == wire) {
        return;
    }
    let text = node.as_str().unwrap_or_default();
    let message = text!(
        "`{text}` 不是 `{name}` 的取值",
        "`{text}` is not a value of `{name}`"
    );
    let mut mismatch = Mismatch::new(FaultCode::ExampleValue, node, message);
    // Often the spec has the name in code instead of the wire value.
    let named = shape.values.iter().find(|value| value.name == text);
    mismatch.fix = named.map(|value| {
        let spelling = match &value.wire {
            Scalar::Number(Number::Int(number)) => number.to_string(),
            Scalar::String(text) => quoted(text),
            Scalar::Bool(_) | Scalar::Number(Number::Float(_)) => text.to_owned(),
        };
        let message = text!(
            "`{text}` 是它的名称；发送的值是 {spelling}",
            "`{text}` is its name; the value sent is {spelling}"
        );
        (spelling, message)
    });
    found.push(mismatch);
}

fn check_struct(draft: &Draft<'_>, shape: &StructType, node: Node<'_>, found: &mut Vec<Mismatch>) {
    let Some(entries) = node.as_mapping() else {
        let message = text!(
            "应为对象，实际为{found}",
            "expected an object, found {found}",
            found = describe(node)
        );
        found.push(Mismatch::new(FaultCode::ExampleType, node, message));
        return;
    };
    for entry in entries {
        let name = entry.name();
        if let Some(field) = shape.fields.iter().find(|field| field.wire == name) {
            check_field(draft, field, entry.value, found);
            continue;
        }
        let message = text!("对象没有键 `{name}`", "the object has no key `{name}`");
        let mut mismatch = Mismatch::new(FaultCode::ExampleType, entry.key, message);
        let keys = shape.fields.iter().map(|field| field.wire.as_str());
        mismatch.fix = nearest(name, keys).map(|near| {
            (
                near.to_owned(),
                text!("是否想写 `{near}`？", "did you mean `{near}`?"),
            )
        });
        found.push(mismatch);
    }
    let required = shape.fields.iter().filter(|field| !field.optional);
    for field in required.filter(|field| node.get(&field.wire).is_none()) {
        let message = text!(
            "缺少必填的键 `{key}`",
            "the required key `{key}` is missing",
            key = field.wire
        );
        found.push(Mismatch::new(FaultCode::ExampleType, node, message));
    }
}

/// Checks the first variant whose required keys are all present, like a decoder.
fn check_one_of(draft: &Draft<'_>, choice: &OneOf, node: Node<'_>, found: &mut Vec<Mismatch>) {
    let shapes = choice.variants.iter().filter_map(|variant| {
        match &draft.type_named(variant.ty.name())?.def.shape {
            TypeShape::Struct(shape) => Some(shape),
            _ => None,
        }
    });
    let is_taken = |shape: &&StructType| {
        let mut required = shape.fields.iter().filter(|field| !field.optional);
        node.as_mapping().is_some() && required.all(|field| node.get(&field.wire).is_some())
    };
    match shapes.into_iter().find(is_taken) {
        Some(shape) => check_struct(draft, shape, node, found),
        None => found.push(Mismatch::new(
            FaultCode::ExampleType,
            node,
            text!(
                "没有任何一个选项的全部必填键",
                "the object lacks the required keys of every variant"
            ),
        )),
    }
}

/// Collects the constraints of the field that a value of the correct type breaks.
pub(super) fn check_constraints(
    field: &Field,
    node: Node<'_>,
    value: &Value,
    found: &mut Vec<Mismatch>,
) {
    let constraints = &field.details().constraints;
    let Some(value) = judged(&field.ty, value) else {
        return;
    };
    // Inverted bounds admit no value, so they are not applied.
    if constraints.is_inverted() && matches!(value, Judged::Number(_)) {
        return;
    }
    found.extend(constraints.iter().filter_map(|constraint| {
        let message = constraint.broken(&value)?;
        let code = match constraint.argument() {
            Argument::Number(_) => FaultCode::ExampleRange,
            Argument::Range(..) => FaultCode::ExampleLength,
            Argument::Pattern(_) => FaultCode::ExamplePattern,
            Argument::Values(_) => FaultCode::ExampleValue,
        };
        Some(Mismatch::new(code, node, message))
    }));
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
