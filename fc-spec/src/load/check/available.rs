//! Checks limits of availability: they use declared words and leave every audience a complete protocol.

use super::iter::fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{AVAILABLE, COMMON, FIELD};
use crate::load::draft::Draft;
use crate::model::{Available, Declared, Scalar, Text, TypeShape};
use crate::names;
use crate::source::Span;
use crate::syntax::Node;
use crate::text;
use std::collections::HashSet;

/// A limit and its place.
struct Limit<'d, 'a> {
    available: &'d Available,
    node: Node<'a>,
    /// The operation whose body contains the limit; `None` in a shared type.
    within: Option<&'d str>,
}

/// Returns every limit of a spec.
fn limits<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = Limit<'d, 'a>> {
    let operations = draft.operations.iter().filter_map(|operation| {
        Some(Limit {
            available: operation.item.available.as_ref()?,
            node: COMMON.available.of(operation.origin.node)?,
            within: None,
        })
    });
    let parts = draft.types.iter().flat_map(|ty| {
        let available: Vec<Option<&Available>> = match &ty.def.shape {
            TypeShape::Struct(shape) => {
                let fields = shape.fields.iter();
                fields.map(|it| it.details().available.as_ref()).collect()
            }
            TypeShape::Enum(shape) => shape
                .values
                .iter()
                .map(|it| it.available.as_ref())
                .collect(),
            TypeShape::OneOf(choice) => {
                let variants = choice.variants.iter();
                variants.map(|it| it.available.as_ref()).collect()
            }
        };
        let within = ty.def.body_of.as_ref().map(|body| body.operation.as_str());
        available
            .into_iter()
            .zip(&ty.parts)
            .filter_map(move |(available, part)| {
                Some(Limit {
                    available: available?,
                    node: COMMON.available.of(part.origin.node)?,
                    within,
                })
            })
    });
    operations.chain(parts)
}

/// The words of one kind in a limit: each name with its place.
type Named<'a> = Vec<(&'a str, Span)>;

/// Skips malformed names, which the shape check reports.
fn named<'a>(nodes: impl Iterator<Item = Node<'a>>) -> Named<'a> {
    let names = nodes.filter_map(|node| Some((node.as_str()?, node.span())));
    names.filter(|(name, _)| names::is_snake(name)).collect()
}

fn names_of(declared: &[Declared]) -> HashSet<&str> {
    declared.iter().map(|it| it.name.as_str()).collect()
}

/// Checks that no limit is empty or names every audience.
pub(super) fn check_limits(draft: &Draft<'_>, faults: &mut Faults) {
    let all = names_of(&draft.plain.availability.audiences);
    for Limit {
        available, node, ..
    } in limits(draft)
    {
        if node
            .as_mapping()
            .is_some_and(|entries| entries.count() == 0)
        {
            let message = text!("`available` 为空", "`available` is empty");
            let fault = Diagnostic::error(FaultCode::LimitsNothing, node.span(), message);
            faults.push(fault.note(text!(
                "删除它，或写 `for`、`hardware`、`from`、`until`",
                "delete it, or write `for`, `hardware`, `from` or `until`"
            )));
        }
        let said: HashSet<&str> = available.audiences.iter().map(String::as_str).collect();
        if !said.is_empty() && !all.is_empty() && all.is_subset(&said) {
            let span = AVAILABLE.r#for.of(node).map_or(node.span(), Node::span);
            let message = text!(
                "`for` 列出了所有受众，等于没有限制",
                "`for` names every audience, which limits nothing"
            );
            let fault = Diagnostic::error(FaultCode::LimitsNothing, span, message);
            faults.push(fault.note(text!(
                "删除它：不写 `available` 就是面向所有受众",
                "delete it: without `available`, a thing is for all audiences"
            )));
        }
    }
}

/// Checks that a field with a limit is optional. Peers outside the limit neither send nor receive it.
pub(super) fn check_optional(draft: &Draft<'_>, faults: &mut Faults) {
    for (_, field, part) in fields(draft) {
        if field.optional || field.details().available.is_none() {
            continue;
        }
        let message = text!(
            "`{field}` 写了 `available`，却是必填",
            "`{field}` has `available`, but is required",
            field = field.wire
        );
        let span = part.origin.key_at(COMMON.available);
        faults.push(
            Diagnostic::error(FaultCode::LimitedButRequired, span, message)
                .also(part.ty, text!("在这里写成必填", "required here"))
                .note(text!("改为可选", "make it optional")),
        );
    }
}

/// Checks that a part of a body is limited to audiences of its operation.
pub(super) fn check_within(draft: &Draft<'_>, faults: &mut Faults) {
    for limit in limits(draft) {
        let mut operations = draft.operations.iter();
        let operation = limit
            .within
            .and_then(|name| operations.find(|it| it.item.name == name));
        let Some((operation, outer)) =
            operation.and_then(|it| Some((it, it.item.available.as_ref()?)))
        else {
            continue;
        };
        for (name, span) in named(AVAILABLE.r#for.items(limit.node)) {
            if outer.is_for(name) || !names_of(&draft.plain.availability.audiences).contains(name) {
                continue;
            }
            let message = text!(
                "`{operation}` 不面向 `{name}`",
                "`{operation}` is not for `{name}`",
                operation = operation.item.name
            );
            let fault = Diagnostic::error(FaultCode::LimitBeyondOperation, span, message);
            let span = operation.origin.key_at(COMMON.available);
            faults.push(fault.also(span, text!("接口自身的限制", "the operation's own limit")));
        }
    }
}

/// Checks that every audience keeps one value of each enum and each `only`, and two variants of each choice.
pub(super) fn check_left(draft: &Draft<'_>, faults: &mut Faults) {
    let has = |available: Option<&Available>, audience: &str| {
        available.is_none_or(|available| available.is_for(audience))
    };
    for audience in &draft.plain.availability.audiences {
        let name = audience.name.as_str();
        let mut report = |span: Span, what: Text| {
            let message = text!(
                "受众 `{name}` 没有{what}",
                "the audience `{name}` has no {what}",
                what = what
            );
            faults.push(Diagnostic::error(FaultCode::NothingLeft, span, message));
        };
        for ty in &draft.types {
            let span = ty.origin.name();
            let body = ty.def.body_of.as_ref();
            let mut operations = draft.operations.iter();
            let within = body.and_then(|body| operations.find(|it| it.item.name == body.operation));
            if !has(within.and_then(|it| it.item.available.as_ref()), name) {
                continue;
            }
            match &ty.def.shape {
                TypeShape::Enum(shape) if !shape.values.is_empty() => {
                    let mut values = shape.values.iter();
                    if !values.any(|value| has(value.available.as_ref(), name)) {
                        report(span, text!("这个枚举的取值", "value of this enum"));
                    }
                }
                TypeShape::OneOf(choice) => {
                    let all = choice.variants.iter();
                    let left = all.filter(|it| has(it.available.as_ref(), name)).count();
                    if left < 2 && left < choice.variants.len() {
                        report(
                            span,
                            text!("这个多选一的两个选项", "two variants of this choice"),
                        );
                    }
                }
                TypeShape::Enum(_) | TypeShape::Struct(_) => {}
            }
        }
        for (_, field, part) in fields(draft) {
            let Some(TypeShape::Enum(shape)) = draft.shape(field.ty.item()) else {
                continue;
            };
            let knows = |wire: &Scalar| {
                let mut values = shape.values.iter();
                let value = values.find(|value| value.wire == *wire);
                has(value.and_then(|value| value.available.as_ref()), name)
            };
            let details = field.details();
            let is_for = has(details.available.as_ref(), name);
            if is_for
                && !details.constraints.only.is_empty()
                && !details.constraints.only.iter().any(knows)
            {
                report(
                    part.origin.at(FIELD.only),
                    text!("这个字段可取的值", "value that this field takes"),
                );
            }
        }
    }
}

/// Checks that releases are numbers joined by dots, and that the last is not before the first.
pub(super) fn check_releases(draft: &Draft<'_>, faults: &mut Faults) {
    for Limit { node, .. } in limits(draft) {
        let (from, until) = (AVAILABLE.from.get(node), AVAILABLE.until.get(node));
        for release in from.clone().chain(until.clone()).map(|entry| entry.value) {
            if release.as_str().is_some_and(|text| numbers(text).is_none()) {
                let message = text!(
                    "版本号应由整数和点组成",
                    "a release number consists of whole numbers joined by dots"
                );
                let span = release.span();
                let fault = Diagnostic::error(FaultCode::BadRelease, span, message);
                faults.push(fault.note(text!("例如 \"3.8\"", "such as \"3.8\"")));
            }
        }
        for last in until {
            let first = from.clone().find(|first| first.name() == last.name());
            let number = |node: Node<'_>| numbers(node.as_str()?);
            if let Some(first) = first
                && let (Some(earliest), Some(latest)) = (number(first.value), number(last.value))
                && latest < earliest
            {
                let message = text!("`until` 早于 `from`", "`until` is earlier than `from`");
                let span = last.value.span();
                let fault = Diagnostic::error(FaultCode::ReleasesOutOfOrder, span, message);
                faults
                    .push(fault.also(first.value.span(), text!("`from` 在这里", "`from` is here")));
            }
        }
    }
}

/// Returns the numbers of a release without trailing zeros, which do not affect the order.
fn numbers(release: &str) -> Option<Vec<u64>> {
    let number = |part: &str| {
        let is_number = !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| part.parse().ok())?
    };
    let mut numbers: Vec<u64> = release.split('.').map(number).collect::<Option<_>>()?;
    while numbers.last() == Some(&0) {
        numbers.pop();
    }
    Some(numbers)
}
