//! Enums and choices of structs.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Language, Rule, Wire};

/// Languages in which programs handle every variant of a choice.
pub(crate) const MATCHED: &[Language] = &[Rust, Kotlin, Cpp, Typescript];

rules! {
    FC0751 VALUE_ADDED_OPEN "value-added-to-open-enum" "开放枚举新增取值" "an open enum has a new value" {
        source: &[Rust], behaviour: true, mirror: &[53],
    }
    FC0752 VALUE_ADDED_CLOSED "value-added-to-closed-enum" "封闭枚举新增取值" "a closed enum has a new value" {
        wire: Wire::NewSender, source: &[Rust, Typescript], mirror: &[53],
    }
    FC0753 VALUE_REMOVED "value-removed" "枚举取值被删除" "a value of an enum is gone" {
        wire: Wire::OldSender, source: EVERY, behaviour: true, mirror: &[51, 52],
    }
    FC0754 VALUE_RENUMBERED "value-renumbered" "枚举取值的编号变更" "a value of an enum is sent differently" {
        wire: Wire::Both, source: &[Typescript], silent: true, mirror: &[54],
    }
    FC0755 ENUM_CLOSED "enum-closed-or-opened" "枚举由开放改为封闭，或相反" "an enum was closed or opened" {
        wire: Wire::Both, source: &[Rust, Python, Typescript], mirror: &[55],
    }
    FC0756 VARIANT "variant-added-or-removed" "选项增加或减少" "a choice has another variant, or lacks one" {
        wire: Wire::Both, source: EVERY, mirror: &[56],
    }
    FC0757 VARIANT_ORDER "variant-order-changed" "匹配到的选项变更" "another variant of a choice matches" {
        behaviour: true, silent: true, wire: Wire::Both, source: &[Cpp], mirror: &[57],
    }
    FC0780 STATES "enum-states-changed" "枚举取值的状态说明变更" "the states of an enum changed" {
        source: &[Rust, Kotlin, JvmBinary, Cpp, Python], behaviour: true, mirror: &[80],
    }
}
