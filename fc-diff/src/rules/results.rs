//! Results, acknowledgements, leniencies and tables.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, Python, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    RESULT_CODE {
        number: 58,
        name: "result-code-changed",
        wire: Wire::Both,
        silent: true,
        mirror: &[58],
        title: ["a result has another code or role", "结果码的编号或角色变更"],
        text: [
            "One side may read an error of the other as a success or as another error, without an error message.",
            "一方的失败可能被另一方当成成功或别的错误，且不会报错。",
        ],
    }
    ERROR_ADDED {
        number: 59,
        name: "operation-error-added",
        source: &[Rust, Typescript],
        behaviour: true,
        mirror: &[68],
        title: ["an operation may return another error", "接口新增可能返回的错误"],
        text: [
            "Old apps may not handle the new result. In Rust and TypeScript, an exhaustive match over the errors of a command \
             needs another case.",
            "旧 app 可能没有处理新的结果。Rust 和 TypeScript 中穷尽匹配该指令错误的代码要多一个分支。",
        ],
    }
    ACK_TIMING {
        number: 60,
        name: "ack-timing-changed",
        behaviour: true,
        mirror: &[60],
        title: ["reports are resent at other times", "上报的重发时机变更"],
        text: [
            "A shorter wait or more resends cause duplicates. Fewer resends cause losses.",
            "等待变短或重发变多会产生重复，重发变少会造成丢失。",
        ],
    }
    TIMES {
        number: 61,
        name: "times-tightened",
        wire: Wire::OldSender,
        behaviour: true,
        no_mirror: [
            "more time and a later expiry keep everything accepted",
            "时间放宽后，原来能接受的仍能接受",
        ],
        title: ["handlers can take longer than calls, or messages expire earlier", "处理超时长于调用超时，或消息过期提前"],
        text: [
            "If a handler may take longer than a call waits, apps give up while the robot continues. If messages expire, or expire \
             earlier, the robot refuses old senders with queues or wrong clocks.",
            "处理时间可以长于调用等待时间时，app 已放弃而机器人还在执行。过期时间新设或缩短后，有排队或时钟不准的旧发送方会被拒绝。",
        ],
    }
    QUIRK_REMOVED {
        number: 62,
        name: "quirk-removed",
        wire: Wire::OldSender,
        no_mirror: ["a more lenient receiver has no effect on programs", "接收方放宽不影响任何程序"],
        title: ["a receiver is no longer lenient", "接收方不再放宽"],
        text: [
            "Receivers refuse senders that rely on the leniency. Make sure that no such sender is left.",
            "依赖这一放宽处理的发送方会被拒绝。请先确认已没有这样的发送方。",
        ],
    }
    ERROR_REMOVED {
        number: 68,
        name: "operation-error-removed",
        source: &[Rust, Cpp, Python, Typescript],
        mirror: &[59],
        title: ["an operation no longer answers an error", "接口不再返回某个错误"],
        text: [
            "Messages are the same. Programs that use the error of this command do not compile. Kotlin uses result codes instead.",
            "报文不受影响。使用该指令这个错误的代码无法编译。Kotlin 直接使用结果码，不受影响。",
        ],
    }
    RESULT_ADDED {
        number: 69,
        name: "result-added",
        source: &[Rust],
        behaviour: true,
        mirror: &[70],
        title: ["a result is new", "新增结果码"],
        text: [
            "Old apps and robots keep the code as an unknown error. In Rust an exhaustive match has one more case.",
            "旧 app 和旧机器人当作未知错误保留。Rust 中穷尽匹配的代码要多一个分支。",
        ],
    }
    RESULT_REMOVED {
        number: 70,
        name: "result-removed",
        source: EVERY,
        behaviour: true,
        mirror: &[69],
        title: ["a result is gone", "删除了结果码"],
        text: [
            "Old apps and robots may still send the code, and new ones keep it as an unknown error. Programs that use its name do \
             not compile.",
            "旧 app 和旧机器人仍可能返回它，新的一方当作未知错误保留。引用它的代码无法编译。",
        ],
    }
    TABLE_ADDED {
        number: 71,
        name: "table-added",
        mirror: &[72],
        title: ["a table of constants is new", "新增常量表"],
        text: [
            "Nothing breaks.",
            "不影响任何一方。",
        ],
    }
    TABLE_REMOVED {
        number: 72,
        name: "table-removed",
        source: EVERY,
        mirror: &[71],
        title: ["a table of constants is gone", "删除了常量表"],
        text: [
            "Messages are the same. Programs that read the table do not compile.",
            "报文不受影响。读取该表的代码无法编译。",
        ],
    }
}
