//! WIRE: rules about values that some languages cannot hold, and about values without limits.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field};
use crate::diagnostic::LintCode;
use crate::model::{Direction, Exchange, IntKind, Type, TypeShape, WireForm};
use crate::text;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: LintCode {
            number: "FC0851",
            title: [
                "integer that JavaScript cannot hold",
                "JavaScript 存不下的整数",
            ],
            text: [
                "A 64-bit integer is sent as a JSON number, and its `max` is not limited to 2^53 − 1. Readers that store numbers as doubles, such as \
             browsers, change larger values silently. Limit it with `max`, or send it as a string (`wire: string`).",
                "64 位整数以 JSON 数字发送，而 `max` 没有限制在 2^53 − 1 以内。用双精度浮点数保存数字的一方（例如浏览器）会悄悄改掉更大的值。用 `max` 加上限，或以字符串发送（`wire: string`）。",
            ],
        },
        category: Category::Wire,
        name: "integer-beyond-double",
        level: Level::Off,
        find: Some(integer_beyond_double),
    },
    Rule {
        code: LintCode {
            number: "FC0852",
            title: ["fraction without a range", "没有范围的小数"],
            text: [
                "A fraction has neither `min` nor `max`, so a speed of 1e300 is accepted. Write the range of the robot.",
                "小数没有 `min` 也没有 `max`，速度写成 1e300 也会接受。写上机器人能接受的范围。",
            ],
        },
        category: Category::Wire,
        name: "number-without-range",
        level: Level::Off,
        find: Some(number_without_range),
    },
    Rule {
        code: LintCode {
            number: "FC0853",
            title: ["text or list of any length", "长度不限的文本或列表"],
            text: [
                "A text, a list or bytes without a `length` can be as large as a frame. Every program that stores it then chooses a different limit. \
             Write `length`.",
                "文本、列表或字节没有 `length`，最大可以和一帧一样长。保存它的程序各自定上限，互不相同。写上 `length`。",
            ],
        },
        category: Category::Wire,
        name: "unbounded-length",
        level: Level::Off,
        find: Some(unbounded_length),
    },
    Rule {
        code: LintCode {
            number: "FC0854",
            title: [
                "report with a required closed enum",
                "必填字段为封闭枚举的上报",
            ],
            text: [
                "A required field of a report has a `closed` enum. If the robot gets a new value, present apps refuse the whole report. Open the enum, \
             or make the field optional.",
                "上报中的必填字段使用了封闭（`closed`）的枚举。机器人一旦有新的取值，现在的 app 就会拒绝整条上报。改为开放的枚举，或把字段改为可选。",
            ],
        },
        category: Category::Wire,
        name: "closed-enum-in-report",
        level: Level::Off,
        find: Some(closed_enum_in_report),
    },
    Rule {
        code: LintCode {
            number: "FC0855",
            title: [
                "times in seconds and in milliseconds",
                "同时有秒和毫秒的时间",
            ],
            text: [
                "One object has a time in seconds and a time in milliseconds. A program that compares them is wrong, without an error. Use one of the \
             two.",
                "同一个对象里，有的时间以秒计，有的以毫秒计。程序直接比较两者会出错，而且不会报错。统一单位。",
            ],
        },
        category: Category::Wire,
        name: "seconds-beside-milliseconds",
        level: Level::Off,
        find: Some(seconds_beside_milliseconds),
    },
    Rule {
        code: LintCode {
            number: "FC0856",
            title: ["value of any type", "没有类型的值"],
            text: [
                "The type is `json`: its content is not checked, and every program parses it by hand. Give it a type once the content is known.",
                "类型是 `json`：内容不作检查，每个程序都要手工解析。知道内容后，写出类型。",
            ],
        },
        category: Category::Wire,
        name: "untyped-value",
        level: Level::Off,
        find: Some(untyped_value),
    },
];

/// The largest safe integer, 2^53 − 1. Larger integers can share a double.
const SAFE: f64 = 9_007_199_254_740_991.0;

fn integer_beyond_double(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let is_long = matches!(field.ty.item(), Type::Int(IntKind::I64 | IntKind::U64));
        let max = field.details().constraints.max.as_ref();
        let is_bounded = max.is_some_and(|max| max.to_f64() <= SAFE);
        if is_long && !is_bounded && field.wire_form != WireForm::String {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 以 JSON 数字发送，可能大于 2^53",
                    "`{key}` is sent as a JSON number and may be larger than 2^53",
                    key = field.wire
                ),
            );
        }
    }
}

fn number_without_range(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let details = field.details();
        let is_open = details.constraints.min.is_none() && details.constraints.max.is_none();
        if matches!(field.ty.item(), Type::Float(_)) && is_open {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 没有 `min` 也没有 `max`",
                    "`{key}` has neither `min` nor `max`",
                    key = field.wire
                ),
            );
        }
    }
}

fn unbounded_length(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let has_length = matches!(field.ty, Type::String | Type::Base64 | Type::Array(_));
        let details = field.details();
        if has_length
            && details.constraints.length.is_none()
            && details.constraints.pattern.is_none()
        {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 没有 `length`",
                    "`{key}` has no `length`",
                    key = field.wire
                ),
            );
        }
    }
}

fn closed_enum_in_report(search: &mut Search<'_>) {
    for (ty, shape) in search.structs() {
        let in_report = ty.body_of.as_ref().is_some_and(|body| {
            let operation = search.model.operation(&body.operation);
            let is_report =
                operation.is_some_and(|it| matches!(it.exchange, Exchange::Report { .. }));
            is_report && body.side == Direction::Request
        });
        if !in_report {
            continue;
        }
        for field in shape.fields.iter().filter(|field| !field.optional) {
            let named = field.ty.innermost();
            let shape = named.map(|named| &search.model.types.get(named).shape);
            if matches!(shape, Some(TypeShape::Enum(shape)) if shape.closed) {
                search.report(
                    of_field(ty, field),
                    text!(
                        "`{key}` 为必填，而它的枚举是封闭的",
                        "`{key}` is required, but its enum is closed",
                        key = field.wire
                    ),
                );
            }
        }
    }
}

fn seconds_beside_milliseconds(search: &mut Search<'_>) {
    for (ty, shape) in search.structs() {
        let of = |wanted: &Type| shape.fields.iter().find(|field| field.ty.item() == wanted);
        if let (Some(seconds), Some(other)) = (of(&Type::TimestampS), of(&Type::TimestampMs)) {
            search.add(
                Finding::new(
                    search.rule,
                    of_field(ty, seconds),
                    text!(
                        "`{seconds_key}` 以秒计，`{other_key}` 以毫秒计",
                        "`{seconds_key}` is in seconds, `{other_key}` in milliseconds",
                        seconds_key = seconds.wire,
                        other_key = other.wire
                    ),
                )
                .with(of_field(ty, other), text!("以毫秒计", "in milliseconds")),
            );
        }
    }
}

fn untyped_value(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        if *field.ty.item() == Type::Json {
            search.report(
                of_field(ty, field),
                text!(
                    "`{key}` 接受任意 JSON 值",
                    "`{key}` accepts any JSON value",
                    key = field.wire
                ),
            );
        }
    }
}
