//! Checks dates.

use super::iter::fields;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{COMMON, FIELD, FIELD_DEPRECATED};
use crate::load::draft::{Draft, Origin};
use crate::names;
use crate::text;

/// Checks that no thing is deprecated before it was added.
pub(super) fn check_order(draft: &Draft<'_>, faults: &mut Faults) {
    let operations = draft.operations.iter().map(|operation| operation.origin);
    let fields = fields(draft)
        .filter(|(_, field, _)| field.details().since.is_some())
        .map(|(_, _, part)| part.origin);
    for origin in operations.chain(fields) {
        faults.extend(order(origin));
    }
}

fn order(origin: Origin<'_>) -> Option<Diagnostic> {
    let since = COMMON.since.of(origin.node)?;
    let withdrawn = FIELD_DEPRECATED
        .since
        .of(FIELD.deprecated.of(origin.node))?;
    let first = names::date(since.as_str()?)?;
    let last = names::date(withdrawn.as_str()?)?;
    // A date without a day covers the whole month.
    let is_later = (first.0, first.1) > (last.0, last.1)
        || ((first.0, first.1) == (last.0, last.1) && last.2 > 0 && first.2 > last.2);
    is_later.then(|| {
        let message = text!(
            "弃用的时间早于加入的时间",
            "the date of deprecation is earlier than the date of addition"
        );
        Diagnostic::error(FaultCode::DatesOutOfOrder, withdrawn.span(), message)
            .also(since.span(), text!("在这里加入", "added here"))
    })
}
