//! Operations.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, JvmBinary, Kotlin, Python, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    FC0713 COMMAND_REMOVED "command-removed" "删除了指令" "a command is gone" {
        wire: Wire::OldSender, source: EVERY, mirror: &[14],
    }
    FC0714 COMMAND_ADDED "command-added" "新增了指令" "a command is new" {
        wire: Wire::NewSender, source: &[Rust, Kotlin, Cpp, Python, Typescript], behaviour: true, mirror: &[13],
    }
    FC0715 REPORT_REMOVED "report-removed" "删除了上报" "a report is gone" {
        source: EVERY, behaviour: true, mirror: &[16],
    }
    FC0716 REPORT_ADDED "report-added" "新增了上报" "a report is new" {
        source: &[Rust, Cpp, Typescript], behaviour: true, mirror: &[15],
    }
    FC0717 CODE_CHANGED "code-changed" "功能码变更" "an operation has another code" {
        wire: Wire::Both, source: EVERY, mirror: &[17, 20],
    }
    FC0718 CODE_REUSED "retired-code-reused" "旧功能码另作他用" "a code with an earlier meaning is in use" {
        wire: Wire::Both, silent: true, is_error: true,
        no_mirror: ["the opposite change removes the operation (FC0713) or changes its code (FC0717)", "反向变更是删除接口（FC0713）或变更功能码（FC0717）"],
    }
    FC0719 TOMBSTONE_REMOVED "tombstone-removed" "退役的功能码从列表中消失" "a retired code is no longer listed" {
        is_error: true,
        no_mirror: ["retiring a code has no effect on programs", "退役功能码不影响任何程序"],
    }
    FC0720 CODE_ASSIGNED "code-assigned" "接口分配了功能码" "an operation got its code" {
        wire: Wire::NewSender, source: &[Rust, Kotlin, Cpp, Python, Typescript], mirror: &[17],
    }
    FC0721 OPERATION_RENAMED "operation-renamed" "接口改名" "an operation has another name" {
        source: EVERY, mirror: &[21],
    }
    FC0722 KIND_CHANGED "kind-or-direction-changed" "接口的类型或发送方变更" "an operation has another kind or sender" {
        wire: Wire::Both, source: EVERY, mirror: &[22],
    }
    FC0723 EFFECT_RAISED "effect-raised" "指令对机器人的影响变大" "a command has a larger effect on the robot" {
        behaviour: true, mirror: &[73],
    }
    FC0724 GROUP_MOVED "group-moved" "接口移到另一个分组" "an operation moved to another group" {
        source: EVERY, mirror: &[24],
    }
    FC0773 EFFECT_LOWERED "effect-lowered" "指令对机器人的影响变小" "a command has a smaller effect on the robot" {
        behaviour: true, mirror: &[23],
    }
    FC0778 SET_OFF_ADDED "set-off-added" "指令新增引起的上报" "a command sets off another report" {
        source: &[Kotlin, JvmBinary, Python, Typescript, ], mirror: &[79],
    }
    FC0779 SET_OFF_REMOVED "set-off-removed" "指令不再引起某种上报" "a command no longer sets off a report" {
        source: EVERY, behaviour: true, mirror: &[78],
    }
    FC0781 ACCEPTED "accepted-states-changed" "指令的受理状态变更" "a command is accepted in other states" {
        source: &[Rust, Cpp], behaviour: true, mirror: &[81],
    }
    FC0782 PASS_THROUGH "pass-through-changed" "透传的功能码变更" "other codes are passed through" {
        source: EVERY, behaviour: true, mirror: &[82],
    }
}
