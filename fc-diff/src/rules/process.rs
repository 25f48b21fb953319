//! Announcements, waivers and documentation.

use super::{BASE, rules};
use crate::rule::{About, Rule};

rules! {
    FC0763 RELEASE "change-not-announced" "不兼容的变更没有说明" "a break was not announced" {
        is_error: true,
        no_mirror: ["an announced change needs no finding", "已经说明的变更无需提示"],
    }
    FC0764 DOCS "statement-weakened" "依据减弱、示例变更或只改了一种语言" "a statement lost confidence, or an example or one language changed" {
        about: About::Text,
        no_mirror: ["more confidence and a complete translation need no finding; an example that is changed back is found again", "依据更充分、译文补齐都无需提示；示例改回去会再次提示"],
    }
    FC0765 WAIVER_OVER "waiver-expired" "豁免已过期" "the waiver has expired" {
        is_error: true, about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
    }
    FC0766 WAIVER_UNUSED "waiver-unused" "豁免没有对应的变更" "the waiver accepts nothing" {
        is_error: true, about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
    }
    FC0767 WAIVER_REFUSED "waiver-refused" "这种变更不能豁免" "this change cannot be waived" {
        is_error: true, about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
    }
}
