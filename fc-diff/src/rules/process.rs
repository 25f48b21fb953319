//! How a change is made.

use super::{BASE, rules};
use crate::rule::Rule;

rules! {
    RELEASE {
        number: 63,
        name: "change-not-announced",
        is_error: true,
        no_mirror: ["what is announced needs no finding", "已经说明的变更无需提示"],
        title: ["a break was not announced", "不兼容的变更没有说明"],
        text: [
            "Messages break although the version of the protocol is the same. Deprecation before a removal and entries of the \
             changelog are not judged.",
            "有不兼容的变更，而协议版本没有变。删除前是否标记停用、变更记录是否有新条目，不作评估。",
        ],
    }
    DOCS {
        number: 64,
        name: "statement-weakened",
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
}
