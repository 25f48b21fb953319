//! Checks the envelope.

use super::frame::check_each_once;
use super::value::check_type;
use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{CALLS, COMMON, ENVELOPE, ENVELOPE_FIELD};
use crate::load::draft::Draft;
use crate::load::lower::envelope_type_fits;
use crate::model::EnvelopeRole;
use crate::names;
use crate::text;
use std::collections::HashMap;

/// Checks that each role occurs at most once per direction, and that requests carry no result. A result text needs a
/// result code in the same response.
pub(super) fn check_roles(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(envelope) = &draft.envelope else {
        return;
    };
    for (key, fields) in [
        (ENVELOPE.request, &envelope.request),
        (ENVELOPE.response, &envelope.response),
    ] {
        let used = fields.iter();
        let used = used.map(|it| (it.item.role, it.origin.at(ENVELOPE_FIELD.role)));
        let has_text = used
            .clone()
            .any(|(role, _)| role == EnvelopeRole::ResultText);
        let is_response = key.name == ENVELOPE.response.name;
        let needed = |role| role == EnvelopeRole::ResultCode && is_response && has_text;
        check_each_once(
            needed,
            used,
            envelope.origin.key_at(key),
            &text!("公共字段的键", "envelope key"),
            faults,
        );
    }
    for field in &envelope.request {
        if field.item.role != EnvelopeRole::Time {
            let message = text!("请求不带结果", "a request carries no result");
            let span = field.origin.at(ENVELOPE_FIELD.role);
            faults.push(Diagnostic::error(FaultCode::ResultInRequest, span, message));
        }
    }
}

/// Checks that requests carry a time if the spec limits their age.
pub(super) fn check_age(draft: &Draft<'_>, faults: &mut Faults) {
    let (Some(envelope), Some(calls)) = (&draft.envelope, &draft.calls) else {
        return;
    };
    let mut request = envelope.request.iter();
    if calls.item.max_age_ms.is_some()
        && !request.any(|field| field.item.role == EnvelopeRole::Time)
    {
        let message = text!(
            "请求不带时间，无法判断是否过期",
            "requests carry no time, so their age is unknown"
        );
        let span = calls.origin.at(CALLS.max_age_ms);
        let request = envelope.origin.key_at(ENVELOPE.request);
        faults.push(
            Diagnostic::error(FaultCode::AgeWithoutTime, span, message)
                .also(request, text!("请求的公共字段", "their envelope"))
                .write("never"),
        );
    }
}

/// Checks types against roles, examples against types, and that names in code exist and differ.
pub(super) fn check_fields(draft: &Draft<'_>, faults: &mut Faults) {
    let Some(envelope) = &draft.envelope else {
        return;
    };
    for fields in [&envelope.request, &envelope.response] {
        let mut first = HashMap::new();
        for field in fields {
            let (item, origin) = (&field.item, field.origin);
            if !envelope_type_fits(item.role, &item.ty) {
                let expected = match item.role {
                    EnvelopeRole::Time => text!("timestamp_ms", "timestamp_ms"),
                    EnvelopeRole::ResultCode => text!("整数", "an integer"),
                    EnvelopeRole::ResultText => text!("string", "string"),
                };
                let message = text!(
                    "这种角色的公共字段，类型应为{expected}",
                    "an envelope key with this role must be {expected}",
                    expected = expected.spaced()
                );
                let span = origin.at(ENVELOPE_FIELD.r#type);
                let fault = Diagnostic::error(FaultCode::EnvelopeType, span, message);
                faults.push(fault.also(origin.at(ENVELOPE_FIELD.role), text!("角色", "the role")));
            } else if let Some(node) = ENVELOPE_FIELD.example.of(origin.node) {
                faults.extend(check_type(draft, &item.ty, node));
            }
            faults.extend(super::names::hidden(&item.wire, origin.name()));
            let span = origin.at(COMMON.name);
            if !names::is_snake(&item.name) {
                faults.push(super::names::unusable(&item.wire, origin.name()));
            } else if let Some(earlier) = first.insert(item.name.as_str(), span) {
                let message = text!(
                    "有两个公共字段的键在代码中都叫 `{name}`",
                    "two envelope keys are called `{name}` in code",
                    name = item.name
                );
                let fault = Diagnostic::error(FaultCode::DuplicateFieldName, span, message);
                faults.push(fault.also_first(earlier));
            }
        }
    }
}
