//! Result codes.

use super::frame::check_each_once;
use super::names::check_distinct;
use crate::diagnostic::Faults;
use crate::load::draft::Draft;
use crate::load::grammar::RESULT;
use crate::model::ResultRole;

/// The engine has a result code for each of its own answers.
pub(super) fn check_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(place) = draft.results_place else {
        return;
    };
    let used = draft
        .results
        .iter()
        .filter_map(|result| Some((result.item.role?, result.place.at(RESULT.role))))
        .collect::<Vec<_>>();
    check_each_once(
        |_: ResultRole| true,
        &used,
        place.name(),
        "result code",
        faults,
    );
}

/// Each result code has a name of its own.
pub(super) fn check_names(draft: &Draft<'_>, faults: &mut Faults) {
    let names = draft
        .results
        .iter()
        .map(|result| (result.item.name.as_str(), result.place.at(RESULT.name)));
    check_distinct("result codes", names, faults);
}
