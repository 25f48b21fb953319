//! Fields and their types.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Language, Rule, Wire};

/// Languages with several number types.
const NUMBERS: &[Language] = &[Rust, Kotlin, JvmBinary, Cpp, Typescript];

rules! {
    FC0725 REQUIRED_ADDED "required-field-added" "新增必填字段" "a required field is new" {
        wire: Wire::OldSender, source: &[Rust, Python, Typescript], mirror: &[27],
    }
    FC0726 OPTIONAL_ADDED "optional-field-added" "新增可选字段" "an optional field is new" {
        mirror: &[28],
    }
    FC0727 REQUIRED_REMOVED "required-field-removed" "删除了必填字段" "a required field is gone" {
        wire: Wire::NewSender, source: EVERY, mirror: &[25],
    }
    FC0728 OPTIONAL_REMOVED "optional-field-removed" "删除了可选字段" "an optional field is gone" {
        source: EVERY, behaviour: true, mirror: &[26],
    }
    FC0729 BECAME_REQUIRED "field-became-required" "可选字段改为必填" "an optional field is required now" {
        wire: Wire::OldSender, source: EVERY, mirror: &[30],
    }
    FC0730 BECAME_OPTIONAL "field-became-optional" "必填字段改为可选" "a required field is optional now" {
        wire: Wire::NewSender, source: EVERY, mirror: &[29],
    }
    FC0731 KEY_CHANGED "wire-key-changed" "报文中的键名变更" "a field has another key in messages" {
        wire: Wire::Both, silent: true, mirror: &[31, 32],
    }
    FC0732 KEY_CHANGED_WITH_ALSO "wire-key-changed-with-also" "键名变更，旧键名仍可接收" "a field has another key, and the old one is still read" {
        wire: Wire::NewSender, silent: true, mirror: &[31],
    }
    FC0733 ALSO_REMOVED "also-removed" "不再接收备用键名" "a further key is no longer read" {
        wire: Wire::OldSender, silent: true,
        no_mirror: ["reading another key has no effect on programs", "多接收一个键名不影响任何程序"],
    }
    FC0734 NAME_CHANGED "code-name-changed" "代码中的名称变更" "it has another name in code" {
        source: EVERY, mirror: &[34],
    }
    FC0735 TYPE_CHANGED "type-changed" "类型变更" "it has another type" {
        wire: Wire::Both, source: EVERY, mirror: &[35, 43],
    }
    FC0736 NUMBER_WIDENED "integer-widened" "数值类型变宽" "a number type is wider" {
        wire: Wire::NewSender, source: NUMBERS, mirror: &[37],
    }
    FC0737 NUMBER_NARROWED "integer-narrowed" "数值类型变窄或符号变更" "a number type is narrower or has another sign" {
        wire: Wire::Both, source: NUMBERS, mirror: &[36, 37],
    }
    FC0738 INTEGER_FLOAT "integer-became-float" "整数与浮点数互换" "an integer became a float, or the reverse" {
        wire: Wire::Both, source: EVERY, mirror: &[38],
    }
    FC0739 FORM_CHANGED "wire-form-changed" "值的发送形式变更" "a value is sent in another form" {
        wire: Wire::Both, mirror: &[39],
    }
    FC0740 TIME_UNIT "time-unit-changed" "时间戳单位变更" "a time is in another unit" {
        wire: Wire::Both, behaviour: true, silent: true, mirror: &[40],
    }
    FC0741 UNIT "unit-changed" "单位变更" "a number is in another unit" {
        wire: Wire::Both, behaviour: true, silent: true, mirror: &[41],
    }
    FC0742 TYPE_RENAMED "type-renamed" "类型改名" "a type has another name" {
        source: EVERY, mirror: &[42],
    }
    FC0743 JSON_TYPED "json-became-typed" "任意 JSON 改为具体类型" "any JSON became a type" {
        wire: Wire::OldSender, source: EVERY, mirror: &[35],
    }
    FC0774 COORDINATES "coordinates-changed" "坐标系变更" "a position is given in other coordinates" {
        wire: Wire::Both, behaviour: true, silent: true, mirror: &[74],
    }
    FC0775 REFERENCE "reference-changed" "字段改为另一种实体的 ID" "a field has the ID of something else" {
        source: EVERY, behaviour: true, silent: true, mirror: &[75],
    }
    FC0776 REUSED "retired-key-reused" "在更早的发布版本中含义不同" "an earlier release used this for something else" {
        wire: Wire::Both, silent: true,
        no_mirror: ["to give it up again is to remove the field (FC0727, FC0728) or the value (FC0753)", "再次放弃，即删除字段（FC0727、FC0728）或枚举取值（FC0753）"],
    }
    FC0777 MEMBER_ORDER "member-order-changed" "结构体字段的位置变更" "fields of a struct have other positions" {
        // The finding about a removed field covers the opposite change.
        source: &[Cpp], mirror: &[77, 27, 28],
    }
}
