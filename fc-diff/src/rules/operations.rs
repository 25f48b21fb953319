//! Operations.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    COMMAND_REMOVED {
        number: 13,
        name: "command-removed",
        wire: Wire::OldSender,
        source: EVERY,
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
        source: &[Rust, Kotlin, Cpp, Python, Typescript],
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
        source: EVERY,
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
        source: &[Rust, Cpp, Typescript],
        behaviour: true,
        mirror: &[15],
        title: ["a report is new", "新增了上报"],
        text: [
            "Old apps refuse it, and a robot resends it without an acknowledgement. In Rust, C++ and TypeScript, an exhaustive \
             match over all reports needs another case.",
            "旧 app 会拒绝，机器人会重发但得不到应答。Rust、C++ 和 TypeScript 中穷尽匹配所有上报的代码要多一个分支。",
        ],
    }
    CODE_CHANGED {
        number: 17,
        name: "code-changed",
        wire: Wire::Both,
        source: EVERY,
        mirror: &[17, 20],
        title: ["an operation has another code", "功能码变更"],
        text: [
            "Each version sends a code that the other does not know. Keep the code, or add a new operation and keep the old one. \
             An operation without a code has no methods.",
            "双方发送的功能码对方都不认识。保留原功能码；或另加一个新接口，旧接口不变。功能码改为未分配后，相应的方法也会消失。",
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
        source: &[Rust, Kotlin, Cpp, Python, Typescript],
        mirror: &[17],
        title: ["an operation got its code", "接口分配了功能码"],
        text: [
            "Without a code it could not be sent. An old robot refuses a command with this code as unknown; an old app ignores \
             a report. Programs see a new operation.",
            "没有功能码时无法发送。旧机器人按未知指令拒绝；旧 app 忽略上报。对代码来说，相当于新增一个接口。",
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
        mirror: &[73],
        title: ["a command has a larger effect on the robot", "指令对机器人的影响变大"],
        text: [
            "Programs may resend it freely, or allow it without a permission, because its effect was smaller. Check them.",
            "程序按原来较小的影响编写，可能会随意重发，或不做权限检查。检查这些程序。",
        ],
    }
    GROUP_MOVED {
        number: 24,
        name: "group-moved",
        source: EVERY,
        mirror: &[24],
        title: ["an operation moved to another group", "接口移到另一个分组"],
        text: [
            "An operation is a member of the modules and interfaces of its group. In Rust, Python and C++ the path of a type \
             includes the group.",
            "接口属于所在分组的模块和类型。类型的路径中，Rust、Python 和 C++ 含有分组名。",
        ],
    }
    EFFECT_LOWERED {
        number: 73,
        name: "effect-lowered",
        behaviour: true,
        mirror: &[23],
        title: ["a command has a smaller effect on the robot", "指令对机器人的影响变小"],
        text: [
            "New apps repeat a `read` automatically when they get no response. New robots stop the handler of a command that moves \
             nothing when no app waits for it. With an old robot, repeating the command may be unsafe.",
            "没有收到响应时，新 app 会自动重发 `read` 指令。没有 app 等待时，新机器人会中断不引起动作的处理程序。对旧机器人重发，可能不安全。",
        ],
    }
    SET_OFF_ADDED {
        number: 78,
        name: "set-off-added",
        source: &[
            Kotlin,
            JvmBinary,
            Python,
            Typescript,
        ],
        mirror: &[79],
        title: ["a command sets off another report", "指令新增引起的上报"],
        text: [
            "Programs can follow the report. After a first report, the names of the methods in Kotlin and Python include the \
             report. After none, the return type in Python and TypeScript changes.",
            "程序可以跟踪这种上报。原来有一种上报时，Kotlin 和 Python 的方法名会加上上报名。原来没有时，Python 和 TypeScript 的返回类型会变。",
        ],
    }
    SET_OFF_REMOVED {
        number: 79,
        name: "set-off-removed",
        source: EVERY,
        behaviour: true,
        mirror: &[78],
        title: ["a command no longer sets off a report", "指令不再引起某种上报"],
        text: [
            "Programs that follow the report wait without success. They do not compile with the new packages.",
            "跟踪它的程序等不到上报，换用新的代码后也无法编译。",
        ],
    }
    ACCEPTED {
        number: 81,
        name: "accepted-states-changed",
        source: &[Rust, Cpp],
        behaviour: true,
        mirror: &[81],
        title: ["a command is accepted in other states", "指令的受理状态变更"],
        text: [
            "A new robot refuses the command in states in which an old robot accepts it, or the reverse. If an enum is no longer \
             listed, Rust and C++ lose the check for it.",
            "新机器人会在旧机器人受理的状态下拒绝该指令，或相反。不再列出某个枚举时，Rust 和 C++ 中对应的检查会消失。",
        ],
    }
    PASS_THROUGH {
        number: 82,
        name: "pass-through-changed",
        source: EVERY,
        behaviour: true,
        mirror: &[82],
        title: ["other codes are passed through", "透传的功能码变更"],
        text: [
            "A new robot passes through codes that an old robot refuses, or the reverse. Without a range, the robot has no method \
             for it.",
            "新机器人会透传旧机器人拒绝的功能码，或相反。号段删除后，机器人一侧对应的方法也会消失。",
        ],
    }
}
