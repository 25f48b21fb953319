//! Constraints of fields.

use super::{BASE, EVERY, rules};
use crate::rule::Language::Typescript;
use crate::rule::{Rule, Wire};

rules! {
    FC0744 RANGE_TIGHTENED "range-tightened" "取值范围收窄" "fewer values are valid" {
        wire: Wire::OldSender, source: &[Typescript], mirror: &[45],
    }
    FC0745 RANGE_WIDENED "range-widened" "取值范围放宽" "more values are valid" {
        wire: Wire::NewSender, source: &[Typescript], mirror: &[44],
    }
    FC0746 LENGTH_TIGHTENED "length-tightened" "长度范围收窄" "fewer lengths are valid" {
        wire: Wire::OldSender, mirror: &[47],
    }
    FC0747 LENGTH_WIDENED "length-widened" "长度范围放宽" "more lengths are valid" {
        wire: Wire::NewSender, mirror: &[46],
    }
    FC0748 PATTERN "pattern-changed" "正则约束新增、变更或删除" "a pattern was added, changed or removed" {
        wire: Wire::Both, mirror: &[48],
    }
    FC0749 DEFAULT "absent-meaning-changed" "缺省含义变更" "an absent field means something else" {
        source: EVERY, behaviour: true, silent: true, mirror: &[49],
    }
    FC0750 SENSITIVE "sensitive-dropped" "字段不再标为敏感" "a field is no longer sensitive" {
        behaviour: true,
        no_mirror: ["hiding another field has no effect on programs", "多隐藏一个字段不影响任何程序"],
    }
}
