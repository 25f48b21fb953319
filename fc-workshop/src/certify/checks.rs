//! The checks that need any command, and the demand behind each.

use super::line::{Evidence, Step};
use super::robot::Stage;
use super::{malformed, reports, requests};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

/// A check of a robot.
pub(super) struct Check {
    pub(super) name: &'static str,
    /// The demand in Chinese.
    pub(super) zh: &'static str,
    /// The demand in English.
    pub(super) en: &'static str,
    pub(super) run: Run,
}

/// Runs a check.
type Run = for<'a> fn(&'a Stage<'_, '_>, &'a mut Evidence) -> LocalBoxFuture<'a, Step>;

/// All checks, in their order, with their names and demands.
pub(super) const CHECKS: [Check; 23] = [
    Check {
        name: "request.ids",
        zh: "响应的消息号与请求相同，包括最小和最大的消息号",
        en: "a response has the message id of its request, also the smallest and the largest",
        run: |stage, evidence| requests::ids(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.split",
        zh: "逐字节到达的请求得到响应",
        en: "a request that arrives byte by byte gets its response",
        run: |stage, evidence| requests::split(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.pipelined",
        zh: "同时发送的请求各得到一个响应",
        en: "requests that are sent together get one response each",
        run: |stage, evidence| requests::pipelined(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.compressed",
        zh: "压缩的请求得到响应",
        en: "a compressed request gets its response",
        run: |stage, evidence| requests::compressed(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.unknown_key",
        zh: "忽略未知的键",
        en: "an unknown key is ignored",
        run: |stage, evidence| requests::unknown_key(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.missing_key",
        zh: "缺少必需的键的请求被拒绝：参数不合法",
        en: "a request without a required key is refused as invalid",
        run: |stage, evidence| requests::missing_key(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.wrong_type",
        zh: "类型错误的请求被拒绝：参数不合法",
        en: "a request with a value of another type is refused as invalid",
        run: |stage, evidence| requests::wrong_type(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.bad_json",
        zh: "不是 JSON 的请求被拒绝：参数不合法，连接保持",
        en: "a request without valid JSON is refused as invalid, and the connection stays",
        run: |stage, evidence| requests::bad_json(stage, evidence).boxed_local(),
    },
    Check {
        name: "request.unknown_code",
        zh: "未知的功能码被拒绝：协议错误",
        en: "an unknown code is refused as a protocol error",
        run: |stage, evidence| requests::unknown_code(stage, evidence).boxed_local(),
    },
    Check {
        name: "connection.half_closed",
        zh: "app 关闭发送方向之后仍得到响应",
        en: "an app that has closed its sending side still gets its response",
        run: |stage, evidence| requests::half_closed(stage, evidence).boxed_local(),
    },
    Check {
        name: "connection.two_apps",
        zh: "两个 app 同时得到服务",
        en: "two apps are served at the same time",
        run: |stage, evidence| requests::two_apps(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.bad_head",
        zh: "帧头错误时断开连接，其他 app 不受影响",
        en: "a wrong head ends the connection and no other",
        run: |stage, evidence| malformed::bad_head(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.short",
        zh: "总长度小于帧头时断开连接",
        en: "a length below that of the header ends the connection",
        run: |stage, evidence| malformed::wrong_length(stage, evidence, 1).boxed_local(),
    },
    Check {
        name: "frame.long",
        zh: "总长度超过上限时断开连接",
        en: "a length above the limit ends the connection",
        run: |stage, evidence| malformed::wrong_length(stage, evidence, u64::MAX).boxed_local(),
    },
    Check {
        name: "frame.unknown_kind",
        zh: "未知的种类被拒绝：协议错误，连接保持",
        en: "an unknown kind is refused as a protocol error, and the connection stays",
        run: |stage, evidence| malformed::unknown_kind(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.bad_digest",
        zh: "摘要错误的帧被拒绝：协议错误，连接保持",
        en: "a wrong digest is refused as a protocol error, and the connection stays",
        run: |stage, evidence| malformed::bad_digest(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.bad_gzip",
        zh: "不能解压的帧被拒绝：协议错误，连接保持",
        en: "damaged compression is refused as a protocol error, and the connection stays",
        run: |stage, evidence| malformed::bad_gzip(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.gzip_bomb",
        zh: "解压后超过上限的帧不被解压，机器人继续服务",
        en: "data that would inflate beyond the limit is not inflated, and the robot goes on",
        run: |stage, evidence| malformed::gzip_bomb(stage, evidence).boxed_local(),
    },
    Check {
        name: "frame.deep_nesting",
        zh: "嵌套过深的 JSON 被拒绝，机器人继续服务",
        en: "JSON that is nested too deeply is refused, and the robot goes on",
        run: |stage, evidence| malformed::deep_nesting(stage, evidence).boxed_local(),
    },
    Check {
        name: "connection.unfinished",
        zh: "帧只到达一半时，其他 app 得到服务",
        en: "half of a frame keeps no other app waiting",
        run: |stage, evidence| malformed::unfinished(stage, evidence).boxed_local(),
    },
    Check {
        name: "report.valid",
        zh: "上报合乎规范",
        en: "reports fit the spec",
        run: |stage, evidence| reports::valid(stage, evidence).boxed_local(),
    },
    Check {
        name: "report.repeated",
        zh: "没有应答的上报以相同的消息号重发，直到规定的次数",
        en: "a report without an acknowledgement is repeated with its id, as often as the spec says",
        run: |stage, evidence| reports::repeated(stage, evidence).boxed_local(),
    },
    Check {
        name: "report.acknowledged",
        zh: "已应答的上报不再重发",
        en: "an acknowledged report is not repeated",
        run: |stage, evidence| reports::acknowledged(stage, evidence).boxed_local(),
    },
];
