//! STANDARD: what makes a protocol easy to use.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field, of_operation};
use crate::load::names::snake;
use crate::model::{BodyState, Effect, Exchange, Field, Type, TypeDef};
use crate::text;
use std::collections::BTreeMap;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: "FC0811",
        category: Category::Standard,
        name: "empty-answer",
        level: Level::Warning,
        title: [
            "command that reads and answers nothing",
            "读取却不返回内容的指令",
        ],
        text: [
            "A command with the effect `read` has a response without a single key of its own. Write the response; where it is not known, say so \
             with `response_state`; where there is none, the effect is another one.",
            "作用为 `read` 的指令，响应中没有任何自己的键。请写出响应；响应内容未知时用 `response_state` 说明；确实没有响应内容时，作用就不是读取。",
        ],
        find: Some(empty_answer),
    },
    Rule {
        code: "FC0812",
        category: Category::Standard,
        name: "number-without-unit",
        level: Level::Off,
        title: ["fraction without a unit", "没有单位的小数"],
        text: [
            "A number with a fraction is nearly always a measurement: metres or millimetres, radians or degrees. Write its `unit`. Numbers \
             without one (a ratio, a version) are the reason why this rule is off by default.",
            "小数几乎都是测量值：是米还是毫米，是弧度还是角度？请写明 `unit`。也有没有单位的数（比例、版本号），所以本规则默认关闭。",
        ],
        find: Some(number_without_unit),
    },
    Rule {
        code: "FC0813",
        category: Category::Standard,
        name: "id-without-entity",
        level: Level::Off,
        title: ["ID that does not say of what", "没有说明指向什么的 ID"],
        text: [
            "The name of the field ends in `id`, and it does not say what it is the ID of. With `refers`, pages link it and packages can give it a \
             type of its own. Off by default: where a source leaves it open, a guess would be worse.",
            "字段名以 `id` 结尾，但没有说明是什么的 ID。写上 `refers` 后，页面会加上链接，代码中也可以有专门的类型。默认关闭：源文档没有写明时，猜测比不写更糟。",
        ],
        find: Some(id_without_entity),
    },
    Rule {
        code: "FC0814",
        category: Category::Standard,
        name: "key-in-two-units",
        level: Level::Warning,
        title: ["one key in two units", "同一个键有两种单位"],
        text: [
            "The same wire key stands in several bodies, once in one unit and once in another. Who has learnt it in one place reads it wrong in the \
             other, and nothing fails. Use one unit, or say in the key which one it is.",
            "同一个键名出现在多个报文中，单位却不同。在一处看惯了的人会在另一处读错，而且不会报错。请统一单位，或在键名中写明单位。",
        ],
        find: Some(one_key_two_units),
    },
    Rule {
        code: "FC0815",
        category: Category::Standard,
        name: "negative-bool",
        level: Level::Warning,
        title: ["bool with a negative name", "名称为否定式的布尔值"],
        text: [
            "`notReady: false` has to be read twice. Name what is true: `ready`.",
            "`notReady: false` 要想两遍才能明白。请用肯定的说法命名：`ready`。",
        ],
        find: Some(negative_bool),
    },
    Rule {
        code: "FC0816",
        category: Category::Standard,
        name: "list-in-singular",
        level: Level::Off,
        title: ["list that is named in the singular", "用单数命名的列表"],
        text: [
            "A list holds several, so that `points` or `pointList` says more than `point`. Off by default: a wire key that is in use stays.",
            "列表里有多项，`points`、`pointList` 比 `point` 清楚。默认关闭：已经在用的键名不改。",
        ],
        find: Some(list_in_singular),
    },
    Rule {
        code: "FC0817",
        category: Category::Standard,
        name: "report-without-cadence",
        level: Level::Warning,
        title: [
            "report that does not say when it comes",
            "没有说明何时发送的上报",
        ],
        text: [
            "An app can only tell a lost report from one that was never due if it knows when reports come. Write the `cadence`: at each change, at \
             intervals, or within a time; where nobody knows it yet, it is worth asking.",
            "只有知道什么时候该有上报，应用才能分清是丢失还是本来就没有。请写明 `cadence`：变化时、定时或在某段时间之内；还没有人知道的，值得去问。",
        ],
        find: Some(report_without_cadence),
    },
    Rule {
        code: "FC0818",
        category: Category::Standard,
        name: "motion-without-process",
        level: Level::Warning,
        title: [
            "motion of which nothing else is said",
            "没有任何条件和后续的运动指令",
        ],
        text: [
            "A command that moves the robot says neither in which states it is accepted (`accepted`) nor which reports follow it (`sets_off`). \
             A caller cannot know whether it was taken nor when it is over.",
            "让机器人运动的指令既没有说明在什么状态下接受（`accepted`），也没有说明之后有什么上报（`sets_off`）。调用者无从知道指令是否被接受、何时结束。",
        ],
        find: Some(motion_without_process),
    },
    Rule {
        code: "FC0819",
        category: Category::Standard,
        name: "key-of-two-types",
        level: Level::Off,
        title: ["one key of two types", "同一个键有两种类型"],
        text: [
            "The same wire key is a number in one body and a text in another. Off by default: short keys such as `type` mean something else in \
             each body.",
            "同一个键名在一个报文中是数，在另一个报文中是文本。默认关闭：`type` 这样的短键名在各个报文中含义本来就不同。",
        ],
        find: Some(one_key_two_types),
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
        if body.fields.is_empty() && messages.response.state != BodyState::Open {
            search.report(
                of_operation(operation),
                text!(
                    "这条指令用于读取，响应却没有任何键",
                    "this command reads, and its response has no keys"
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
                    "`{key}` 没有说明是什么的 ID",
                    "`{key}` does not say of what it is the ID",
                    key = field.wire
                ),
            );
        }
    }
}

/// By wire key, the first field of each way to say something of it, where there are several.
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
                    "`{key}` 用否定式命名",
                    "`{key}` says what is not",
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
                    "`{key}` is a list, named in the singular",
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
                    "没有说明何时发送这个上报",
                    "nothing says when this report is sent"
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
                    "没有说明何时接受这个动作，也没有说明之后有什么上报",
                    "nothing says when this motion is accepted, nor what follows it"
                ),
            );
        }
    }
}
