//! The model's enums as words of the pages.

use super::lang::Lang;
use fc_spec::model::{
    AnswerKind, BodyState, ByteOrder, Direction, Effect, EncodingRole, EnvelopeRole, HeaderRole,
    JsonRule, Kind, KindRole, PortRole, Quirk, RangeUse, ResultRole, Severity, Side, Type,
};

/// What a thing of the model is called on a page.
pub(super) trait Word {
    fn word(&self, lang: Lang) -> &'static str;
}

impl Word for Kind {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Command => lang.pick("指令", "command"),
            Self::Report => lang.pick("主动上报", "report"),
            Self::Stream => lang.pick("数据流", "stream"),
        }
    }
}

impl Word for Effect {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Read => lang.pick("读取", "read"),
            Self::Config => lang.pick("配置", "config"),
            Self::Motion => lang.pick("运动", "motion"),
            Self::Unknown => lang.pick("作用不详", "unknown effect"),
        }
    }
}

impl Word for BodyState {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Stated => lang.pick("写明", "stated"),
            Self::Inferred => lang.pick("推断", "inferred"),
            Self::Open => lang.pick("待定", "open"),
        }
    }
}

impl Word for AnswerKind {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Decision => lang.pick("决定", "Decision"),
            Self::Quirk => lang.pick("兼容", "Quirk"),
            Self::Note => lang.pick("说明", "Note"),
            Self::Question => lang.pick("待确认", "Question"),
        }
    }
}

impl Word for Severity {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::High => lang.pick("高", "high"),
            Self::Medium => lang.pick("中", "medium"),
            Self::Low => lang.pick("低", "low"),
        }
    }
}

impl Word for PortRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Command => lang.pick("指令端口", "command port"),
            Self::Data => lang.pick("数据端口", "data port"),
        }
    }
}

impl Word for JsonRule {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Text => lang.pick("正文", "Body"),
            Self::KnownKeys => lang.pick("已知的键", "Known keys"),
            Self::UnknownKeys => lang.pick("未知的键", "Unknown keys"),
            Self::Integers => lang.pick("整数", "Integers"),
            Self::Floats => lang.pick("浮点数", "Floats"),
            Self::Strings => lang.pick("字符串", "Strings"),
        }
    }
}

impl Word for ByteOrder {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Big => lang.pick(
                "大端（高位字节在前）",
                "big-endian (most significant byte first)",
            ),
            Self::Little => lang.pick(
                "小端（低位字节在前）",
                "little-endian (least significant byte first)",
            ),
        }
    }
}

impl Word for HeaderRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Head => lang.pick("帧头", "head"),
            Self::Kind => lang.pick("数据类型", "kind"),
            Self::Code => lang.pick("功能码", "code"),
            Self::Id => lang.pick("消息 id", "id"),
            Self::Encoding => lang.pick("压缩方式", "encoding"),
            Self::Status => lang.pick("状态", "status"),
            Self::TotalLength => lang.pick("总长度", "total length"),
            Self::PlainLength => lang.pick("压缩前长度", "plain length"),
            Self::Digest => lang.pick("校验", "digest"),
        }
    }
}

impl Word for KindRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Stream => lang.pick("原始字节", "raw bytes"),
            Self::Command => lang.pick("指令及其响应", "commands and their responses"),
            Self::Report => lang.pick("主动上报及其应答", "reports and their acknowledgements"),
            Self::Reserved => lang.pick("预留，收到即拒绝", "reserved; always refused"),
        }
    }
}

impl Word for EncodingRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Plain => lang.pick("不压缩", "uncompressed"),
            Self::Gzip => lang.pick("一个 gzip 成员（RFC 1952）", "one gzip member (RFC 1952)"),
        }
    }
}

impl Word for EnvelopeRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Time => lang.pick("生成时间", "time of creation"),
            Self::ResultCode => lang.pick("结果码", "result code"),
            Self::ResultText => lang.pick("结果说明，只供人阅读", "result text, for people only"),
        }
    }
}

impl Word for ResultRole {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::Success => lang.pick("处理成功", "the handler succeeded"),
            Self::Protocol => lang.pick(
                "功能码未知、数据类型为预留，或校验不符",
                "unknown code, reserved kind or wrong digest",
            ),
            Self::Timeout => lang.pick(
                "处理程序没有按时给出结果",
                "the handler did not respond in time",
            ),
            Self::Invalid => lang.pick(
                "正文无法解析，或不满足约束",
                "the body does not parse or violates a constraint",
            ),
            Self::Expired => lang.pick("消息早于允许的时限", "the message is older than allowed"),
        }
    }
}

impl Word for RangeUse {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::PassThrough => lang.pick("透传给上装", "passed through to the upper body"),
            Self::Commands => lang.pick("新增指令", "new commands"),
            Self::Reports => lang.pick("新增主动上报", "new reports"),
            Self::Reserved => lang.pick("保留，不分配", "reserved"),
            Self::Historic => lang.pick("历史号段，不再新增", "historic, closed"),
        }
    }
}

impl Word for Quirk {
    fn word(&self, lang: Lang) -> &'static str {
        match self {
            Self::EmptyIsAbsent => lang.pick(
                "收到 `null`、`{}`、`[]` 或 `\"\"` 时，按没有该字段处理",
                "`null`, `{}`, `[]` and `\"\"` are treated as absent when received",
            ),
            Self::LenientNumber => lang.pick(
                "接收时，数字写成 JSON 数字、十进制字符串或 `0x` 字符串都接受",
                "received as a JSON number, a decimal string or a `0x` string",
            ),
            Self::LenientBool => lang.pick(
                "接收时，`true`/`false`、`\"true\"`/`\"false\"`、`0`/`1` 都接受",
                "received as `true`/`false`, `\"true\"`/`\"false\"` or `0`/`1`",
            ),
        }
    }
}

/// What a message of an operation is called: a report is acknowledged, a command answered.
pub(super) fn side(kind: Kind, direction: Direction, lang: Lang) -> &'static str {
    match (kind, direction) {
        (Kind::Command, Direction::Request) => lang.pick("请求", "request"),
        (Kind::Command, Direction::Response) => lang.pick("响应", "response"),
        (Kind::Report, Direction::Request) => lang.pick("上报", "report"),
        (Kind::Report, Direction::Response) => lang.pick("应答", "acknowledgement"),
        (Kind::Stream, _) => lang.pick("数据", "data"),
    }
}

/// Who sends to whom, such as `app → robot`.
pub(super) fn direction(sender: Side, robot: &str, app: &str) -> String {
    match sender {
        Side::App => format!("{app} → {robot}"),
        Side::Robot => format!("{robot} → {app}"),
    }
}

/// A type as the spec spells it, but for types that `inline` knows another word for.
pub(super) fn type_name(ty: &Type, inline: &dyn Fn(&str) -> Option<&'static str>) -> String {
    match ty {
        Type::Array(item) => format!("[{}]", type_name(item, inline)),
        Type::Named(name) => inline(name).map_or_else(|| name.clone(), str::to_owned),
        built_in => built_in.to_string(),
    }
}
