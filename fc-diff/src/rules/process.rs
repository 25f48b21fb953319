//! How a change is made.

use super::{BASE, rules};
use crate::rule::{About, Rule};

rules! {
    RELEASE {
        number: 63,
        name: "change-not-announced",
        is_error: true,
        no_mirror: ["what is announced needs no finding", "已经说明的变更无需提示"],
        title: ["a break was not announced", "不兼容的变更没有说明"],
        text: [
            "Messages break although the version of the protocol is the same; or an operation that is deprecated goes before its `sunset`, or \
             the date moves forward. Deprecation before a removal and entries of the changelog are not judged.",
            "有不兼容的变更，而协议版本没有变；或者已停用的接口在 `sunset` 之前就删除了，或日期提前了。删除前是否标记停用、变更记录是否有新条目，不作评估。",
        ],
    }
    DOCS {
        number: 64,
        name: "statement-weakened",
        about: About::Text,
        no_mirror: [
            "a surer statement and a complete translation need no finding; an example that is changed back is found again",
            "依据更充分、译文补齐都无需提示；示例改回去会再次提示",
        ],
        title: ["a statement is less sure, an example or one language only changed", "依据减弱、示例变更或只改了一种语言"],
        text: [
            "What was stated is now inferred or open; or an example changed, so that golden frames move; or a text changed in one \
             language and not in the other.",
            "原来写明的内容变为推断或未知；或示例变更，标准帧随之变化；或只改了中文或英文其中一种。",
        ],
    }
    WAIVER_OVER {
        number: 65,
        name: "waiver-expired",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["it is about a waiver, not about a change", "针对豁免，而不是变更"],
        title: ["the waiver has expired", "豁免已过期"],
        text: [
            "The date up to which the change was accepted has passed, so that the change counts again. Undo the change, or agree on \
             another date with those whom it breaks.",
            "变更的接受期限已过，该变更重新计入。请撤销变更，或与受影响的各方商定新的期限。",
        ],
    }
    WAIVER_UNUSED {
        number: 66,
        name: "waiver-unused",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["it is about a waiver, not about a change", "针对豁免，而不是变更"],
        title: ["the waiver accepts nothing", "豁免没有对应的变更"],
        text: [
            "Since the last release nothing has changed that this waiver accepts: the change was undone, was made differently, or has \
             been released. Remove the waiver. It is only looked for when the comparison is with the last release.",
            "与上次发布相比，没有这条豁免所接受的变更：变更已撤销、改成了别的样子或已经发布。请删除这条豁免。只有与上次发布比较时才作此检查。",
        ],
    }
    WAIVER_REFUSED {
        number: 67,
        name: "waiver-refused",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["it is about a waiver, not about a change", "针对豁免，而不是变更"],
        title: ["this change cannot be waived", "这种变更不能豁免"],
        text: [
            "A retired code that is used again means something else to every peer that still knows it, and nothing fails. No date makes \
             that safe; choose another code, `fcproto codes` shows which are free.",
            "重新使用停用的功能码后，仍认得旧含义的一方会按旧含义处理，而且不会报错。到什么日期都不安全，请换一个功能码，空闲的见 `fcproto codes`。",
        ],
    }
}
