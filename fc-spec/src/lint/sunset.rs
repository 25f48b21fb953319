//! SUNSET: rules about removal dates of deprecated things.

use super::finding::Finding;
use super::rule::rules;
use super::search::{Search, Subject};
use crate::model::{Deprecation, is_past};
use crate::text;

rules! { Sunset
    FC0871 "sunset-near" Warning sunset_near "移除日期临近" "removal date is near";
    FC0872 "sunset-passed" Error sunset_passed "移除日期已过" "removal date has passed";
    FC0873 "no-sunset" Off no_sunset "弃用却没有移除日期" "deprecated without a removal date";
}

/// A removal date is near if it is at most this number of months ahead.
const NEAR: i32 = 3;

fn withdrawn<'m>(search: &Search<'m>) -> Vec<(Subject<'m>, &'m Deprecation)> {
    let operations = search.operations();
    let operations = operations.map(|it| (Subject::Operation(it), it.deprecated.as_ref()));
    let fields = search.fields();
    let fields = fields.map(|(ty, it)| (Subject::Field(ty, it), it.details().deprecated.as_ref()));
    let variants = search.model.types.iter().flat_map(|ty| {
        let choice = ty.shape.choice().into_iter();
        let variants = choice.flat_map(|choice| &choice.variants);
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
    let what = [
        "deprecated, and to be removed after",
        "弃用，最后可用日期：",
    ];
    with_sunset(search, is_near, what);
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
