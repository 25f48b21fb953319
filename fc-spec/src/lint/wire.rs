//! WIRE: rules about values that some languages cannot hold, and about values without limits.

use super::finding::Finding;
use super::rule::rules;
use super::search::{Search, Subject};
use crate::model::{Direction, Exchange, Field, IntKind, Type, WireForm};
use crate::text;

rules! { Wire
    FC0851 "integer-beyond-double" Off integer_beyond_double "JavaScript 存不下的整数" "integer that JavaScript cannot hold";
    FC0852 "number-without-range" Off number_without_range "没有范围的小数" "fraction without a range";
    FC0853 "unbounded-length" Off unbounded_length "长度不限的文本或列表" "text or list of any length";
    FC0854 "closed-enum-in-report" Off closed_enum_in_report "必填字段为封闭枚举的上报" "report with a required closed enum";
    FC0855 "seconds-beside-milliseconds" Off seconds_beside_milliseconds "同时有秒和毫秒的时间" "times in seconds and in milliseconds";
    FC0856 "untyped-value" Off untyped_value "没有类型的值" "value of any type";
}

/// The largest safe integer, 2^53 − 1. Larger integers can share a double.
const SAFE: f64 = 9_007_199_254_740_991.0;

fn integer_beyond_double(search: &mut Search<'_>) {
    let is_beyond = |field: &Field| {
        let is_long = matches!(field.ty.item(), Type::Int(IntKind::I64 | IntKind::U64));
        let max = field.details().constraints.max.as_ref();
        let is_bounded = max.is_some_and(|max| max.to_f64() <= SAFE);
        is_long && !is_bounded && field.wire_form != WireForm::String
    };
    search.report_fields(is_beyond, |key| {
        text!(
            "`{key}` 以 JSON 数字发送，可能大于 2^53",
            "`{key}` is sent as a JSON number and may be larger than 2^53"
        )
    });
}

fn number_without_range(search: &mut Search<'_>) {
    let lacks_range = |field: &Field| {
        let constraints = &field.details().constraints;
        let is_open = constraints.min.is_none() && constraints.max.is_none();
        matches!(field.ty.item(), Type::Float(_)) && is_open
    };
    search.report_fields(lacks_range, |key| {
        text!(
            "`{key}` 没有 `min` 也没有 `max`",
            "`{key}` has neither `min` nor `max`"
        )
    });
}

fn unbounded_length(search: &mut Search<'_>) {
    let is_unbounded = |field: &Field| {
        let has_length = matches!(field.ty, Type::String | Type::Base64 | Type::Array(_));
        let constraints = &field.details().constraints;
        has_length && constraints.length.is_none() && constraints.pattern.is_none()
    };
    search.report_fields(is_unbounded, |key| {
        text!("`{key}` 没有 `length`", "`{key}` has no `length`")
    });
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
            let shape = named.and_then(|named| search.model.types.get(named).shape.enumeration());
            if shape.is_some_and(|shape| shape.closed) {
                search.report(
                    Subject::Field(ty, field),
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
            let message = text!(
                "`{seconds_key}` 以秒计，`{other_key}` 以毫秒计",
                "`{seconds_key}` is in seconds, `{other_key}` in milliseconds",
                seconds_key = seconds.wire,
                other_key = other.wire
            );
            let finding = Finding::new(search.rule, Subject::Field(ty, seconds), message);
            search.add(finding.with(
                Subject::Field(ty, other),
                text!("以毫秒计", "in milliseconds"),
            ));
        }
    }
}

fn untyped_value(search: &mut Search<'_>) {
    search.report_fields(
        |field| *field.ty.item() == Type::Json,
        |key| text!("`{key}` 接受任意 JSON 值", "`{key}` accepts any JSON value"),
    );
}
