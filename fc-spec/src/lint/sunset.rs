//! SUNSET: what is withdrawn, and until when it is there.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, Subject};
use crate::model::{Deprecation, TypeShape, is_past};
use crate::text;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: "FC0871",
        category: Category::Sunset,
        name: "sunset-near",
        level: Level::Warning,
        title: ["its last day is near", "停用日期临近"],
        text: [
            "What is deprecated goes in this month or in one of the next three. Programs that still use it have to move now; the owner \
             either prepares the removal (`fcproto retire`) or agrees on a later date.",
            "已停用的内容将在本月或之后三个月内移除。还在使用的一方现在就要改；负责人则准备移除（`fcproto retire`），或商定更晚的日期。",
        ],
        find: Some(sunset_near),
    },
    Rule {
        code: "FC0872",
        category: Category::Sunset,
        name: "sunset-passed",
        level: Level::Error,
        title: ["its last day has passed", "停用日期已过"],
        text: [
            "The date that `sunset` promised is over, and it is still there. Remove it with `fcproto retire`, or agree on another date. A date that \
             nobody keeps teaches everybody not to believe the next one.",
            "`sunset` 写明的日期已过，内容还在。请用 `fcproto retire` 移除，或商定新的日期。日期不算数，下一个日期就没有人信了。",
        ],
        find: Some(sunset_passed),
    },
    Rule {
        code: "FC0873",
        category: Category::Sunset,
        name: "no-sunset",
        level: Level::Off,
        title: ["withdrawn without a last day", "停用却没有截止日期"],
        text: [
            "It is deprecated, and nothing says until when it works. Without a `sunset` nobody plans to move. Off by default: an old protocol may \
             keep what it has withdrawn for ever.",
            "已停用，但没有写明用到什么时候。没有 `sunset`，就没有人安排改造。默认关闭：旧协议可能永远保留停用的内容。",
        ],
        find: Some(no_sunset),
    },
];

/// Months before that of the sunset in which it is near.
const NEAR: i32 = 3;

fn withdrawn<'m>(search: &Search<'m>) -> Vec<(Subject<'m>, &'m Deprecation)> {
    let operations = search.operations();
    let operations = operations.map(|it| (Subject::Operation(it), it.deprecated.as_ref()));
    let fields = search.fields();
    let fields = fields.map(|(ty, it)| (Subject::Field(ty, it), it.details().deprecated.as_ref()));
    let choices = search.model.types.iter().filter_map(|ty| match &ty.shape {
        TypeShape::OneOf(choice) => Some((ty, choice)),
        TypeShape::Struct(_) | TypeShape::Enum(_) => None,
    });
    let variants = choices.flat_map(|(ty, choice)| {
        let variants = choice.variants.iter();
        variants.map(move |it| (Subject::Variant(ty, it), it.deprecated.as_ref()))
    });
    let all = operations.chain(fields).chain(variants);
    all.filter_map(|(of, it)| Some((of, it?))).collect()
}

/// Months since the year 0.
fn months(date: &str) -> Option<i32> {
    let mut parts = date.split('-').map(str::parse::<i32>);
    let (year, month) = (parts.next()?.ok()?, parts.next()?.ok()?);
    Some(year * 12 + month)
}

fn with_sunset(search: &mut Search<'_>, is_wanted: impl Fn(&str, &str) -> bool, what: [&str; 2]) {
    for (item, deprecated) in withdrawn(search) {
        let sunset = deprecated.sunset.as_ref();
        let Some(sunset) = sunset.filter(|it| is_wanted(it, search.today)) else {
            continue;
        };
        let [en, zh] = what;
        let mut finding =
            Finding::new(search.rule, item, text!("{zh}{sunset}", "{en} {sunset}")).about(sunset);
        if let Some(by) = &deprecated.replaced_by {
            finding = finding.note(text!("请改用 `{by}`", "`{by}` is to be used instead"));
        }
        search.add(finding);
    }
}

fn sunset_near(search: &mut Search<'_>) {
    let is_near = |sunset: &str, today: &str| {
        let left = months(sunset).zip(months(today));
        !is_past(sunset, today) && left.is_some_and(|(last, now)| last - now <= NEAR)
    };
    with_sunset(search, is_near, ["this goes by", "停用截止日期："]);
}

fn sunset_passed(search: &mut Search<'_>) {
    let what = ["this was to be gone by", "应在此日期前移除："];
    with_sunset(search, is_past, what);
}

fn no_sunset(search: &mut Search<'_>) {
    for (item, deprecated) in withdrawn(search) {
        if deprecated.sunset.is_none() {
            search.report(
                item,
                text!(
                    "已停用，但没有写明用到什么时候",
                    "this is deprecated, and nothing says until when it works"
                ),
            );
        }
    }
}
