//! Results, acknowledgements and leniencies.

use super::{BASE, rules};
use crate::rule::{Rule, Wire};

rules! {
    RESULT_CODE {
        number: 58,
        name: "result-code-changed",
        wire: Wire::Both,
        silent: true,
        mirror: &[58],
        title: ["a result has another code or role", "结果码的编号或用途变更"],
        text: [
            "One side takes for a success, or for another error, what the other meant differently. Nothing fails.",
            "一方的失败可能被另一方当成成功或别的错误，且不会报错。",
        ],
    }
    ERROR_ADDED {
        number: 59,
        name: "operation-error-added",
        behaviour: true,
        no_mirror: ["an error that no longer occurs breaks nobody", "不再出现的错误不影响任何一方"],
        title: ["an operation may answer another error", "接口新增可能返回的错误"],
        text: [
            "Old apps get a result that they were not written for.",
            "旧 app 会收到没有考虑过的结果。",
        ],
    }
    ACK_TIMING {
        number: 60,
        name: "ack-timing-changed",
        behaviour: true,
        mirror: &[60],
        title: ["reports are repeated at other times", "上报的重发时机变更"],
        text: [
            "A shorter wait or more retries make duplicates, fewer retries make losses.",
            "等待变短或重发变多会产生重复，重发变少会造成丢失。",
        ],
    }
    TIMES {
        number: 61,
        name: "times-tightened",
        wire: Wire::OldSender,
        behaviour: true,
        no_mirror: [
            "more time and a later expiry refuse nothing that was accepted before",
            "时间放宽不会拒绝原来能接受的内容",
        ],
        title: ["handlers outlast calls, or messages expire earlier", "处理超时长于调用超时，或消息过期提前"],
        text: [
            "Where handlers may take longer than calls wait, apps give up although the robot goes on. Where messages expire, or \
             earlier than before, old senders with queues or wrong clocks are refused.",
            "处理时间可以长于调用等待时间时，app 已放弃而机器人还在执行。过期时间新设或缩短后，有排队或时钟不准的旧发送方会被拒绝。",
        ],
    }
    QUIRK_REMOVED {
        number: 62,
        name: "quirk-removed",
        wire: Wire::OldSender,
        no_mirror: ["a receiver that takes more breaks nobody", "接收方放宽不影响任何一方"],
        title: ["a receiver is no longer lenient", "接收方不再放宽"],
        text: [
            "Senders that rely on the leniency are refused. Make sure that none is left.",
            "依赖这一放宽处理的发送方会被拒绝。请先确认已没有这样的发送方。",
        ],
    }
}
