//! Results, acknowledgements, leniencies and tables.

use super::{BASE, EVERY, rules};
use crate::rule::Language::{Cpp, Python, Rust, Typescript};
use crate::rule::{Rule, Wire};

rules! {
    FC0758 RESULT_CODE "result-code-changed" "结果码的编号或角色变更" "a result has another code or role" {
        wire: Wire::Both, silent: true, mirror: &[58],
    }
    FC0759 ERROR_ADDED "operation-error-added" "接口新增可能返回的错误" "an operation may return another error" {
        source: &[Rust, Typescript], behaviour: true, mirror: &[68],
    }
    FC0760 ACK_TIMING "ack-timing-changed" "上报的重发时机变更" "reports are resent at other times" {
        behaviour: true, mirror: &[60],
    }
    FC0761 TIMES "times-tightened" "处理超时长于调用超时，或消息过期提前" "handlers can take longer than calls, or messages expire earlier" {
        wire: Wire::OldSender, behaviour: true,
        no_mirror: ["more time and a later expiry keep everything accepted", "时间放宽后，原来能接受的仍能接受"],
    }
    FC0762 QUIRK_REMOVED "quirk-removed" "接收方不再放宽" "a receiver is no longer lenient" {
        wire: Wire::OldSender,
        no_mirror: ["a more lenient receiver has no effect on programs", "接收方放宽不影响任何程序"],
    }
    FC0768 ERROR_REMOVED "operation-error-removed" "接口不再返回某个错误" "an operation no longer answers an error" {
        source: &[Rust, Cpp, Python, Typescript], mirror: &[59],
    }
    FC0769 RESULT_ADDED "result-added" "新增结果码" "a result is new" {
        source: &[Rust], behaviour: true, mirror: &[70],
    }
    FC0770 RESULT_REMOVED "result-removed" "删除了结果码" "a result is gone" {
        source: EVERY, behaviour: true, mirror: &[69],
    }
    FC0771 TABLE_ADDED "table-added" "新增常量表" "a table of constants is new" {
        mirror: &[72],
    }
    FC0772 TABLE_REMOVED "table-removed" "删除了常量表" "a table of constants is gone" {
        source: EVERY, mirror: &[71],
    }
}
