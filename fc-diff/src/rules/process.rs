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
            "Something was removed that was never marked as deprecated, or there is a break although the version of the protocol \
             is the same or its changelog has no new entry. The language has no sunset dates yet, so none are judged.",
            "删除了从未标记为停用的内容，或有不兼容的变更而协议版本没变、变更记录没有新增条目。规范语言目前没有下线日期，因此不作评估。",
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
