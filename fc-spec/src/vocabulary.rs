//! The closed sets of words in the spec language.
//!
//! Each set is declared only here. One entry holds a word, its meaning and its enum variant. The grammar, the JSON Schema, the model, its
//! dump and every product use this entry.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A word of a closed set and its meaning, in English and in Chinese.
pub type Meaning = (&'static str, &'static str, &'static str);

/// A word of any closed set, for code that handles all sets alike.
pub(crate) trait Word: Copy + PartialEq + 'static {
    /// All variants.
    const SET: &'static [Self];
    /// The words and their meanings.
    const WORDS: &'static [Meaning];

    /// Returns the word in the spec.
    fn word(self) -> &'static str;

    /// Returns the variant for a word, if there is one.
    fn named(word: &str) -> Option<Self> {
        Self::SET.iter().copied().find(|known| known.word() == word)
    }
}

/// Declares an enum whose variants are words of the spec. The first line of a variant's doc is its meaning in English, the second its
/// meaning in Chinese.
macro_rules! words {
    (
        $(#[$about:meta])+
        pub enum $Set:ident {
            $(#[doc = $en:literal] #[doc = $zh:literal] $Word:ident = $word:literal,)+
        }
    ) => {
        $(#[$about])+
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
        )]
        pub enum $Set {
            $(#[doc = $en] #[serde(rename = $word)] $Word,)+
        }

        impl $Set {
            /// All variants, in the order of their declaration.
            pub const ALL: &'static [Self] = &[$(Self::$Word,)+];

            /// The words and their meanings.
            pub const WORDS: &'static [Meaning] = &[$(Self::$Word.entry(),)+];

            /// Returns the word in the spec and in all products.
            #[must_use]
            pub const fn name(self) -> &'static str {
                self.entry().0
            }

            /// Returns the word and its meaning.
            #[must_use]
            pub const fn entry(self) -> Meaning {
                match self {
                    $(Self::$Word => ($word, $en.trim_ascii(), $zh.trim_ascii()),)+
                }
            }
        }

        impl Word for $Set {
            const SET: &'static [Self] = Self::ALL;
            const WORDS: &'static [Meaning] = Self::WORDS;

            fn word(self) -> &'static str {
                self.name()
            }
        }
    };
}

words! {
    /// Order of the bytes of an integer.
    pub enum ByteOrder {
        /// Most significant byte first.
        /// 高位字节在前。
        Big = "big",
        /// Least significant byte first.
        /// 低位字节在前。
        Little = "little",
    }
}

words! {
    /// Role of a header field. A checked model has each role at most once, the head first.
    /// Each field has the width that its role requires. The status and the digest are optional.
    /// The roles that only compressed data needs are optional as well.
    pub enum HeaderRole {
        /// First bytes of a frame.
        /// 一帧开头的字节。
        Head = "head",
        /// One of `kinds`; u8.
        /// `kinds` 之一；u8。
        Kind = "kind",
        /// The code of the operation; u16.
        /// 接口的功能码；u16。
        Code = "code",
        /// Ties a response to its request; u16 or u32.
        /// 把响应和请求对应起来；u16 或 u32。
        Id = "id",
        /// One of `encodings`; u8. Without it, data is never compressed.
        /// `encodings` 之一；u8。没有它就不压缩。
        Encoding = "encoding",
        /// Sent as `value`, kept as received, not interpreted.
        /// 按 `value` 发送，接收时原样保留，不作解释。
        Status = "status",
        /// Header and data as sent, in bytes; u32.
        /// 包头加发送的数据，单位字节；u32。
        TotalLength = "total_length",
        /// Data before compression, in bytes; u32. Compressed data needs it.
        /// 压缩前的数据，单位字节；u32。压缩的数据需要它。
        PlainLength = "plain_length",
        /// Digest of the data as sent, by `algorithm`. Without it, frames have no digest.
        /// 按实际发送的数据计算的摘要，算法见 `algorithm`。没有它就不计算摘要。
        Digest = "digest",
    }
}

words! {
    /// Digest algorithm of the data of a frame, with the type of the header field that holds the digest.
    pub enum DigestAlgorithm {
        /// MD5 (RFC 1321); bytes(16).
        /// MD5（RFC 1321）；bytes(16)。
        Md5 = "md5",
        /// CRC-32 as in gzip and zlib (ISO-HDLC); u32.
        /// CRC-32，与 gzip、zlib 相同（ISO-HDLC）；u32。
        Crc32 = "crc32",
    }
}

impl DigestAlgorithm {
    /// Returns the name of the algorithm, the same in every language.
    #[must_use]
    pub const fn term(self) -> &'static str {
        match self {
            Self::Md5 => "MD5",
            Self::Crc32 => "CRC-32",
        }
    }

    /// Returns the type of a header field for the digest, as the spec writes it.
    #[must_use]
    pub const fn field_type(self) -> &'static str {
        match self {
            Self::Md5 => "bytes(16)",
            Self::Crc32 => "u32",
        }
    }
}

words! {
    /// Leniency of the decoder of a header.
    pub enum HeaderQuirk {
        /// A received 0 on an uncompressed frame is accepted.
        /// 不压缩的帧填 0 也接受。
        ZeroWhenPlain = "zero_when_plain",
    }
}

words! {
    /// Role of a port. It is the key of the port in `transport.ports` and the value of an operation's port.
    pub enum PortRole {
        /// The port of commands and reports.
        /// 指令和上报的端口。
        Command = "command",
        /// The port of streams.
        /// 数据流的端口。
        Data = "data",
    }
}

words! {
    /// Content of the frames of a kind. Commands and reports are JSON.
    pub enum KindRole {
        /// Raw bytes.
        /// 原始字节。
        Stream = "stream",
        /// A command or its response.
        /// 指令或它的响应。
        Command = "command",
        /// A report or its acknowledgement.
        /// 上报或它的应答。
        Report = "report",
        /// Reserved; always refused.
        /// 预留，收到即拒绝。
        Reserved = "reserved",
    }
}

words! {
    /// Compression of the data of a frame.
    pub enum EncodingRole {
        /// Uncompressed.
        /// 不压缩。
        Plain = "plain",
        /// One gzip member (RFC 1952).
        /// 一个 gzip 成员（RFC 1952）。
        Gzip = "gzip",
    }
}

words! {
    /// Role of an envelope key.
    pub enum EnvelopeRole {
        /// Time of creation of the message; timestamp_ms.
        /// 消息生成的时间；timestamp_ms。
        Time = "time",
        /// One of `results`; responses only.
        /// `results` 之一；只用于响应。
        ResultCode = "result_code",
        /// Text of the result code; responses only.
        /// 结果码的说明文字；只用于响应。
        ResultText = "result_text",
    }
}

words! {
    /// Case in which the runtime returns a result code automatically. A checked model has each role exactly once.
    pub enum ResultRole {
        /// Success.
        /// 成功。
        Success = "success",
        /// Unknown command, reserved kind or bad digest.
        /// 未知的指令、预留的数据类型或摘要错误。
        Protocol = "protocol",
        /// No response from the handler in time.
        /// 处理程序没有按时响应。
        Timeout = "timeout",
        /// A body that does not parse or violates a constraint.
        /// 消息体无法解析，或不符合约束。
        Invalid = "invalid",
        /// A message older than the configured age.
        /// 消息超过了设定的有效期。
        Expired = "expired",
    }
}

words! {
    /// Meaning of the `then` lists of an enum's values.
    pub enum StateOrder {
        /// The normal order of the values. Other changes may occur as well.
        /// 取值的正常顺序；也可能出现其他切换。
        Normal = "normal",
        /// All changes: no other change occurs.
        /// 全部的切换：不会出现其他切换。
        Complete = "complete",
    }
}

words! {
    /// A point of JSON that RFC 8259 leaves open. Its handling is the same in every protocol and language.
    /// The vectors contain examples of it, and `json:` of the spec describes it.
    pub enum JsonRule {
        /// A body is UTF-8 and one object, with nothing around it.
        /// 消息体是 UTF-8，一个对象，前后没有别的内容。
        Text = "text",
        /// A known key that comes twice is refused.
        /// 已知的键出现两次时拒绝。
        KnownKeys = "known_keys",
        /// Unknown keys are passed on unchanged.
        /// 未知的键原样转交。
        UnknownKeys = "unknown_keys",
        /// A number that is integral is an integer, however it is written.
        /// 数值为整数的就是整数，不论怎么书写。
        Integers = "integers",
        /// A float is the nearest to the number; one beyond its type is refused.
        /// 浮点数取最接近的值；超出类型范围的拒绝。
        Floats = "floats",
        /// Half of a surrogate pair is no text.
        /// 半个代理对不是文本。
        Strings = "strings",
    }
}

words! {
    /// Purpose of a range of codes.
    pub enum RangeUse {
        /// Passed through to the upper body unchanged.
        /// 原样透传给上装。
        PassThrough = "pass_through",
        /// New commands take their codes here.
        /// 新的指令从这里依次取号。
        Commands = "commands",
        /// New reports take their codes here.
        /// 新的上报从这里依次取号。
        Reports = "reports",
        /// Not to be assigned.
        /// 不得分配。
        Reserved = "reserved",
        /// Assigned in the past, closed for new operations.
        /// 过去分配的，不再用于新的接口。
        Historic = "historic",
    }
}

words! {
    /// Kind of an operation.
    pub enum Kind {
        /// The app sends a request, the robot sends a response.
        /// app 请求，机器人响应。
        Command = "command",
        /// The robot sends it without a request, the app acknowledges it.
        /// 机器人主动发送，app 应答。
        Report = "report",
        /// Raw bytes on the data port.
        /// 数据端口上的原始字节。
        Stream = "stream",
    }
}

impl Kind {
    /// Returns the role of its frames.
    #[must_use]
    pub fn role(self) -> KindRole {
        match self {
            Self::Command => KindRole::Command,
            Self::Report => KindRole::Report,
            Self::Stream => KindRole::Stream,
        }
    }
}

words! {
    /// Party that sends.
    pub enum Side {
        /// The robot sends it.
        /// 由机器人发送。
        Robot = "robot",
        /// The app sends it.
        /// 由 app 发送。
        App = "app",
    }
}

words! {
    /// Direction of a message.
    pub enum Direction {
        /// The request of a command, a report, or the data of a stream.
        /// 指令的请求、上报的内容、数据流的内容。
        Request = "request",
        /// The response to a command, or the acknowledgement of a report.
        /// 指令的响应、上报的应答。
        Response = "response",
    }
}

words! {
    /// Effect of a command on the robot.
    pub enum Effect {
        /// Changes nothing; it is safe to resend.
        /// 不改变任何东西，可以放心重发。
        Read = "read",
        /// Changes the configuration that the robot stores.
        /// 改变机器人保存的内容。
        Config = "config",
        /// Moves the robot.
        /// 机器人会动。
        Motion = "motion",
        /// Unknown; treated like a command that moves the robot.
        /// 未知，按会让机器人运动的指令处理。
        Unknown = "unknown",
    }
}

words! {
    /// Confidence in a fact, the highest first.
    pub enum BodyState {
        /// A body that may have any keys, by design.
        /// 有意不限定键的消息体。
        Free = "free",
        /// Stated in the source.
        /// 源文档写明了。
        Stated = "stated",
        /// Confirmed by the protocol owner.
        /// 协议负责人已确认。
        Confirmed = "confirmed",
        /// Inferred from evidence in the source.
        /// 由源文档中的依据推断。
        Inferred = "inferred",
        /// Lost; for a code: not assigned; for an effect: unknown.
        /// 缺失；功能码：未分配；影响：未知。
        Open = "open",
    }
}

words! {
    /// A fact about an operation that the source states or has lost.
    pub enum Fact {
        /// The heading.
        /// 标题。
        Title = "title",
        /// The type byte.
        /// 数据类型。
        Type = "type",
        /// The code.
        /// 功能码。
        Code = "code",
        /// Its effect on the robot.
        /// 对机器人的影响。
        Effect = "effect",
        /// The request.
        /// 请求。
        Request = "request",
        /// The response.
        /// 响应。
        Response = "response",
    }
}

words! {
    /// Integers, named as in Rust.
    pub enum IntKind {
        /// 8 bits, signed.
        /// 8 位，有符号。
        I8 = "i8",
        /// 16 bits, signed.
        /// 16 位，有符号。
        I16 = "i16",
        /// 32 bits, signed.
        /// 32 位，有符号。
        I32 = "i32",
        /// 64 bits, signed.
        /// 64 位，有符号。
        I64 = "i64",
        /// 8 bits, unsigned.
        /// 8 位，无符号。
        U8 = "u8",
        /// 16 bits, unsigned.
        /// 16 位，无符号。
        U16 = "u16",
        /// 32 bits, unsigned.
        /// 32 位，无符号。
        U32 = "u32",
        /// 64 bits, unsigned.
        /// 64 位，无符号。
        U64 = "u64",
    }
}

impl IntKind {
    /// Returns the smallest and the largest value.
    #[must_use]
    pub fn range(self) -> (i128, i128) {
        match self {
            Self::I8 => (i8::MIN.into(), i8::MAX.into()),
            Self::I16 => (i16::MIN.into(), i16::MAX.into()),
            Self::I32 => (i32::MIN.into(), i32::MAX.into()),
            Self::I64 => (i64::MIN.into(), i64::MAX.into()),
            Self::U8 => (0, u8::MAX.into()),
            Self::U16 => (0, u16::MAX.into()),
            Self::U32 => (0, u32::MAX.into()),
            Self::U64 => (0, u64::MAX.into()),
        }
    }
}

words! {
    /// Floating-point numbers, named as in Rust.
    pub enum FloatKind {
        /// 32 bits (IEEE 754).
        /// 32 位（IEEE 754）。
        F32 = "f32",
        /// 64 bits (IEEE 754).
        /// 64 位（IEEE 754）。
        F64 = "f64",
    }
}

words! {
    /// Form in which a value is sent. A spec gives it only if it differs from the type.
    pub enum WireForm {
        /// According to its type.
        /// 与类型一致。
        Plain = "plain",
        /// A number or bool inside a JSON string.
        /// 数值或布尔值写在 JSON 字符串里。
        String = "string",
        /// A bool as a number: 1 is true, 0 is false. 1.0 and 1e0 are also read as 1; any other number is refused.
        /// 布尔值写成数字：1 表示 true，0 表示 false。接收时，1.0 和 1e0 也算 1；其他数字一律拒绝。
        Number = "number",
    }
}

words! {
    /// Leniency of a decoder. The encoder always sends the canonical form.
    pub enum Quirk {
        /// null, {}, [] and "" are read as an absent optional field.
        /// null、{}、[] 和 "" 都当作没有这个可选字段。
        EmptyIsAbsent = "empty_is_absent",
        /// A number is also read from a string, decimal or 0x.
        /// 数值也可以写成字符串，十进制或 0x。
        LenientNumber = "lenient_number",
        /// A bool is also read from "true"/"false" and 0/1.
        /// 布尔值也可以写成 "true"/"false" 和 0/1。
        LenientBool = "lenient_bool",
    }
}

words! {
    /// Kind of an answer to a gap of the source.
    pub enum AnswerKind {
        /// Decided here until the protocol owner says otherwise.
        /// 在协议负责人另行说明之前按此执行。
        Decision = "decision",
        /// Messages are irregular here and stay so; only here is the decoder lenient.
        /// 报文在这里不规则，并保持不变；只在这一处放宽解析。
        Quirk = "quirk",
        /// No decision needed; recorded to avoid misunderstanding.
        /// 无需决定，写明以免误解。
        Note = "note",
        /// No answer yet.
        /// 尚无答案。
        Question = "question",
    }
}

words! {
    /// Impact of an open question, the most urgent first.
    /// Each description gives the behaviour of the tools until the question is settled.
    pub enum Impact {
        /// Without a code it cannot be sent. Types and documentation are generated, dispatch is not.
        /// 没有功能码就不能发送：照常生成类型和文档，但不参与分发。
        NoCode = "no_code",
        /// The keys of the body are unknown; receivers keep every key.
        /// 不知道正文有哪些键；收到的键都原样保留。
        NoBody = "no_body",
        /// It is treated like a command that moves the robot.
        /// 按会让机器人运动的指令处理。
        NoEffect = "no_effect",
        /// Values follow the present spec and may be misread.
        /// 数值按规范现在的写法处理，可能被误读。
        Doubtful = "doubtful",
        /// The inference is used and marked as such.
        /// 按推断使用，并注明是推断。
        Inferred = "inferred",
        /// Generated code does not depend on it, but robot and app may behave unexpectedly.
        /// 生成的内容与它无关，但机器人和 app 的行为可能与预期不同。
        Behaviour = "behaviour",
        /// The decision of the spec applies.
        /// 按规范的决定执行。
        Decided = "decided",
    }
}

words! {
    /// Severity of a gap in the source, the highest first.
    pub enum Severity {
        /// Until it is settled, peers disagree about bytes or meaning.
        /// 定下来之前，双方对字节或含义的理解不一致。
        High = "high",
        /// A careful reader can get it wrong.
        /// 仔细看也可能弄错。
        Medium = "medium",
        /// A slip of the pen.
        /// 笔误。
        Low = "low",
    }
}
