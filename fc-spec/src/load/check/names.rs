//! Checks that names are distinct and usable in code.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{COMMON, FIELD, GROUP};
use crate::load::draft::{Draft, Origin, Sourced};
use crate::model::{BodyField, Direction, EnvelopeField, Field, Kind, Text};
use crate::names;
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use std::collections::{HashMap, HashSet};

/// Checks that each file has its own group.
pub(super) fn check_groups(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for group in &draft.groups {
        let id = group.item.id.as_str();
        let span = group.origin.at(GROUP.id);
        if let Some(earlier) = first.insert(id, span) {
            let message = text!(
                "有两个文件定义了分组 `{id}`",
                "two files define a group `{id}`"
            );
            let fault = Diagnostic::error(FaultCode::DuplicateGroup, span, message);
            faults.push(fault.also_first(earlier));
        }
    }
}

/// Names of vector files that belong to no operation. The other vector files are named after their operation.
const RESERVED_OPERATIONS: [&str; 2] = ["frames", "bodies"];

/// Checks that all operations have different names, regardless of kind.
pub(super) fn check_operations(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for operation in &draft.operations {
        let name = operation.item.name.as_str();
        let span = operation.origin.name();
        if RESERVED_OPERATIONS.contains(&name) {
            faults.push(reserved(
                span,
                text!(
                    "接口不能名为 `{name}`：`{name}.json` 存放不属于任何接口的标准帧",
                    "an operation cannot be named `{name}`: `{name}.json` holds golden frames without an operation"
                ),
            ));
        }
        let earlier = *first.entry(name).or_insert(span);
        if earlier != span {
            let message = text!(
                "有两个接口都叫 `{name}`",
                "two operations are named `{name}`"
            );
            let fault = Diagnostic::error(FaultCode::DuplicateOperation, span, message);
            faults.push(fault.also_first(earlier));
        }
    }
}

/// Checks names that become file names: groups, operations and types. Windows reserves some names for devices, in any
/// case and with any extension.
pub(super) fn check_files(draft: &Draft<'_>, faults: &mut Faults) {
    let groups = draft.groups.iter();
    let groups = groups.map(|it| (it.item.id.as_str(), it.origin.at(GROUP.id)));
    let operations = draft.operations.iter();
    let operations = operations.map(|it| (it.item.name.as_str(), it.origin.name()));
    let types = draft.types.iter().filter(|it| it.def.body_of.is_none());
    let types = types.map(|it| (it.def.name.as_str(), it.origin.name()));
    for (name, span) in groups.chain(operations).chain(types) {
        if names::is_device(name) {
            let message = text!(
                "Windows 不允许名为 `{name}` 的文件",
                "Windows allows no file named `{name}`"
            );
            faults.push(reserved(span, message));
        }
    }
}

/// Checks that all tables have different ids.
pub(super) fn check_tables(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for table in &draft.tables {
        let span = table.origin.name();
        if let Some(earlier) = first.insert(&table.item.id, span) {
            let message = text!(
                "有两个常量表都叫 `{id}`",
                "two tables are named `{id}`",
                id = table.item.id
            );
            let fault = Diagnostic::error(FaultCode::DuplicateTable, span, message);
            faults.push(fault.also_first(earlier));
        }
    }
}

/// Checks that all types have different names, whether declared or made for a body.
pub(super) fn check_types(draft: &Draft<'_>, faults: &mut Faults) {
    let mut repeated_operations = HashSet::new();
    for (index, ty) in draft.types.iter().enumerate() {
        let first = draft.type_index.get(&ty.def.name);
        let first = first.filter(|first| **first != index);
        let Some(earlier) = first.and_then(|first| draft.types.get(*first)) else {
            continue;
        };
        // Operations with the same name have an error, which also covers the types made for them.
        if let (Some(body), Some(other)) = (&ty.def.body_of, &earlier.def.body_of)
            && body.operation == other.operation
            && body.path.is_empty()
        {
            repeated_operations.insert(body.operation.as_str());
        }
        if let Some(body) = &ty.def.body_of
            && repeated_operations.contains(body.operation.as_str())
        {
            continue;
        }
        let name = &ty.def.name;
        let message = text!("有两个类型都叫 `{name}`", "two types are named `{name}`");
        let fault = Diagnostic::error(FaultCode::DuplicateType, ty.origin.name(), message)
            .also(earlier.origin.name(), text!("第一个", "the first one"));
        let made = ty.def.body_of.is_some() || earlier.def.body_of.is_some();
        faults.push(if made {
            fault.note(text!("消息体和内嵌对象的类型以接口和各级键名命名；给内嵌对象写 `type_name` 可以改名", "bodies and inline objects are named after the operation and their keys; write `type_name` to rename an inline object"))
        } else {
            fault
        });
    }
}

fn reserved(span: Span, message: Text) -> Diagnostic {
    Diagnostic::error(FaultCode::ReservedName, span, message)
        .note(text!("换一个名称", "choose another name"))
}

/// Checks that fields of a struct have distinct names in code.
pub(super) fn check_fields(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, (&Field, Span)> = HashMap::new();
    for ty in &draft.types {
        first.clear();
        for (field, part) in ty.fields() {
            let span = part.origin.name();
            if !names::is_snake(&field.name) {
                // A malformed `name` has its own error.
                if COMMON.name.of(part.origin.node).is_none() {
                    faults.push(unusable(&field.wire, span));
                }
                continue;
            }
            let (earlier, at) = *first.entry(&field.name).or_insert((field, span));
            if at != span {
                let message = text!(
                    "`{first}` 和 `{second}` 在代码中都叫 `{name}`",
                    "`{first}` and `{second}` are both named `{name}` in code",
                    first = earlier.wire,
                    second = field.wire,
                    name = field.name
                );
                faults.push(
                    Diagnostic::error(FaultCode::DuplicateFieldName, span, message)
                        .also_first(at)
                        .note(text!("给其中一个写上 `name`", "give one of them a `name`")),
                );
            }
        }
    }
}

/// Returns the error for a wire name with invisible characters.
pub(super) fn hidden(wire: &str, span: Span) -> Option<Diagnostic> {
    let message = text!(
        "名称中有看不见的字符",
        "the name contains an invisible character"
    );
    (!names::is_line(wire)).then(|| Diagnostic::error(FaultCode::HiddenCharacter, span, message))
}

/// Returns the error for a wire name that yields no name in code.
pub(super) fn unusable(wire: &str, span: Span) -> Diagnostic {
    let message = text!(
        "从 `{wire}` 得不出代码中的名称",
        "no name in code can be derived from `{wire}`"
    );
    let fault = Diagnostic::error(FaultCode::UnusableName, span, message);
    fault.note(text!("给它写上 `name`", "give it a `name`"))
}

/// Checks that a wire key or alternative spelling occurs once in a struct, and not in the envelope of the same object.
pub(super) fn check_wire_keys(draft: &Draft<'_>, faults: &mut Faults) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    let operations = draft.operations.iter().map(|operation| &operation.item);
    let streams = operations.filter(|operation| operation.kind() == Kind::Stream);
    let streams: HashSet<&str> = streams.map(|stream| stream.name.as_str()).collect();
    for ty in &draft.types {
        first.clear();
        let body = ty.def.body_of.as_ref();
        // The frame of a stream has no envelope.
        let body = body.filter(|body| !streams.contains(body.operation.as_str()));
        let envelope = envelope_of(draft, body);
        let keys = ty.fields().flat_map(|(field, part)| {
            std::iter::once((field.wire.as_str(), part.origin.name()))
                .chain(also(field, part.origin))
        });
        for (key, span) in keys {
            if key.is_empty() {
                let message = text!("报文中的键名不能为空", "a wire key cannot be empty");
                faults.push(Diagnostic::error(FaultCode::UnusableName, span, message));
                continue;
            }
            faults.extend(hidden(key, span));
            let earlier = *first.entry(key).or_insert(span);
            if earlier != span {
                let message = text!(
                    "报文中的键名 `{key}` 在对象中出现两次",
                    "the wire key `{key}` occurs twice in the object"
                );
                let fault = Diagnostic::error(FaultCode::DuplicateWireKey, span, message);
                faults.push(fault.also_first(earlier));
                continue;
            }
            let declared = envelope.iter().find(|field| field.item.wire == key);
            if let Some(declared) = declared {
                let message = text!(
                    "`{key}` 是公共字段的键，不能写在消息体中",
                    "`{key}` is a key of the envelope and cannot be in a body"
                );
                let fault = Diagnostic::error(FaultCode::EnvelopeKey, span, message);
                faults.push(fault.also_declared(declared.origin.name()));
            }
        }
    }
}

fn also<'f>(field: &'f Field, origin: Origin<'_>) -> impl Iterator<Item = (&'f str, Span)> {
    let also = &field.details().also;
    let node = (!also.is_empty()).then_some(origin.node);
    let spans = FIELD.also.items(node).map(Node::span);
    also.iter().map(String::as_str).zip(spans)
}

/// Returns the envelope fields that share the object of a body.
fn envelope_of<'d, 'a>(
    draft: &'d Draft<'a>,
    body: Option<&BodyField>,
) -> &'d [Sourced<'a, EnvelopeField>] {
    match (&draft.envelope, body) {
        (Some(envelope), Some(body)) if body.path.is_empty() => match body.side {
            Direction::Request => &envelope.request,
            Direction::Response => &envelope.response,
        },
        _ => &[],
    }
}

/// Checks names that become variants of one Rust enum, where no two may have the same spelling.
pub(super) fn check_distinct<'n>(
    what: &Text,
    named: impl IntoIterator<Item = (&'n str, Span)>,
    faults: &mut Faults,
) {
    let mut first: HashMap<String, (&str, Span)> = HashMap::new();
    for (name, span) in named {
        if name.is_empty() {
            continue;
        }
        let (earlier, at) = *first.entry(names::pascal(name)).or_insert((name, span));
        if at != span {
            let message = if earlier == name {
                text!(
                    "有两个{what}都叫 `{name}`",
                    "two {what} are named `{name}`",
                    what = what
                )
            } else {
                text!(
                    "`{earlier}` 和 `{name}` 在代码中是同一个名称",
                    "`{earlier}` and `{name}` are the same name in code"
                )
            };
            let fault = Diagnostic::error(FaultCode::DuplicateName, span, message);
            faults.push(fault.also_first(at));
        }
    }
}
