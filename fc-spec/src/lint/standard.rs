//! STANDARD: rules that make a protocol easy to use.

use super::finding::Finding;
use super::rule::rules;
use super::search::{Search, Subject};
use crate::model::{BodyState, Effect, Exchange, Field, Operation, Text, Type, TypeDef};
use crate::names::snake;
use crate::text;
use std::collections::BTreeMap;

rules! { Standard
    FC0811 "empty-answer" Warning empty_answer "读取却没有响应内容的指令" "reading command with an empty response";
    FC0812 "number-without-unit" Off number_without_unit "没有单位的小数" "fraction without a unit";
    FC0813 "id-without-entity" Off id_without_entity "没有写明实体的 ID" "ID without an entity";
    FC0814 "key-in-two-units" Warning one_key_two_units "同一个键有两种单位" "one key in two units";
    FC0815 "negative-bool" Warning negative_bool "名称为否定式的布尔值" "bool with a negative name";
    FC0816 "list-in-singular" Off list_in_singular "用单数命名的列表" "list with a singular name";
    FC0817 "report-without-cadence" Warning report_without_cadence "没有上报时机的上报" "report without a cadence";
    FC0818 "motion-without-process" Warning motion_without_process "没有任何条件和后续的运动指令" "motion without preconditions and reports";
    FC0819 "key-of-two-types" Off one_key_two_types "同一个键有两种类型" "one key of two types";
    FC0820 "code-of-other-group" Warning code_of_other_group "功能码在其他分组的号段内" "code in the range of another group";
}

fn empty_answer(search: &mut Search<'_>) {
    let types = &search.model.types;
    let is_empty = |operation: &Operation| {
        let Exchange::Command {
            effect: Effect::Read,
            messages,
            ..
        } = &operation.exchange
        else {
            return false;
        };
        let state = messages.response.state;
        types.structure(&messages.response.ty).fields.is_empty()
            && !matches!(state, BodyState::Open | BodyState::Free)
    };
    search.report_operations(is_empty, |name| {
        text!(
            "`{name}` 的影响是 `read`，响应却没有键",
            "`{name}` has the effect `read`, but its response has no keys"
        )
    });
}

fn number_without_unit(search: &mut Search<'_>) {
    let lacks_unit =
        |field: &Field| matches!(field.ty.item(), Type::Float(_)) && field.details().unit.is_none();
    search.report_fields(lacks_unit, |key| {
        text!(
            "`{key}` 是小数，但没有单位",
            "`{key}` is a fraction without a unit"
        )
    });
}

fn id_without_entity(search: &mut Search<'_>) {
    let lacks_entity = |field: &Field| {
        let name = snake(&field.wire);
        let is_id = matches!(name.rsplit('_').next(), Some("id" | "ids" | "uuid"));
        let may_be_one = matches!(field.ty.item(), Type::Int(_) | Type::String);
        is_id && may_be_one && field.details().refers.is_none()
    };
    search.report_fields(lacks_entity, |key| {
        text!("`{key}` 没有 `refers`", "`{key}` has no `refers`")
    });
}

/// Returns one map per wire key with several different facts, from each fact to the first field that has it.
fn by_key<'m, T: Ord>(
    search: &Search<'m>,
    fact: impl Fn(&'m Field) -> Option<T>,
) -> Vec<BTreeMap<T, (&'m TypeDef, &'m Field)>> {
    let mut keys: BTreeMap<&str, BTreeMap<T, (&TypeDef, &Field)>> = BTreeMap::new();
    for (ty, field) in search.fields() {
        if let Some(fact) = fact(field) {
            let ways = keys.entry(&field.wire).or_default();
            ways.entry(fact).or_insert((ty, field));
        }
    }
    keys.into_values().filter(|ways| ways.len() > 1).collect()
}

fn several(search: &mut Search<'_>, ways: Vec<(&str, (&TypeDef, &Field))>, what: [&str; 2]) {
    let mut ways = ways.into_iter();
    let Some((first, (first_type, first_field))) = ways.next() else {
        return;
    };
    let [en, zh] = what;
    for (other, (ty, field)) in ways {
        let message = text!(
            "`{key}` 的{zh}在这里是 `{other}`，在别处是 `{first}`",
            "the {en} of `{key}` is `{other}` here and `{first}` elsewhere",
            key = field.wire
        );
        let label = text!("这里是 `{first}`", "`{first}` here");
        let finding = Finding::new(search.rule, Subject::Field(ty, field), message);
        search.add(finding.with(Subject::Field(first_type, first_field), label));
    }
}

fn one_key_two_units(search: &mut Search<'_>) {
    for ways in by_key(search, |field| field.details().unit.as_deref()) {
        several(search, ways.into_iter().collect(), ["unit", "单位"]);
    }
}

fn one_key_two_types(search: &mut Search<'_>) {
    let kind = |field: &Field| {
        Some(match field.ty.item() {
            Type::Bool => "bool",
            Type::Int(_) | Type::Float(_) => "number",
            Type::String | Type::Base64 => "string",
            Type::TimestampMs | Type::TimestampS | Type::Json | Type::Array(_) | Type::Named(_) => {
                return None;
            }
        })
    };
    for ways in by_key(search, kind) {
        several(search, ways.into_iter().collect(), ["type", "类型"]);
    }
}

fn negative_bool(search: &mut Search<'_>) {
    let is_negative = |field: &Field| {
        let name = snake(&field.wire);
        let mut words = name
            .split('_')
            .filter(|word| !matches!(*word, "is" | "has"));
        let first = words.next().unwrap_or_default();
        let is_negative = matches!(first, "not" | "no" | "non" | "disable" | "disabled" | "un");
        field.ty == Type::Bool && is_negative && words.next().is_some()
    };
    search.report_fields(is_negative, |key| {
        text!("`{key}` 是否定式的名称", "`{key}` is a negative name")
    });
}

fn list_in_singular(search: &mut Search<'_>) {
    let is_singular = |field: &Field| {
        let name = snake(&field.wire);
        let last = name.rsplit('_').next().unwrap_or_default();
        let is_plural = last.ends_with('s')
            || matches!(
                last,
                "list" | "array" | "set" | "data" | "info" | "path" | "queue"
            );
        matches!(field.ty, Type::Array(_)) && !is_plural
    };
    search.report_fields(is_singular, |key| {
        text!(
            "`{key}` 是列表，却用单数命名",
            "`{key}` is a list with a singular name"
        )
    });
}

fn report_without_cadence(search: &mut Search<'_>) {
    search.report_operations(
        |operation| matches!(operation.exchange, Exchange::Report { cadence: None, .. }),
        |name| text!("`{name}` 没有 `cadence`", "`{name}` has no `cadence`"),
    );
}

fn motion_without_process(search: &mut Search<'_>) {
    let lacks_process = |operation: &Operation| {
        let is_motion = operation.effect() == Some(Effect::Motion);
        is_motion && operation.accepted().is_none() && operation.sets_off().is_empty()
    };
    search.report_operations(lacks_process, |name| {
        text!(
            "`{name}` 没有 `accepted`，也没有 `sets_off`",
            "`{name}` has neither `accepted` nor `sets_off`"
        )
    });
}

fn code_of_other_group(search: &mut Search<'_>) {
    for operation in search.operations() {
        let mut ranges = search.model.ranges.iter();
        let range = operation
            .code
            .value
            .and_then(|code| ranges.find(|range| range.has(code)));
        if let Some(range) = range
            && !range.groups.is_empty()
            && !range.groups.contains(&operation.group)
        {
            search.report(
                Subject::Operation(operation),
                text!(
                    "`{name}` 的功能码在用于 {groups} 的号段内",
                    "`{name}` has a code of the range for {groups}",
                    name = operation.name,
                    groups = Text::listed(&range.groups)
                ),
            );
        }
    }
}
