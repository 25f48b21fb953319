//! The words of frames, envelopes and JSON.

use super::{Meaning, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
