//! Operations.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, Kotlin, Python, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    COMMAND_REMOVED {
        number: 13,
        name: "command-removed",
        wire: Wire::OldSender,
        source: &[Rust, Kotlin, Cpp, Python, Typescript],
        mirror: &[14],
        title: ["a command is gone", "删除了指令"],
        text: [
            "Old apps still send it, and a new robot refuses it as an unknown command. The same applies to a stream of \
             the app.",
            "旧 app 仍会发送，新机器人按未知指令拒绝。app 发送的数据流也一样。",
        ],
    }
    COMMAND_ADDED {
        number: 14,
        name: "command-added",
        wire: Wire::NewSender,
        source: &[Rust, Kotlin, Cpp, Typescript],
        behaviour: true,
        mirror: &[13],
        title: ["a command is new", "新增了指令"],
        text: [
            "Old robots refuse it as an unknown command, and new apps must expect that. A robot program that handles every \
             command needs another handler.",
            "旧机器人按未知指令拒绝，新 app 要处理这种情况。处理全部指令的机器人程序需要补上它。",
        ],
    }
    REPORT_REMOVED {
        number: 15,
        name: "report-removed",
        source: &[Rust, Kotlin, Cpp, Typescript],
        behaviour: true,
        mirror: &[16],
        title: ["a report is gone", "删除了上报"],
        text: [
            "An old app waits for a report that a new robot never sends. The same applies to a stream of the robot.",
            "旧 app 会一直等待新机器人不再发送的上报。机器人发送的数据流也一样。",
        ],
    }
    REPORT_ADDED {
        number: 16,
        name: "report-added",
        source: &[Rust, Kotlin],
        behaviour: true,
        mirror: &[15],
        title: ["a report is new", "新增了上报"],
        text: [
            "Old apps refuse it, and a robot resends it without an acknowledgement. An exhaustive match over all reports \
             needs another case.",
            "旧 app 会拒绝，机器人会重发但得不到应答。穷尽匹配所有上报的代码要多一个分支。",
        ],
    }
    CODE_CHANGED {
        number: 17,
        name: "code-changed",
        wire: Wire::Both,
        mirror: &[17, 20],
        title: ["an operation has another code", "功能码变更"],
        text: [
            "Each version sends a code that the other does not know. Keep the code, or add a new operation and keep the old one.",
            "双方发送的功能码对方都不认识。保留原功能码；或另加一个新接口，旧接口不变。",
        ],
    }
    CODE_REUSED {
        number: 18,
        name: "retired-code-reused",
        wire: Wire::Both,
        silent: true,
        is_error: true,
        no_mirror: [
            "the opposite change removes the operation (FC0713) or changes its code (FC0717)",
            "反向变更是删除接口（FC0713）或变更功能码（FC0717）",
        ],
        title: ["a code with an earlier meaning is in use", "旧功能码另作他用"],
        text: [
            "The code was retired, or belonged to another operation. A peer of the other version reads the message in the \
             old meaning, without an error. A waiver is not allowed.",
            "该功能码已退役，或属于另一个接口。另一个版本会按旧含义处理，且不会报错。不允许豁免。",
        ],
    }
    TOMBSTONE_REMOVED {
        number: 19,
        name: "tombstone-removed",
        is_error: true,
        no_mirror: ["retiring a code has no effect on programs", "退役功能码不影响任何程序"],
        title: ["a retired code is no longer listed", "退役的功能码从列表中消失"],
        text: [
            "Without its entry, the code can be assigned again. Keep the entry.",
            "没有这条记录，该功能码可能被再次分配。保留这条记录。",
        ],
    }
    CODE_ASSIGNED {
        number: 20,
        name: "code-assigned",
        wire: Wire::NewSender,
        mirror: &[17],
        title: ["an operation got its code", "接口分配了功能码"],
        text: [
            "Without a code it could not be sent. An old robot refuses a command with this code as unknown; an old app ignores \
             a report.",
            "没有功能码时无法发送。旧机器人按未知指令拒绝；旧 app 忽略上报。",
        ],
    }
    OPERATION_RENAMED {
        number: 21,
        name: "operation-renamed",
        source: EVERY,
        mirror: &[21],
        title: ["an operation has another name", "接口改名"],
        text: [
            "Kind and code are the same, so messages are the same. Programs with the old name do not compile. Check that its \
             meaning is unchanged.",
            "类型和功能码不变，报文不受影响；引用旧名称的代码无法编译。请确认含义没有变。",
        ],
    }
    KIND_CHANGED {
        number: 22,
        name: "kind-or-direction-changed",
        wire: Wire::Both,
        source: EVERY,
        mirror: &[22],
        title: ["an operation has another kind or sender", "接口的类型或发送方变更"],
        text: [
            "Its frames have another kind or another sender, and the other version does not expect them.",
            "帧的类型或发送方变了，另一个版本不会这样处理。",
        ],
    }
    EFFECT_RAISED {
        number: 23,
        name: "effect-raised",
        behaviour: true,
        no_mirror: [
            "callers that guard against a larger effect still work",
            "影响变小，调用方原有的防护依然够用",
        ],
        title: ["a command has a larger effect on the robot", "指令对机器人的影响变大"],
        text: [
            "Programs may resend it freely, or allow it without a permission, because its effect was smaller. Check them.",
            "程序按原来较小的影响编写，可能会随意重发，或不做权限检查。检查这些程序。",
        ],
    }
    GROUP_MOVED {
        number: 24,
        name: "group-moved",
        source: &[Rust, Kotlin, Cpp],
        mirror: &[24],
        title: ["an operation moved to another group", "接口移到另一个分组"],
        text: [
            "Its path changes in languages with one module per group.",
            "在按分组生成模块的语言里，引用路径会变。",
        ],
    }
}
