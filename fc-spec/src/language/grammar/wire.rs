//! The grammar of the layers below the messages.

use super::common::{BothLanguages, COMMON, TEXT};
use super::form::{
    Code, Entries, Form, HeaderWidth, Int, List, Name, Never, Scalar, Str, Type, WireKey,
};
use super::kind::{AnyKey, Doc, Kind, Said, Table};
use super::operation::Group;
use super::refers::Ref;
use crate::syntax::Node;
use crate::vocabulary::{
    ByteOrder, DigestAlgorithm, EncodingRole, EnvelopeRole, HeaderQuirk, HeaderRole, JsonRule,
    KindRole, PortRole, RangeUse, ResultRole,
};

/// The default digest algorithm.
pub(crate) const DIGEST: DigestAlgorithm = DigestAlgorithm::Md5;

/// A duration in milliseconds.
type Milliseconds = Int<u32>;

grammar! {
    /// Name and parties of the protocol.
    /// 协议的名称和通信双方。
    PROTOCOL: Protocol = "protocol" "协议" {
        /// Short name; the Rust protocol type is its Pascal case.
        /// 短名；改写为大驼峰就是 Rust 中协议类型的名称。
        required id: Name, example "demo";
        /// Version of the spec, quoted.
        /// 规范的版本，要加引号。
        required version: Str, example r#""1.0""#;
        use TEXT.zh, TEXT.en;
        /// Its purpose.
        /// 用途。
        required about: BothLanguages;
        /// The party that listens.
        /// 监听的一方。
        required robot: Party;
        /// The party that connects.
        /// 发起连接的一方。
        required app: Party;
        use COMMON.answers;
    }

    /// A party of the protocol.
    /// 通信的一方。
    PARTY: Party = "party" "通信方" {
        use TEXT.zh, TEXT.en;
        /// Description, with its other names in documents.
        /// 说明，包括文档中的其他叫法。
        required about: BothLanguages;
    }

    /// Host and ports.
    /// 地址和端口。
    TRANSPORT: Transport = "transport" "传输" {
        /// Address of the robot.
        /// 机器人的地址。
        required host: Str, example "10.0.0.2";
        /// Its TCP ports.
        /// 机器人的 TCP 端口。
        required ports: Ports;
        use COMMON.answers;
    }

    /// A TCP port.
    /// 一个 TCP 端口。
    PORT: Port = "port" "端口" {
        /// Its number.
        /// 端口号。
        required number: Int<u16, 1>, example "7001", faults [SamePort];
        use TEXT.zh, TEXT.en;
    }

    /// Layout of a frame. `zh` and `en` describe its data area.
    /// 帧的结构。`zh` 和 `en` 说明数据区。
    FRAME: Frame = "frame" "帧" {
        /// Byte order of the integers in the header.
        /// 包头中整数的字节序。
        required byte_order: ByteOrder;
        use TEXT.zh, TEXT.en;
        /// First bytes of a frame.
        /// 一帧开头的字节。
        required heads: Heads;
        /// Header fields, in the order sent.
        /// 包头的字段，按发送的顺序书写。
        required header: Entries<WireKey, HeaderField, 1>,
            faults [RoleMissing, HeadNotFirst, DuplicateFieldName, UnusableName];
        /// Values of the header's kind field.
        /// 包头中数据类型字段的取值。
        required kinds: Entries<Int<u8>, FrameKind>, faults [RoleMissing];
        /// Values of the header's encoding field; `{}` if it has none.
        /// 包头中压缩方式字段的取值；没有这个字段时写 `{}`。
        required encodings: Entries<Int<u8>, Encoding>, faults [RoleMissing];
        use COMMON.answers;
    }

    /// First bytes of a frame.
    /// 一帧开头的字节。
    HEADS: Heads = "heads" "帧头" {
        /// Head of commands and reports.
        /// 指令和上报的帧头。
        required request: List<Int<u8>, 1>, example "[0x01, 0x02]", faults [HeadLength];
        /// Head of responses and acknowledgements.
        /// 响应和应答的帧头。
        required response: List<Int<u8>, 1>, example "[0x03, 0x04]", faults [HeadsEqual];
    }

    /// A field of the header.
    /// 包头的一个字段。
    HEADER_FIELD: HeaderField = "header field" "包头字段" {
        /// Its width: `u8`, `u16`, `u32`, `u64` or `bytes(16)`.
        /// 宽度：`u8`、`u16`、`u32`、`u64` 或 `bytes(16)`。
        required r#type: HeaderWidth, faults [HeaderWidth, BadHeaderType];
        /// Its role. The runtime sends a field without a role and does not interpret it.
        /// 角色；没有角色的字段只发送，不解释。
        optional role: HeaderRole, faults [RoleTwice];
        /// Algorithm of a digest.
        /// 摘要的算法。
        optional algorithm: DigestAlgorithm, default DIGEST.name(), faults [AlgorithmWithoutDigest];
        use COMMON.name;
        /// Value to send, for a field without a role or with the role `status`.
        /// 没有角色、或角色为 `status` 的字段发送的值。
        optional value: Int<u64>, example "0", faults [HeaderValue];
        /// Leniencies of the decoder.
        /// 解析时的放宽处理。
        optional quirk: List<HeaderQuirk, 1>, faults [HeaderQuirk];
        use TEXT.zh, TEXT.en, COMMON.aliases, COMMON.answers;
    }

    /// A value of the header's kind field.
    /// 包头中数据类型字段的一个取值。
    FRAME_KIND: FrameKind = "frame kind" "数据类型" {
        /// Its name.
        /// 名称。
        required name: Name, example "command", faults [DuplicateName];
        /// Content of its frames.
        /// 帧的内容。
        required role: KindRole;
        /// Port on which it is sent.
        /// 在哪个端口上发送。
        required port: PortRole, faults [KindPort];
        use TEXT.zh, TEXT.en;
    }

    /// A value of the header's encoding field.
    /// 包头中压缩方式字段的一个取值。
    ENCODING: Encoding = "encoding" "压缩方式" {
        /// Its name.
        /// 名称。
        required name: Name, example "packed", faults [DuplicateName];
        /// Compression of the data.
        /// 数据如何压缩。
        required role: EncodingRole;
        use TEXT.zh, TEXT.en;
    }

    /// Keys of every message, in addition to those of its body; `{}` for none.
    /// 消息体的键之外，每条消息都带的键；没有时写 `{}`。
    ENVELOPE: Envelope = "envelope" "公共字段" {
        /// Envelope of commands and reports. Without a time, no message expires.
        /// 指令和上报的公共字段。没有时间时，任何消息都不会过期。
        required request: Entries<WireKey, EnvelopeField>, faults [DuplicateFieldName];
        /// Envelope of responses and acknowledgements. Without a result code, refused messages get no response.
        /// 响应和应答的公共字段。没有结果码时，被拒绝的消息得不到响应。
        required response: Entries<WireKey, EnvelopeField>, faults [RoleMissing, DuplicateFieldName];
        use COMMON.answers;
    }

    /// A key of the envelope.
    /// 公共字段中的一个键。
    ENVELOPE_FIELD: EnvelopeField = "envelope field" "公共字段的键" {
        /// Its type, followed by `?` if it may be missing in received messages.
        /// 类型；收到的消息里可以没有它时，在后面加 `?`。
        required r#type: Type, example "string?", faults [EnvelopeType];
        /// Its role.
        /// 角色。
        required role: EnvelopeRole, faults [RoleTwice, ResultInRequest];
        use COMMON.name;
        /// Value in generated examples.
        /// 生成的示例中的值。
        required example: Scalar, example "7", faults [ExampleType];
        use TEXT.zh, TEXT.en, COMMON.aliases, COMMON.answers;
    }

    /// A result code. Its Chinese text is also sent as the result text.
    /// 一个结果码。它的中文文本也是随它发送的说明。
    RESULT: ResultCode = "result code" "结果码" {
        /// Name in code.
        /// 代码中的名称。
        required name: Name, example "busy", faults [DuplicateName];
        /// When the runtime returns it automatically.
        /// 运行库在什么情况下自动返回它。
        optional role: ResultRole, faults [RoleTwice];
        use TEXT.zh, TEXT.en, COMMON.about, COMMON.answers;
    }

    /// Waiting times of both sides.
    /// 双方的等待时间。
    CALLS: Calls = "calls" "超时" {
        /// Time an app waits for a response.
        /// app 等待响应的时间。
        required timeout_ms: Milliseconds, example "3000";
        /// Time the robot waits for a handler.
        /// 机器人等待处理程序的时间。
        required handler_timeout_ms: Milliseconds, example "2500";
        /// Age above which a message is refused as expired.
        /// 消息超过这个时间就按过期拒绝。
        required max_age_ms: (Milliseconds, Never), example "60000", faults [AgeWithoutTime];
        use COMMON.answers;
    }

    /// Resending of a report until it is acknowledged.
    /// 上报没有应答时的重发。
    ACK: Ack = "acknowledgement" "应答" {
        /// Wait before it is resent.
        /// 重发前等待的时间。
        required timeout_ms: Milliseconds, example "2000";
        /// Maximum number of resends; 0 sends it only once.
        /// 最多重发几次；0 表示只发送一次。
        required retries: Int<u32>, example "3";
        use COMMON.answers;
    }

    /// Default limits of both sides.
    /// 两端默认的上限。
    LIMITS: Limits = "limits" "上限" {
        /// Maximum frame length, including the header.
        /// 一帧的最大长度，包括包头。
        required frame_bytes: Int<u32, 1>, example "65536", faults [LimitTooSmall];
        /// Maximum length of the data after decompression.
        /// 数据解压后的最大长度。
        required inflated_bytes: Int<u32, 1>, example "1048576", faults [LimitTooSmall];
        /// Maximum nesting depth of a JSON body.
        /// JSON 的最大嵌套层数。
        required json_depth: Int<u32, 1, 127>, example "32", faults [LimitTooSmall];
        /// Calls in flight on one connection.
        /// 一个连接上同时进行的调用数。
        required in_flight: Int<u32, 1>, example "16";
        /// Reports waiting for one app.
        /// 等待发给一个 app 的上报数。
        required queued_reports: Int<u32, 1>, example "64";
        /// Connections at one server.
        /// 一个服务端的连接数。
        required connections: Int<u32, 1>, example "4";
    }

    /// Ranges of codes with a purpose, and codes not to be used again.
    /// 各有用途的号段，以及不得再用的功能码。
    CODES: Codes = "codes" "功能码" {
        /// Ranges with a purpose.
        /// 各有用途的号段。
        required ranges: List<Range>;
        /// Codes that must not be used again.
        /// 不得再用的功能码。
        optional retired: List<Retired>;
        use COMMON.answers;
    }

    /// A range of codes, both ends included.
    /// 一个号段，包括两端。
    RANGE: Range = "range" "号段" {
        /// First code.
        /// 第一个功能码。
        required from: Code, example "0x0A00", faults [RangesOverlap];
        /// Last code.
        /// 最后一个功能码。
        required to: Code, example "0x0AFF", faults [RangeInverted];
        /// Its purpose.
        /// 用途。
        required r#use: RangeUse;
        /// IDs of the groups whose new operations get their codes here. A group that no range names gets codes from the ranges without `groups`.
        /// 哪些分组的新接口从这里取功能码，写分组的 ID。没有号段指明的分组从不写 `groups` 的号段取。
        optional groups: List<Ref<Group>, 1>, example "[status]", faults [UnknownGroup];
        use TEXT.zh, TEXT.en, COMMON.answers;
    }

    /// A code that must not be used again, with the reason.
    /// 一个不得再用的功能码，以及原因。
    RETIRED: Retired = "retired code" "退役的功能码" {
        /// The code.
        /// 功能码。
        required code: Code, faults [DuplicateRetired];
        use TEXT.zh, TEXT.en;
    }

    /// A section whose whole content is missing from the source document.
    /// 源文档中内容全部缺失的一节。
    _: Section = "missing section" "缺失的章节" {
        use TEXT.zh, TEXT.en, COMMON.answers;
    }
}

forms! {
    /// The ports, one key for each [`PortRole`].
    Ports: Kind::Map(&Table {
        name: "ports",
        name_zh: "端口",
        doc: Doc::new("The TCP ports of the robot.", "机器人的 TCP 端口。"),
        example: include_str!("examples/Ports.yaml"),
        keys: &[
            port(PortRole::Command, Doc::new("Commands and reports.", "指令和上报。")),
            port(PortRole::Data, Doc::new("Streams.", "数据流。")),
        ],
    }) => Node<'a>, Some;
    /// `json:`, one key for each [`JsonRule`].
    Json: Kind::Map(&Table {
        name: "JSON rules",
        name_zh: "JSON 规则",
        doc: Doc::new(
            "Rules for JSON that RFC 8259 leaves open. They are the same in every protocol; the texts explain them.",
            "RFC 8259 没有规定的 JSON 读法。各个协议都一样；文本加以说明。",
        ),
        example: include_str!("examples/Json.yaml"),
        keys: &[
            rule(JsonRule::Text),
            rule(JsonRule::KnownKeys),
            rule(JsonRule::UnknownKeys),
            rule(JsonRule::Integers),
            rule(JsonRule::Floats),
            rule(JsonRule::Strings),
        ],
    }) => Node<'a>, Some;
}

const fn port(role: PortRole, doc: Doc) -> AnyKey {
    required(role.name(), Port::KIND, doc)
}

const fn rule(rule: JsonRule) -> AnyKey {
    let (name, en, zh) = rule.entry();
    required(name, BothLanguages::KIND, Doc::new(en, zh))
}

const fn required(name: &'static str, kind: Kind, doc: Doc) -> AnyKey {
    AnyKey {
        name,
        required: true,
        kind,
        doc,
        said: Said::NOTHING,
    }
}
