//! Enums and choices of structs.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, Kotlin, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    VALUE_ADDED_OPEN {
        number: 51,
        name: "value-added-to-open-enum",
        source: &[Rust, Kotlin],
        behaviour: true,
        mirror: &[53],
        title: ["an open enum has a new value", "开放枚举新增取值"],
        text: [
            "Old receivers keep it as an unknown value. An exhaustive match needs another case.",
            "旧接收方当作未知值保留。穷尽匹配的代码要多一个分支。",
        ],
    }
    VALUE_ADDED_CLOSED {
        number: 52,
        name: "value-added-to-closed-enum",
        wire: Wire::NewSender,
        source: &[Rust, Kotlin],
        mirror: &[53],
        title: ["a closed enum has a new value", "封闭枚举新增取值"],
        text: [
            "Old receivers refuse it.",
            "旧接收方会拒绝这个值。",
        ],
    }
    VALUE_REMOVED {
        number: 53,
        name: "value-removed",
        wire: Wire::OldSender,
        source: EVERY,
        behaviour: true,
        mirror: &[51, 52],
        title: ["a value of an enum is gone", "枚举取值被删除"],
        text: [
            "Old senders may still send it: a closed enum refuses it, an open one keeps it as unknown.",
            "旧发送方仍可能发送：封闭枚举会拒绝，开放枚举当作未知值保留。",
        ],
    }
    VALUE_RENUMBERED {
        number: 54,
        name: "value-renumbered",
        wire: Wire::Both,
        silent: true,
        mirror: &[54],
        title: ["a value of an enum is sent differently", "枚举取值的编号变更"],
        text: [
            "Each side reads the other's value as a different value or as unknown, often without an error.",
            "双方会把对方的值当成别的取值或未知值，通常不会报错。",
        ],
    }
    ENUM_CLOSED {
        number: 55,
        name: "enum-closed-or-opened",
        wire: Wire::Both,
        source: &[Rust, Kotlin, Cpp],
        mirror: &[55],
        title: ["an enum was closed or opened", "枚举由开放改为封闭，或相反"],
        text: [
            "Closed: new receivers refuse unknown values from old senders. Opened: old receivers refuse unknown values from new \
             senders, and programs need a case for them.",
            "改为封闭：新接收方会拒绝旧发送方的未知值。改为开放：旧接收方会拒绝新发送方的未知值，代码也要处理未知值。",
        ],
    }
    VARIANT {
        number: 56,
        name: "variant-added-or-removed",
        wire: Wire::Both,
        source: &[Rust, Kotlin, Cpp, Typescript],
        mirror: &[56],
        title: ["a choice has another variant, or lacks one", "选项增加或减少"],
        text: [
            "A receiver without the variant refuses the object, or reads it as another variant whose required keys are all \
             present.",
            "没有该选项的接收方会拒绝，或当成另一个必填键齐全的选项。",
        ],
    }
    VARIANT_ORDER {
        number: 57,
        name: "variant-order-changed",
        behaviour: true,
        silent: true,
        wire: Wire::Both,
        mirror: &[57],
        title: ["another variant of a choice matches", "匹配到的选项变更"],
        text: [
            "Receivers take the first variant whose required keys are all present. In another order, they may read the same \
             object as another variant, without an error. Changed keys are judged as fields.",
            "接收方取第一个必填键齐全的选项。顺序变了，同一个对象可能匹配到别的选项，且不会报错。键的变更按字段评估。",
        ],
    }
}
