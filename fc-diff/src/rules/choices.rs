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
            "Old receivers keep it as an unknown value. An exhaustive match has one more case.",
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
            "Each side reads the other's value as another one or as unknown, and often nothing fails.",
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
            "Closed: unknown values that old senders pass on are refused. Opened: old receivers refuse unknown values that new \
             senders pass on, and programs have a case for them to handle.",
            "改为封闭：旧发送方转发的未知值会被拒绝。改为开放：新发送方转发的未知值会被旧接收方拒绝，代码也要处理未知值。",
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
            "A receiver that does not have the variant refuses the object, or takes it for another one whose required keys \
             are all there.",
            "没有该选项的接收方会拒绝，或当成另一个必填键都齐全的选项。",
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
            "The first variant whose required keys are all there is taken. In another order, the same object may be \
             taken for another variant, and nothing fails. Changed keys are judged as fields.",
            "取第一个必填键都齐全的选项。顺序变了，同一个对象可能匹配到别的选项，且不会报错。键的变更按字段评估。",
        ],
    }
}
