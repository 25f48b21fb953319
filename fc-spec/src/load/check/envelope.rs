//! The envelope.

use super::frame::check_each_once;
use super::value;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::Draft;
use crate::load::lower::envelope_type_fits;
use crate::load::names;
use crate::model::EnvelopeRole;
use std::collections::HashMap;

/// Requests carry a time, responses a time and a result.
pub(super) fn check_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(envelope) = &draft.envelope else {
        return;
    };
    for (key, fields) in [
        ("request", &envelope.request),
        ("response", &envelope.response),
    ] {
        let used = fields
            .iter()
            .map(|field| (field.item.role, field.place.at("role")))
            .collect::<Vec<_>>();
        let needed = |role| role == EnvelopeRole::Time || key == "response";
        check_each_once(
            needed,
            &used,
            envelope.place.key_at(key),
            "envelope key",
            faults,
        );
    }
    for field in &envelope.request {
        if field.item.role != EnvelopeRole::Time {
            faults.push(Diagnostic::error(
                FaultCode::ResultInRequest,
                field.place.at("role"),
                "a request carries no result",
            ));
        }
    }
}

/// Types fit the roles, examples the types; names in code exist and differ.
pub(super) fn check_fields(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(envelope) = &draft.envelope else {
        return;
    };
    for fields in [&envelope.request, &envelope.response] {
        let mut first = HashMap::new();
        for field in fields {
            let (item, place) = (&field.item, field.place);
            if !envelope_type_fits(item.role, &item.ty) {
                let expected = match item.role {
                    EnvelopeRole::Time => "timestamp_ms",
                    EnvelopeRole::ResultCode => "an integer",
                    EnvelopeRole::ResultText => "string",
                };
                let message = format!("an envelope key of this role is {expected}");
                faults.push(
                    Diagnostic::error(FaultCode::EnvelopeType, place.at("type"), message)
                        .also(place.at("role"), "the role"),
                );
            } else if let Some(node) = place.node.get("example") {
                value::check_plain(draft, &item.ty, node, faults);
            }
            let span = place.at("name");
            if !names::is_snake(&item.name) {
                faults.push(super::names::unusable(&item.wire, place.name()));
            } else if let Some(earlier) = first.insert(item.name.as_str(), span) {
                let message = format!("two envelope keys are called `{}` in code", item.name);
                faults.push(
                    Diagnostic::error(FaultCode::DuplicateFieldName, span, message)
                        .also(earlier, "first used here"),
                );
            }
        }
    }
}
