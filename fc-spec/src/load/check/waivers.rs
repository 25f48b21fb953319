//! Checks waivers.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::load::draft::{Draft, Sourced};
use crate::text;

/// Number of hex digits in a fingerprint.
const DIGITS: usize = 12;

/// Checks that each waiver has the id of a finding, in the format of `fcproto diff` and `fcproto lint`. The finding may
/// not exist: that depends on the compared versions.
pub(super) fn check_ids(draft: &Draft<'_>, faults: &mut Faults) {
    for Sourced { item, origin } in &draft.waivers {
        if !is_id(&item.id) {
            let message = text!(
                "`{id}` 不是豁免编号",
                "`{id}` is not the number of a finding",
                id = item.id
            );
            let note = text!(
                "写 `fcproto diff` 或 `fcproto lint` 打印的规则号加指纹，例如 `FC0725-1a2b3c4d5e6f`",
                "write the rule and fingerprint that `fcproto diff` or `fcproto lint` prints, such as `FC0725-1a2b3c4d5e6f`"
            );
            let fault = Diagnostic::error(FaultCode::BadWaiver, origin.name(), message);
            faults.push(fault.note(note));
        }
    }
}

fn is_id(id: &str) -> bool {
    let Some((rule, fingerprint)) = id.split_once('-') else {
        return false;
    };
    let number = rule.strip_prefix("FC").unwrap_or_default();
    let is_hex = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    number.len() == 4
        && number.bytes().all(|byte| byte.is_ascii_digit())
        && fingerprint.len() == DIGITS
        && fingerprint.bytes().all(is_hex)
}
