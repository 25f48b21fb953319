//! Enums and choices of structs.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Language, Rule, Wire};

/// Languages in which programs handle every variant of a choice.
pub(crate) const MATCHED: &[Language] = &[Rust, Kotlin, Cpp, Typescript];

rules! {
    VALUE_ADDED_OPEN {
        number: 51,
        name: "value-added-to-open-enum",
        source: &[Rust],
        behaviour: true,
        mirror: &[53],
        title: ["an open enum has a new value", "开放枚举新增取值"],
        text: [
            "Old receivers keep it as an unknown value. In Rust, an exhaustive match needs another case.",
            "旧接收方当作未知值保留。Rust 中穷尽匹配的代码要多一个分支。",
        ],
    }
    VALUE_ADDED_CLOSED {
        number: 52,
        name: "value-added-to-closed-enum",
        wire: Wire::NewSender,
        source: &[Rust, Typescript],
        mirror: &[53],
        title: ["a closed enum has a new value", "封闭枚举新增取值"],
        text: [
            "Old receivers refuse it. In Rust and TypeScript an exhaustive match has one more case.",
            "旧接收方会拒绝这个值。Rust 和 TypeScript 中穷尽匹配的代码要多一个分支。",
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
        source: &[Typescript],
        silent: true,
        mirror: &[54],
        title: ["a value of an enum is sent differently", "枚举取值的编号变更"],
        text: [
            "Each side reads the other's value as a different value or as unknown, often without an error. In TypeScript, the type \
             of a closed enum changes.",
            "双方会把对方的值当成别的取值或未知值，通常不会报错。TypeScript 中封闭枚举的类型会变。",
        ],
    }
    ENUM_CLOSED {
        number: 55,
        name: "enum-closed-or-opened",
        wire: Wire::Both,
        source: &[Rust, Python, Typescript],
        mirror: &[55],
        title: ["an enum was closed or opened", "枚举由开放改为封闭，或相反"],
        text: [
            "Closed: new receivers refuse unknown values from old senders. Opened: old receivers refuse unknown values from new \
             senders. In Rust, Python and TypeScript, the type gains or loses its unknown values.",
            "改为封闭：新接收方会拒绝旧发送方的未知值。改为开放：旧接收方会拒绝新发送方的未知值。\
             Rust、Python 和 TypeScript 的类型会增加或去掉未知值。",
        ],
    }
    VARIANT {
        number: 56,
        name: "variant-added-or-removed",
        wire: Wire::Both,
        source: EVERY,
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
        source: &[Cpp],
        mirror: &[57],
        title: ["another variant of a choice matches", "匹配到的选项变更"],
        text: [
            "Receivers take the first variant whose required keys are all present. In another order, they may read the same \
             object as another variant, without an error. In C++, the alternatives of the `std::variant` change places. \
             Changed keys are judged as fields.",
            "接收方取第一个必填键齐全的选项。顺序变了，同一个对象可能匹配到别的选项，且不会报错。\
             C++ 中 `std::variant` 的各个类型会换位置。键的变更按字段评估。",
        ],
    }
    STATES {
        number: 80,
        name: "enum-states-changed",
        source: &[Rust, Kotlin, JvmBinary, Cpp, Python],
        behaviour: true,
        mirror: &[80],
        title: ["the states of an enum changed", "枚举取值的状态说明变更"],
        text: [
            "`order`, `then`, `final` or `error` changed. Programs that follow a command stop at other states, and checks of the \
             order have other results. Without any of these marks, the packages lose the functions for states.",
            "`order`、`then`、`final` 或 `error` 变更。跟踪指令的程序会在别的状态结束，顺序检查的结果也会变。这些标记全部删除后，状态相关的函数也会消失。",
        ],
    }
}
