//! Checks that referenced names exist.

use super::iter::fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::{
    Constants, DEPRECATED, FIELD, FILE, Named, OPERATION, ResultCode, Struct,
};
use crate::language::scalar;
use crate::load::draft::{Draft, Origin};
use crate::model::{ResultRole, Text, Type, TypeRef, TypeShape};
use crate::source::Span;
use crate::syntax::{Node, Style};
use crate::text;
use std::collections::HashMap;

/// Maximum number of errors with a suggestion. A suggestion compares all names, which is slow for a spec with many
/// errors.
const SUGGESTIONS: usize = 100;

/// Checks that every named type of a field exists.
pub(super) fn check_types(draft: &Draft<'_>, faults: &mut Faults) {
    let fields = fields(draft).map(|(_, field, part)| (&field.ty, part.origin));
    let envelope = draft.envelope.iter();
    let envelope = envelope.flat_map(|envelope| envelope.request.iter().chain(&envelope.response));
    let envelope = envelope.map(|field| (&field.item.ty, field.origin));
    // An unknown name in several fields counts as one error, because one declaration or one rename fixes them all.
    let mut order: Vec<&str> = Vec::new();
    let mut found: HashMap<&str, Vec<Node<'_>>> = HashMap::new();
    for (ty, origin) in fields.chain(envelope) {
        let name = ty.innermost().map(TypeRef::name);
        let Some(name) = name.filter(|name| draft.type_named(name).is_none()) else {
            continue;
        };
        let nodes = found.entry(name).or_default();
        if nodes.is_empty() {
            order.push(name);
        }
        nodes.push(innermost(origin));
    }
    for name in order {
        let mut nodes = found.remove(name).into_iter().flatten();
        let Some(first) = nodes.next() else { continue };
        let fault = unknown_type(draft, name, first, faults);
        faults.push(nodes.fold(fault, |fault, node| {
            let fault = fault.also(node.span(), text!("这里也用到", "also used here"));
            match spelled(node, name) {
                Some(span) => fault.fix_also(span),
                None => fault,
            }
        }));
    }
}

/// Returns the scalar that names the type, inside any YAML lists around it.
fn innermost(origin: Origin<'_>) -> Node<'_> {
    let mut node = FIELD.r#type.of(origin.node).unwrap_or(origin.node);
    loop {
        let mut items = node.items();
        let (Some(item), None) = (items.next(), items.next()) else {
            return node;
        };
        node = item;
    }
}

fn unknown_type(draft: &Draft<'_>, name: &str, node: Node<'_>, faults: &Faults) -> Diagnostic {
    let message = text!("没有类型 `{name}`", "there is no type `{name}`");
    let span = node.span();
    let fault = Diagnostic::error(FaultCode::UnknownType, span, message);
    if faults.errors() >= SUGGESTIONS {
        return fault;
    }
    let declared = draft.types.iter().filter(|ty| ty.def.body_of.is_none());
    let names = declared.map(|ty| ty.def.name.as_str());
    let foreign = FOREIGN
        .iter()
        .find(|(foreign, _)| foreign.eq_ignore_ascii_case(name));
    let near = foreign
        .map(|(_, near)| *near)
        .or_else(|| nearest(name, names.chain(Type::built_in())));
    let Some(near) = near else {
        return fault.note(text!("在 `types:` 下声明", "declare it under `types:`"));
    };
    let message = text!("是否想写 `{near}`？", "did you mean `{near}`?");
    match spelled(node, name) {
        Some(span) => fault.fix(span, near, message),
        None => fault.note(message),
    }
}

/// Returns the span of a name at the start of a scalar, unless the scalar has escapes.
fn spelled(node: Node<'_>, name: &str) -> Option<Span> {
    let scalar = node.as_scalar()?;
    let Span { file, start, end } = node.span();
    let is_verbatim = end - start == scalar.text.len() + 2;
    let start = match scalar.style {
        _ if !scalar.text.starts_with(name) => return None,
        Style::Plain => start,
        Style::Quoted if is_verbatim => start + 1,
        Style::Quoted | Style::Block => return None,
    };
    Some(Span::new(file, start, start + name.len()))
}

/// Names of the built-in types in other languages.
const FOREIGN: &[(&str, &str)] = &[
    ("boolean", "bool"),
    ("byte", "u8"),
    ("bytes", "base64"),
    ("double", "f64"),
    ("float", "f32"),
    ("float32", "f32"),
    ("float64", "f64"),
    ("int", "i32"),
    ("int8", "i8"),
    ("int16", "i16"),
    ("int32", "i32"),
    ("int64", "i64"),
    ("integer", "i32"),
    ("long", "i64"),
    ("number", "f64"),
    ("object", "json"),
    ("any", "json"),
    ("short", "i16"),
    ("str", "string"),
    ("text", "string"),
    ("uint8", "u8"),
    ("uint16", "u16"),
    ("uint32", "u32"),
    ("uint64", "u64"),
];

/// Checks that variants of a choice and rows of a table are structs.
pub(super) fn check_structs(draft: &Draft<'_>, faults: &mut Faults) {
    for (occurrence, name) in draft.references_to(Struct::KINDS) {
        let node = occurrence.node;
        let fault = match draft.type_named(name) {
            None => unknown_type(draft, name, node, faults),
            Some(ty) if matches!(ty.def.shape, TypeShape::Struct(_)) => continue,
            Some(ty) => {
                let what = if occurrence.part == Constants::NAME {
                    text!("一行", "a row")
                } else {
                    text!("选项", "a variant")
                };
                let message = text!(
                    "{what}应为结构，而 `{name}` 不是",
                    "{what} must be a struct, but `{name}` is not one",
                    what = what
                );
                Diagnostic::error(FaultCode::NotAStruct, node.span(), message)
                    .also_declared(ty.origin.name())
            }
        };
        faults.push(fault);
    }
}

/// Checks that another operation replaces a deprecated one.
pub(super) fn check_operations(draft: &Draft<'_>, faults: &mut Faults) {
    for operation in &draft.operations {
        let deprecated = operation.item.deprecated.as_ref();
        let Some(by) = deprecated.and_then(|deprecated| deprecated.replaced_by.as_deref()) else {
            continue;
        };
        if by == operation.item.name {
            let node = DEPRECATED
                .replaced_by
                .of(OPERATION.deprecated.of(operation.origin.node));
            let span = node.map_or(operation.origin.name(), Node::span);
            let message = text!("接口不能由自己替代", "an operation cannot replace itself");
            let fault = Diagnostic::error(FaultCode::UnknownOperation, span, message);
            faults.push(fault);
        }
    }
}

/// Checks that the error codes of an operation exist.
pub(super) fn check_results(draft: &Draft<'_>, faults: &mut Faults) {
    if !draft.valid.contains_key(FILE.results.name) {
        return;
    }
    for (occurrence, _) in draft.references_to(ResultCode::KINDS) {
        let node = occurrence.node;
        let Some(code) = scalar::small_int::<i64>(node) else {
            continue;
        };
        let mut results = draft.results.iter();
        let fault = match results.find(|result| result.item.code == code) {
            Some(success) if success.item.role == Some(ResultRole::Success) => {
                let message = text!(
                    "{code} 表示成功，不是错误",
                    "{code} means success, not an error"
                );
                Diagnostic::error(FaultCode::SuccessAsError, node.span(), message)
                    .also_declared(success.origin.name())
                    .note(text!(
                        "去掉它：每个接口都可以返回成功",
                        "remove it: every operation can return success"
                    ))
            }
            Some(_) => continue,
            None => {
                let known = draft.results.iter();
                let known = known.map(|result| result.item.code.to_string());
                let message = text!("没有结果码 {code}", "there is no result code {code}");
                Diagnostic::error(FaultCode::UnknownResult, node.span(), message).note(text!(
                    "可以写：{known}",
                    "expected one of {known}",
                    known = Text::listed(known)
                ))
            }
        };
        faults.push(fault);
    }
}
