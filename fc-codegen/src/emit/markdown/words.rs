//! Words of the pages for the enums of the model.

use fc_spec::model::Lang;
use fc_spec::model::{
    AnswerKind, BodyState, ByteOrder, CodeRange, Confirmation, Direction, Effect, EncodingRole,
    EnvelopeRole, HeaderRole, Impact, JsonRule, Kind, KindRole, PortRole, Quirk, RangeUse,
    ResultRole, Severity, Side, Text, Type, TypeRef, WireForm,
};
use fc_spec::text;

/// The word for a value of the model on a page.
pub(crate) trait Word {
    fn word(&self, lang: Lang) -> &'static str;
}

/// Declares the words of an enum, Chinese first. A missing value does not compile.
macro_rules! words {
    ($Set:ident: $($Word:ident = $zh:literal, $en:literal;)+) => {
        impl Word for $Set {
            fn word(&self, lang: Lang) -> &'static str {
                match self {
                    $(Self::$Word => lang.pick($zh, $en),)+
                }
            }
        }
    };
}

words! { Kind:
    Command = "指令", "command";
    Report = "主动上报", "report";
    Stream = "数据流", "stream";
}

words! { Effect:
    Read = "读取", "read";
    Config = "配置", "config";
    Motion = "运动", "motion";
    Unknown = "影响不详", "unknown effect";
}

words! { BodyState:
    Free = "不限定", "any keys";
    Stated = "写明", "stated";
    Confirmed = "已确认", "confirmed";
    Inferred = "推断", "inferred";
    Open = "待定", "open";
}

words! { AnswerKind:
    Decision = "决定", "Decision";
    Quirk = "兼容", "Quirk";
    Note = "说明", "Note";
    Question = "待确认", "Question";
}

words! { Impact:
    NoCode = "没有功能码，不能调用", "No code: cannot be called";
    NoBody = "正文缺失，无法按字段使用", "Lost body: cannot be used by its keys";
    NoEffect = "影响不详", "Unknown effect";
    Doubtful = "数值可能被误读", "Values that may be misread";
    Inferred = "推断，有待确认", "Inferences to confirm";
    Behaviour = "行为没有说明", "Behaviour that is not described";
    Decided = "已按决定执行", "Decided here";
}

words! { Severity:
    High = "高", "high";
    Medium = "中", "medium";
    Low = "低", "low";
}

words! { PortRole:
    Command = "指令端口", "command port";
    Data = "数据端口", "data port";
}

words! { JsonRule:
    Text = "正文", "Body";
    KnownKeys = "已知的键", "Known keys";
    UnknownKeys = "未知的键", "Unknown keys";
    Integers = "整数", "Integers";
    Floats = "浮点数", "Floats";
    Strings = "字符串", "Strings";
}

words! { ByteOrder:
    Big = "大端（高位字节在前）", "big-endian (most significant byte first)";
    Little = "小端（低位字节在前）", "little-endian (least significant byte first)";
}

words! { HeaderRole:
    Head = "帧头", "head";
    Kind = "数据类型", "kind";
    Code = "功能码", "code";
    Id = "消息 id", "id";
    Encoding = "压缩方式", "encoding";
    Status = "状态", "status";
    TotalLength = "总长度", "total length";
    PlainLength = "压缩前长度", "plain length";
    Digest = "校验", "digest";
}

words! { KindRole:
    Stream = "原始字节", "raw bytes";
    Command = "指令及其响应", "commands and their responses";
    Report = "主动上报及其应答", "reports and their acknowledgements";
    Reserved = "预留，收到即拒绝", "reserved; always refused";
}

words! { EncodingRole:
    Plain = "不压缩", "uncompressed";
    Gzip = "一个 gzip 成员（RFC 1952）", "one gzip member (RFC 1952)";
}

words! { EnvelopeRole:
    Time = "生成时间", "time of creation";
    ResultCode = "结果码", "result code";
    ResultText = "结果说明，只供人阅读", "result text, for people only";
}

words! { ResultRole:
    Success = "处理成功", "the handler succeeded";
    Protocol = "功能码未知、数据类型为预留，或校验不符", "unknown code, reserved kind or wrong digest";
    Timeout = "处理程序没有按时给出结果", "the handler did not respond in time";
    Invalid = "正文无法解析，或不满足约束", "the body does not parse or violates a constraint";
    Expired = "消息早于允许的时限", "the message is older than allowed";
}

words! { RangeUse:
    PassThrough = "透传给上装", "passed through to the upper body";
    Commands = "新增指令", "new commands";
    Reports = "新增主动上报", "new reports";
    Reserved = "保留，不分配", "reserved";
    Historic = "历史号段，不再新增", "historic, closed";
}

words! { Quirk:
    EmptyIsAbsent = "收到 `null`、`{}`、`[]` 或 `\"\"` 时，按没有该字段处理", "`null`, `{}`, `[]` and `\"\"` are treated as absent when received";
    LenientNumber = "接收时，数字写成 JSON 数字、十进制字符串或 `0x` 字符串都接受", "received as a JSON number, a decimal string or a `0x` string";
    LenientBool = "接收时，`true`/`false`、`\"true\"`/`\"false\"`、`0`/`1` 都接受", "received as `true`/`false`, `\"true\"`/`\"false\"` or `0`/`1`";
}

/// Returns a note about the form of a field in messages, if it differs from the type.
pub(super) fn sent(form: WireForm, lang: Lang) -> Option<&'static str> {
    match form {
        WireForm::Plain => None,
        WireForm::String => Some(lang.pick("以字符串传输", "sent as a string")),
        WireForm::Number => {
            let words = "sent as a number: 1 is true, 0 is false";
            Some(lang.pick("以数字传输：1 为 true，0 为 false", words))
        }
    }
}

/// Returns the word for a message of an operation. A report is acknowledged, and a command gets a response.
pub(super) fn side(kind: Kind, direction: Direction, lang: Lang) -> &'static str {
    match (kind, direction) {
        (Kind::Command, Direction::Request) => lang.pick("请求", "request"),
        (Kind::Command, Direction::Response) => lang.pick("响应", "response"),
        (Kind::Report, Direction::Request) => lang.pick("上报", "report"),
        (Kind::Report, Direction::Response) => lang.pick("应答", "acknowledgement"),
        (Kind::Stream, _) => lang.pick("数据", "data"),
    }
}

/// Returns the word for the body of a message of an operation.
pub(super) fn body(kind: Kind, direction: Direction, lang: Lang) -> &'static str {
    match (kind, direction) {
        (Kind::Command, Direction::Request) => lang.pick("请求正文", "request body"),
        (Kind::Command, Direction::Response) => lang.pick("响应正文", "response body"),
        (_, Direction::Request) => lang.pick("上报正文", "report body"),
        (_, Direction::Response) => lang.pick("应答正文", "acknowledgement body"),
    }
}

/// Returns the sender and the receiver, such as `app → robot`.
pub(super) fn direction(sender: Side, robot: &str, app: &str) -> String {
    match sender {
        Side::App => format!("{app} → {robot}"),
        Side::Robot => format!("{robot} → {app}"),
    }
}

/// Returns a type in the spelling of the spec. `inline` can replace the name of a type.
pub(super) fn type_name(ty: &Type, inline: &dyn Fn(&TypeRef) -> Option<&'static str>) -> String {
    match ty {
        Type::Array(item) => format!("[{}]", type_name(item, inline)),
        Type::Named(named) => inline(named).map_or_else(|| named.to_string(), str::to_owned),
        built_in => built_in.to_string(),
    }
}

/// Returns a sentence with the person, the date and the details of a confirmation.
pub(crate) fn confirmed(confirmation: &Confirmation, lang: Lang) -> String {
    let Confirmation {
        by,
        date,
        reference,
        reply,
    } = confirmation;
    let word = lang.pick(
        format!("{by} 于 {date} 确认"),
        format!("confirmed by {by} on {date}"),
    );
    let reference = reference
        .as_ref()
        .map(|reference| lang.pick(format!("（{reference}）"), format!(" ({reference})")));
    let reply = reply
        .as_ref()
        .map(|reply| lang.pick(format!("，原话“{reply}”"), format!(": \"{reply}\"")));
    word + &reference.unwrap_or_default() + &reply.unwrap_or_default()
}

/// Returns the use of a range, and the groups that it names.
pub(crate) fn purpose(range: &CodeRange, lang: Lang) -> String {
    let usage = range.usage.word(lang);
    if range.groups.is_empty() {
        return usage.to_owned();
    }
    let groups = Text::listed(&range.groups);
    lang.text(&text!(
        "{usage}（{groups}）",
        "{usage} ({groups})",
        groups = groups
    ))
    .to_owned()
}
