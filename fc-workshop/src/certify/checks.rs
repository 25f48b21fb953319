//! The checks that need any command, and the demand behind each.

use super::line::{Evidence, Step};
use super::robot::Stage;
use super::{malformed, reports, requests};

/// A check of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Check {
    Ids,
    Split,
    Pipelined,
    Compressed,
    UnknownKey,
    MissingKey,
    WrongType,
    BadJson,
    UnknownCode,
    HalfClosed,
    TwoApps,
    BadHead,
    ShortFrame,
    LongFrame,
    UnknownKind,
    BadDigest,
    BadGzip,
    GzipBomb,
    DeepNesting,
    Unfinished,
    ReportValid,
    ReportRepeated,
    ReportAcknowledged,
}

/// All checks, in their order.
pub(super) const CHECKS: [Check; 23] = [
    Check::Ids,
    Check::Split,
    Check::Pipelined,
    Check::Compressed,
    Check::UnknownKey,
    Check::MissingKey,
    Check::WrongType,
    Check::BadJson,
    Check::UnknownCode,
    Check::HalfClosed,
    Check::TwoApps,
    Check::BadHead,
    Check::ShortFrame,
    Check::LongFrame,
    Check::UnknownKind,
    Check::BadDigest,
    Check::BadGzip,
    Check::GzipBomb,
    Check::DeepNesting,
    Check::Unfinished,
    Check::ReportValid,
    Check::ReportRepeated,
    Check::ReportAcknowledged,
];

impl Check {
    /// Returns the name, and the demand in Chinese and in English.
    pub(super) fn about(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Ids => (
                "request.ids",
                "响应的消息号与请求相同，包括最小和最大的消息号",
                "a response has the message id of its request, also the smallest and the largest",
            ),
            Self::Split => (
                "request.split",
                "逐字节到达的请求得到响应",
                "a request that arrives byte by byte gets its response",
            ),
            Self::Pipelined => (
                "request.pipelined",
                "同时发送的请求各得到一个响应",
                "requests that are sent together get one response each",
            ),
            Self::Compressed => (
                "request.compressed",
                "压缩的请求得到响应",
                "a compressed request gets its response",
            ),
            Self::UnknownKey => (
                "request.unknown_key",
                "忽略未知的键",
                "an unknown key is ignored",
            ),
            Self::MissingKey => (
                "request.missing_key",
                "缺少必需的键的请求被拒绝：参数不合法",
                "a request without a required key is refused as invalid",
            ),
            Self::WrongType => (
                "request.wrong_type",
                "类型错误的请求被拒绝：参数不合法",
                "a request with a value of another type is refused as invalid",
            ),
            Self::BadJson => (
                "request.bad_json",
                "不是 JSON 的请求被拒绝：参数不合法，连接保持",
                "a request that is no JSON is refused as invalid, and the connection stays",
            ),
            Self::UnknownCode => (
                "request.unknown_code",
                "未知的功能码被拒绝：协议错误",
                "an unknown code is refused as a protocol error",
            ),
            Self::HalfClosed => (
                "connection.half_closed",
                "app 关闭发送方向之后仍得到响应",
                "an app that has closed its sending side still gets its response",
            ),
            Self::TwoApps => (
                "connection.two_apps",
                "两个 app 同时得到服务",
                "two apps are served at the same time",
            ),
            Self::BadHead => (
                "frame.bad_head",
                "帧头错误时断开连接，其他 app 不受影响",
                "a wrong head ends the connection and no other",
            ),
            Self::ShortFrame => (
                "frame.short",
                "总长度小于帧头时断开连接",
                "a length below that of the header ends the connection",
            ),
            Self::LongFrame => (
                "frame.long",
                "总长度超过上限时断开连接",
                "a length above the limit ends the connection",
            ),
            Self::UnknownKind => (
                "frame.unknown_kind",
                "未知的种类被拒绝：协议错误，连接保持",
                "an unknown kind is refused as a protocol error, and the connection stays",
            ),
            Self::BadDigest => (
                "frame.bad_digest",
                "摘要错误的帧被拒绝：协议错误，连接保持",
                "a wrong digest is refused as a protocol error, and the connection stays",
            ),
            Self::BadGzip => (
                "frame.bad_gzip",
                "不能解压的帧被拒绝：协议错误，连接保持",
                "damaged compression is refused as a protocol error, and the connection stays",
            ),
            Self::GzipBomb => (
                "frame.gzip_bomb",
                "解压后超过上限的帧不被解压，机器人继续服务",
                "data that would inflate beyond the limit is not inflated, and the robot goes on",
            ),
            Self::DeepNesting => (
                "frame.deep_nesting",
                "嵌套过深的 JSON 被拒绝，机器人继续服务",
                "JSON that is nested too deeply is refused, and the robot goes on",
            ),
            Self::Unfinished => (
                "connection.unfinished",
                "帧只到达一半时，其他 app 得到服务",
                "half of a frame keeps no other app waiting",
            ),
            Self::ReportValid => ("report.valid", "上报合乎规范", "reports fit the spec"),
            Self::ReportRepeated => (
                "report.repeated",
                "没有应答的上报以相同的消息号重发，直到规定的次数",
                "a report without an acknowledgement is repeated with its id, as often as the spec says",
            ),
            Self::ReportAcknowledged => (
                "report.acknowledged",
                "已应答的上报不再重发",
                "an acknowledged report is not repeated",
            ),
        }
    }

    /// Runs the check.
    pub(super) async fn run(self, stage: &Stage<'_, '_>, evidence: &mut Evidence) -> Step {
        match self {
            Self::Ids => requests::ids(stage, evidence).await,
            Self::Split => requests::split(stage, evidence).await,
            Self::Pipelined => requests::pipelined(stage, evidence).await,
            Self::Compressed => requests::compressed(stage, evidence).await,
            Self::UnknownKey => requests::unknown_key(stage, evidence).await,
            Self::MissingKey => requests::missing_key(stage, evidence).await,
            Self::WrongType => requests::wrong_type(stage, evidence).await,
            Self::BadJson => requests::bad_json(stage, evidence).await,
            Self::UnknownCode => requests::unknown_code(stage, evidence).await,
            Self::HalfClosed => requests::half_closed(stage, evidence).await,
            Self::TwoApps => requests::two_apps(stage, evidence).await,
            Self::BadHead => malformed::bad_head(stage, evidence).await,
            Self::ShortFrame => malformed::wrong_length(stage, evidence, 1).await,
            Self::LongFrame => malformed::wrong_length(stage, evidence, u64::MAX).await,
            Self::UnknownKind => malformed::unknown_kind(stage, evidence).await,
            Self::BadDigest => malformed::bad_digest(stage, evidence).await,
            Self::BadGzip => malformed::bad_gzip(stage, evidence).await,
            Self::GzipBomb => malformed::gzip_bomb(stage, evidence).await,
            Self::DeepNesting => malformed::deep_nesting(stage, evidence).await,
            Self::Unfinished => malformed::unfinished(stage, evidence).await,
            Self::ReportValid => reports::valid(stage, evidence).await,
            Self::ReportRepeated => reports::repeated(stage, evidence).await,
            Self::ReportAcknowledged => reports::acknowledged(stage, evidence).await,
        }
    }
}
