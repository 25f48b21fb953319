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

/// A check with its name and the demand behind it.
pub(super) struct About {
    pub(super) check: Check,
    pub(super) name: &'static str,
    /// The demand in Chinese.
    pub(super) zh: &'static str,
    /// The demand in English.
    pub(super) en: &'static str,
}

/// All checks, in their order, with their names and demands.
pub(super) const CHECKS: [About; 23] = [
    About {
        check: Check::Ids,
        name: "request.ids",
        zh: "响应的消息号与请求相同，包括最小和最大的消息号",
        en: "a response has the message id of its request, also the smallest and the largest",
    },
    About {
        check: Check::Split,
        name: "request.split",
        zh: "逐字节到达的请求得到响应",
        en: "a request that arrives byte by byte gets its response",
    },
    About {
        check: Check::Pipelined,
        name: "request.pipelined",
        zh: "同时发送的请求各得到一个响应",
        en: "requests that are sent together get one response each",
    },
    About {
        check: Check::Compressed,
        name: "request.compressed",
        zh: "压缩的请求得到响应",
        en: "a compressed request gets its response",
    },
    About {
        check: Check::UnknownKey,
        name: "request.unknown_key",
        zh: "忽略未知的键",
        en: "an unknown key is ignored",
    },
    About {
        check: Check::MissingKey,
        name: "request.missing_key",
        zh: "缺少必需的键的请求被拒绝：参数不合法",
        en: "a request without a required key is refused as invalid",
    },
    About {
        check: Check::WrongType,
        name: "request.wrong_type",
        zh: "类型错误的请求被拒绝：参数不合法",
        en: "a request with a value of another type is refused as invalid",
    },
    About {
        check: Check::BadJson,
        name: "request.bad_json",
        zh: "不是 JSON 的请求被拒绝：参数不合法，连接保持",
        en: "a request without valid JSON is refused as invalid, and the connection stays",
    },
    About {
        check: Check::UnknownCode,
        name: "request.unknown_code",
        zh: "未知的功能码被拒绝：协议错误",
        en: "an unknown code is refused as a protocol error",
    },
    About {
        check: Check::HalfClosed,
        name: "connection.half_closed",
        zh: "app 关闭发送方向之后仍得到响应",
        en: "an app that has closed its sending side still gets its response",
    },
    About {
        check: Check::TwoApps,
        name: "connection.two_apps",
        zh: "两个 app 同时得到服务",
        en: "two apps are served at the same time",
    },
    About {
        check: Check::BadHead,
        name: "frame.bad_head",
        zh: "帧头错误时断开连接，其他 app 不受影响",
        en: "a wrong head ends the connection and no other",
    },
    About {
        check: Check::ShortFrame,
        name: "frame.short",
        zh: "总长度小于帧头时断开连接",
        en: "a length below that of the header ends the connection",
    },
    About {
        check: Check::LongFrame,
        name: "frame.long",
        zh: "总长度超过上限时断开连接",
        en: "a length above the limit ends the connection",
    },
    About {
        check: Check::UnknownKind,
        name: "frame.unknown_kind",
        zh: "未知的种类被拒绝：协议错误，连接保持",
        en: "an unknown kind is refused as a protocol error, and the connection stays",
    },
    About {
        check: Check::BadDigest,
        name: "frame.bad_digest",
        zh: "摘要错误的帧被拒绝：协议错误，连接保持",
        en: "a wrong digest is refused as a protocol error, and the connection stays",
    },
    About {
        check: Check::BadGzip,
        name: "frame.bad_gzip",
        zh: "不能解压的帧被拒绝：协议错误，连接保持",
        en: "damaged compression is refused as a protocol error, and the connection stays",
    },
    About {
        check: Check::GzipBomb,
        name: "frame.gzip_bomb",
        zh: "解压后超过上限的帧不被解压，机器人继续服务",
        en: "data that would inflate beyond the limit is not inflated, and the robot goes on",
    },
    About {
        check: Check::DeepNesting,
        name: "frame.deep_nesting",
        zh: "嵌套过深的 JSON 被拒绝，机器人继续服务",
        en: "JSON that is nested too deeply is refused, and the robot goes on",
    },
    About {
        check: Check::Unfinished,
        name: "connection.unfinished",
        zh: "帧只到达一半时，其他 app 得到服务",
        en: "half of a frame keeps no other app waiting",
    },
    About {
        check: Check::ReportValid,
        name: "report.valid",
        zh: "上报合乎规范",
        en: "reports fit the spec",
    },
    About {
        check: Check::ReportRepeated,
        name: "report.repeated",
        zh: "没有应答的上报以相同的消息号重发，直到规定的次数",
        en: "a report without an acknowledgement is repeated with its id, as often as the spec says",
    },
    About {
        check: Check::ReportAcknowledged,
        name: "report.acknowledged",
        zh: "已应答的上报不再重发",
        en: "an acknowledged report is not repeated",
    },
];

impl Check {
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
