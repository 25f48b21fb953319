//! Constraints of fields.

use super::{BASE, EVERY, rules};
use crate::rule::Language::Typescript;
use crate::rule::{Rule, Wire};

rules! {
    RANGE_TIGHTENED {
        number: 44,
        name: "range-tightened",
        wire: Wire::OldSender,
        source: &[Typescript],
        mirror: &[45],
        title: ["fewer values are valid", "取值范围收窄"],
        text: [
            "`min`, `max` or `only` excludes values that old senders may send. New receivers refuse them. If a 64-bit integer now \
             fits a `number`, its type in TypeScript changes.",
            "`min`、`max` 或 `only` 排除了旧发送方可能发送的值，新接收方会拒绝。64 位整数若因此能放进 `number`，TypeScript 中的类型会变。",
        ],
    }
    RANGE_WIDENED {
        number: 45,
        name: "range-widened",
        wire: Wire::NewSender,
        source: &[Typescript],
        mirror: &[44],
        title: ["more values are valid", "取值范围放宽"],
        text: [
            "New senders may send values that old receivers refuse. If a 64-bit integer no longer fits a `number`, its type in \
             TypeScript changes.",
            "新发送方可能发送旧接收方拒绝的值。64 位整数若因此放不进 `number`，TypeScript 中的类型会变。",
        ],
    }
    LENGTH_TIGHTENED {
        number: 46,
        name: "length-tightened",
        wire: Wire::OldSender,
        mirror: &[47],
        title: ["fewer lengths are valid", "长度范围收窄"],
        text: [
            "Old senders may send texts, bytes or lists of a length that new receivers refuse.",
            "旧发送方可能发送的文本、字节或列表，长度超出新接收方的允许范围。",
        ],
    }
    LENGTH_WIDENED {
        number: 47,
        name: "length-widened",
        wire: Wire::NewSender,
        mirror: &[46],
        title: ["more lengths are valid", "长度范围放宽"],
        text: [
            "New senders may send texts, bytes or lists of a length that old receivers refuse.",
            "新发送方可能发送的文本、字节或列表，长度超出旧接收方的允许范围。",
        ],
    }
    PATTERN {
        number: 48,
        name: "pattern-changed",
        wire: Wire::Both,
        mirror: &[48],
        title: ["a pattern was added, changed or removed", "正则约束新增、变更或删除"],
        text: [
            "This rule does not compare the patterns. An added pattern may refuse texts from old senders. After a removed pattern, old \
             receivers may refuse texts from new senders. A changed pattern may do both.",
            "这条规则不比较两个正则。新增正则：可能拒绝旧发送方的文本。删除正则：旧接收方可能拒绝新发送方的文本。变更正则：两者都可能。",
        ],
    }
    DEFAULT {
        number: 49,
        name: "absent-meaning-changed",
        source: EVERY,
        behaviour: true,
        silent: true,
        mirror: &[49],
        title: ["an absent field means something else", "缺省含义变更"],
        text: [
            "`default` is not sent. Each side uses its own default for an absent field, so the two disagree without an error. \
             Without a default, the packages lose its accessor, and programs that use it do not compile.",
            "`default` 不随报文发送，双方各按自己的缺省值理解，结果不一致，且不会报错。删除后，生成的代码中不再有取默认值的成员，用到它的代码无法编译。",
        ],
    }
    SENSITIVE {
        number: 50,
        name: "sensitive-dropped",
        behaviour: true,
        no_mirror: ["hiding another field has no effect on programs", "多隐藏一个字段不影响任何程序"],
        title: ["a field is no longer sensitive", "字段不再标为敏感"],
        text: [
            "Its values appear in logs from this version on.",
            "从这个版本起，它的值会出现在日志里。",
        ],
    }
}
