//! SUNSET: rules about removal dates of deprecated things.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, Subject};
use crate::diagnostic::LintCode;
use crate::model::{Deprecation, TypeShape, is_past};
use crate::text;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: LintCode {
            number: "FC0871",
            title: ["removal date is near", "移除日期临近"],
            text: [
                "A deprecated thing will be removed this month or in one of the next three. Programs that use it must change now. The owner prepares \
             the removal (`fcproto retire`) or agrees on a later date.",
                "弃用的内容将在本月或之后三个月内移除。还在使用的程序现在就要改；负责人准备移除（`fcproto retire`），或商定更晚的日期。",
            ],
        },
        category: Category::Sunset,
        name: "sunset-near",
        level: Level::Warning,
        find: Some(sunset_near),
    },
    Rule {
        code: LintCode {
            number: "FC0872",
            title: ["removal date has passed", "移除日期已过"],
            text: [
                "The date in `sunset` has passed, and the deprecated thing is still there. Remove it with `fcproto retire`, or agree on another date. If \
             dates are not kept, users stop believing them.",
                "`sunset` 的日期已过，弃用的内容还在。用 `fcproto retire` 移除，或商定新的日期。日期不算数，使用者就不再相信。",
            ],
        },
        category: Category::Sunset,
        name: "sunset-passed",
        level: Level::Error,
        find: Some(sunset_passed),
    },
    Rule {
        code: LintCode {
            number: "FC0873",
            title: ["deprecated without a removal date", "弃用却没有移除日期"],
            text: [
                "A deprecated thing has no `sunset`, so its users do not know how long it works. Off by default: an old protocol may keep deprecated \
             things for ever.",
                "弃用的内容没有 `sunset`，使用者不知道还能用多久。默认关闭：旧协议可能永远保留弃用的内容。",
            ],
        },
        category: Category::Sunset,
        name: "no-sunset",
        level: Level::Off,
        find: Some(no_sunset),
    },
];

/// A removal date is near if it is at most this number of months ahead.
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

/// Returns the months since the year 0.
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
            finding = finding.note(text!("改用 `{by}`", "use `{by}` instead"));
        }
        search.add(finding);
    }
}

fn sunset_near(search: &mut Search<'_>) {
    let is_near = |sunset: &str, today: &str| {
        let left = months(sunset).zip(months(today));
        !is_past(sunset, today) && left.is_some_and(|(last, now)| last - now <= NEAR)
    };
    with_sunset(
        search,
        is_near,
        [
            "deprecated, and to be removed after",
            "弃用，最后可用日期：",
        ],
    );
}

fn sunset_passed(search: &mut Search<'_>) {
    let what = [
        "deprecated, and still there after",
        "弃用，仍未移除，最后可用日期：",
    ];
    with_sunset(search, is_past, what);
}

fn no_sunset(search: &mut Search<'_>) {
    for (item, deprecated) in withdrawn(search) {
        if deprecated.sunset.is_none() {
            search.report(
                item,
                text!("`deprecated` 没有 `sunset`", "`deprecated` has no `sunset`"),
            );
        }
    }
}
