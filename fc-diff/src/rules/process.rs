//! Announcements, waivers and documentation.

use super::{BASE, rules};
use crate::rule::{About, Rule};

rules! {
    RELEASE {
        number: 63,
        name: "change-not-announced",
        is_error: true,
        no_mirror: ["an announced change needs no finding", "已经说明的变更无需提示"],
        title: ["a break was not announced", "不兼容的变更没有说明"],
        text: [
            "Messages break, but the version of the protocol is the same. Or a deprecated operation was removed before its `sunset`, or the \
             date was moved forward. Deprecation before a removal and entries of the changelog are not judged.",
            "有不兼容的变更，而协议版本没有变；或者弃用的接口在 `sunset` 之前就删除了，或日期提前了。删除前是否标记弃用、变更记录是否有新条目，不作评估。",
        ],
    }
    DOCS {
        number: 64,
        name: "statement-weakened",
        about: About::Text,
        no_mirror: [
            "more confidence and a complete translation need no finding; an example that is changed back is found again",
            "依据更充分、译文补齐都无需提示；示例改回去会再次提示",
        ],
        title: ["a statement lost confidence, or an example or one language changed", "依据减弱、示例变更或只改了一种语言"],
        text: [
            "A stated fact is now inferred or open. Or an example changed, and golden frames with it. Or a text changed in only one \
             language.",
            "原来写明的内容变为推断或未知；或示例变更，标准帧随之变化；或只改了中文或英文其中一种。",
        ],
    }
    WAIVER_OVER {
        number: 65,
        name: "waiver-expired",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
        title: ["the waiver has expired", "豁免已过期"],
        text: [
            "The waiver has passed its date, so the change counts again. Undo the change, or agree on another date with the affected \
             teams.",
            "豁免已过期，该变更重新计入。撤销变更，或与受影响的各方商定新的期限。",
        ],
    }
    WAIVER_UNUSED {
        number: 66,
        name: "waiver-unused",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
        title: ["the waiver accepts nothing", "豁免没有对应的变更"],
        text: [
            "This waiver has no change since the last release: the change was undone, was made differently, or has been released. \
             Remove the waiver. Only a comparison with the last release checks this.",
            "与上次发布相比，没有这条豁免对应的变更：变更已撤销、改成了别的样子或已经发布。删除这条豁免。只有与上次发布比较时才作此检查。",
        ],
    }
    WAIVER_REFUSED {
        number: 67,
        name: "waiver-refused",
        is_error: true,
        about: About::Waiver,
        no_mirror: ["this rule is for waivers, not for changes", "针对豁免，而不是变更"],
        title: ["this change cannot be waived", "这种变更不能豁免"],
        text: [
            "A retired code is used again. Old peers read it in its old meaning, without an error, so no date makes it safe. Choose another \
             code; `fcproto codes` lists the free ones.",
            "退役的功能码又被使用。旧版本的一方会按旧含义处理，而且不会报错，任何期限都不安全。换一个功能码；`fcproto codes` 列出空闲的功能码。",
        ],
    }
}
