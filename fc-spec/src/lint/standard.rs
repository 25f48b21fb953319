//! STANDARD: rules that make a protocol easy to use.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field, of_operation};
use crate::diagnostic::LintCode;
use crate::model::{BodyState, Effect, Exchange, Field, Text, Type, TypeDef};
use crate::names::snake;
use crate::text;
use std::collections::BTreeMap;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: LintCode {
            number: "FC0811",
            title: [
                "reading command with an empty response",
                "读取却没有响应内容的指令",
            ],
            text: [
                "A command with the effect `read` has a response without keys. Write the response. If it is unknown, write `response_state: open`. If \
             the response really is empty, correct the effect.",
                "影响为 `read` 的指令，响应中没有键。写出响应；响应未知时写 `response_state: open`；确实没有响应内容时，改正影响。",
            ],
        },
        category: Category::Standard,
        name: "empty-answer",
        level: Level::Warning,
        find: Some(empty_answer),
    },
    Rule {
        code: LintCode {
            number: "FC0812",
            title: ["fraction without a unit", "没有单位的小数"],
            text: [
                "A number with a fraction is nearly always a measurement: metres or millimetres, radians or degrees. Write its `unit`. Off by default: \
             some numbers have no unit, such as a ratio or a version.",
                "小数几乎都是测量值：可能是米或毫米，弧度或角度。写上 `unit`。默认关闭：有的数没有单位，例如比例、版本号。",
            ],
        },
        category: Category::Standard,
        name: "number-without-unit",
        level: Level::Off,
        find: Some(number_without_unit),
    },
    Rule {
        code: LintCode {
            number: "FC0813",
            title: ["ID without an entity", "没有写明实体的 ID"],
            text: [
                "The name of the field ends in `id`, but the field has no `refers`. With `refers`, pages link the field to its entity, and packages can \
             give it a separate type. Off by default: if the source does not name the entity, a guess would be worse.",
                "字段名以 `id` 结尾，但没有写 `refers`。写上之后，页面会链接到实体，代码中也可以有专门的类型。默认关闭：源文档没有写明时，猜测比不写更糟。",
            ],
        },
        category: Category::Standard,
        name: "id-without-entity",
        level: Level::Off,
        find: Some(id_without_entity),
    },
    Rule {
        code: LintCode {
            number: "FC0814",
            title: ["one key in two units", "同一个键有两种单位"],
            text: [
                "The same wire key has different units in different bodies. Readers who know one of them misread the other, without an error. Use one \
             unit, or put the unit into the key.",
                "同一个键名在不同报文中的单位不同。熟悉其中一处的人会在另一处读错，而且不会报错。统一单位，或在键名中写明单位。",
            ],
        },
        category: Category::Standard,
        name: "key-in-two-units",
        level: Level::Warning,
        find: Some(one_key_two_units),
    },
    Rule {
        code: LintCode {
            number: "FC0815",
            title: ["bool with a negative name", "名称为否定式的布尔值"],
            text: [
                "`notReady: false` is hard to read. Use the positive name: `ready`.",
                "`notReady: false` 不易看懂。用肯定的说法命名：`ready`。",
            ],
        },
        category: Category::Standard,
        name: "negative-bool",
        level: Level::Warning,
        find: Some(negative_bool),
    },
    Rule {
        code: LintCode {
            number: "FC0816",
            title: ["list with a singular name", "用单数命名的列表"],
            text: [
                "A list holds several items, so `points` or `pointList` is clearer than `point`. Off by default: wire keys in use do not change.",
                "列表里有多项，`points`、`pointList` 比 `point` 清楚。默认关闭：已经在用的键名不改。",
            ],
        },
        category: Category::Standard,
        name: "list-in-singular",
        level: Level::Off,
        find: Some(list_in_singular),
    },
    Rule {
        code: LintCode {
            number: "FC0817",
            title: ["report without a cadence", "没有上报时机的上报"],
            text: [
                "Without the `cadence` of a report, an app cannot distinguish a lost report from one that was never due. Write `cadence`: at each \
             change, at intervals, or within a time. If it is unknown, ask the protocol owner.",
                "没有 `cadence`，app 就分不清上报是丢失了，还是本来就没有。写上 `cadence`：变化时、定时，或在某段时间之内。不清楚时，请协议负责人确认。",
            ],
        },
        category: Category::Standard,
        name: "report-without-cadence",
        level: Level::Warning,
        find: Some(report_without_cadence),
    },
    Rule {
        code: LintCode {
            number: "FC0818",
            title: [
                "motion without preconditions and reports",
                "没有任何条件和后续的运动指令",
            ],
            text: [
                "A command moves the robot but has neither `accepted` (the states in which it is accepted) nor `sets_off` (the reports that follow). A \
             caller cannot know whether the robot will accept it, or when the motion is over.",
                "让机器人运动的指令，既没有 `accepted`（受理的状态），也没有 `sets_off`（之后的上报）。调用方无法知道指令会不会被受理、运动何时结束。",
            ],
        },
        category: Category::Standard,
        name: "motion-without-process",
        level: Level::Warning,
        find: Some(motion_without_process),
    },
    Rule {
        code: LintCode {
            number: "FC0819",
            title: ["one key of two types", "同一个键有两种类型"],
            text: [
                "The same wire key is a number in one body and a text in another. Off by default: short keys such as `type` have a different meaning in \
             each body.",
                "同一个键名在一个报文中是数值，在另一个报文中是文本。默认关闭：`type` 这样的短键名在各个报文中含义本来就不同。",
            ],
        },
        category: Category::Standard,
        name: "key-of-two-types",
        level: Level::Off,
        find: Some(one_key_two_types),
    },
    Rule {
        code: LintCode {
            number: "FC0820",
            title: [
                "code in the range of another group",
                "功能码在其他分组的号段内",
            ],
            text: [
                "The code range names groups, and the group of the operation is not one of them. Take a code from a range of the group, or add the \
             group to `groups` of the range.",
                "号段用 `groups` 指明了分组，其中没有接口所属的分组。改用本分组号段的功能码，或在号段的 `groups` 中加上这个分组。",
            ],
        },
        category: Category::Standard,
        name: "code-of-other-group",
        level: Level::Warning,
        find: Some(code_of_other_group),
    },
];

fn empty_answer(search: &mut Search<'_>) {
    for operation in search.operations() {
        let Exchange::Command {
            effect: Effect::Read,
            messages,
            ..
        } = &operation.exchange
        else {
            continue;
        };
        let body = search.model.types.structure(&messages.response.ty);
        let state = messages.response.state;
        if body.fields.is_empty() && !matches!(state, BodyState::Open | BodyState::Free) {
            search.report(
                of_operation(operation),
                text!(
                    "`{name}` 的影响是 `read`，响应却没有键",
                    "`{name}` has the effect `read`, but its response has no keys",
                    name = operation.name
                ),
            );
        }
    }
}

fn number_without_unit(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        if matches!(field.ty.item(), Type::Float(_)) && field.details().unit.is_none() {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 是小数，但没有单位",
                    "`{key}` is a fraction without a unit",
                    key = field.wire
                ),
            );
        }
    }
}

fn id_without_entity(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let is_id = matches!(
            snake(&field.wire).rsplit('_').next(),
            Some("id" | "ids" | "uuid")
        );
        let may_be_one = matches!(field.ty.item(), Type::Int(_) | Type::String);
        if is_id && may_be_one && field.details().refers.is_none() {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 没有 `refers`",
                    "`{key}` has no `refers`",
                    key = field.wire
                ),
            );
        }
    }
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
        search.add(
            Finding::new(
                search.rule,
                of_field(ty, field),
                text!(
                    "`{key}` 的{zh}在这里是 `{other}`，在别处是 `{first}`",
                    "the {en} of `{key}` is `{other}` here and `{first}` elsewhere",
                    key = field.wire
                ),
            )
            .with(
                of_field(first_type, first_field),
                text!("这里是 `{first}`", "`{first}` here"),
            ),
        );
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
    for (ty, field) in search.fields() {
        let name = snake(&field.wire);
        let mut words = name
            .split('_')
            .filter(|word| !matches!(*word, "is" | "has"));
        let first = words.next().unwrap_or_default();
        let is_negative = matches!(first, "not" | "no" | "non" | "disable" | "disabled" | "un");
        if field.ty == Type::Bool && is_negative && words.next().is_some() {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 是否定式的名称",
                    "`{key}` is a negative name",
                    key = field.wire
                ),
            );
        }
    }
}

fn list_in_singular(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let name = snake(&field.wire);
        let last = name.rsplit('_').next().unwrap_or_default();
        let is_plural = last.ends_with('s')
            || matches!(
                last,
                "list" | "array" | "set" | "data" | "info" | "path" | "queue"
            );
        if matches!(field.ty, Type::Array(_)) && !is_plural {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 是列表，却用单数命名",
                    "`{key}` is a list with a singular name",
                    key = field.wire
                ),
            );
        }
    }
}

fn report_without_cadence(search: &mut Search<'_>) {
    for operation in search.operations() {
        if matches!(operation.exchange, Exchange::Report { cadence: None, .. }) {
            search.report(
                of_operation(operation),
                text!(
                    "`{name}` 没有 `cadence`",
                    "`{name}` has no `cadence`",
                    name = operation.name
                ),
            );
        }
    }
}

fn motion_without_process(search: &mut Search<'_>) {
    for operation in search.operations() {
        let is_motion = operation.effect() == Some(Effect::Motion);
        if is_motion && operation.accepted().is_none() && operation.sets_off().is_empty() {
            search.report(
                of_operation(operation),
                text!(
                    "`{name}` 没有 `accepted`，也没有 `sets_off`",
                    "`{name}` has neither `accepted` nor `sets_off`",
                    name = operation.name
                ),
            );
        }
    }
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
                of_operation(operation),
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
