//! The closed sets of words: what may stand where the spec language knows every value.
//!
//! Each set is declared here and nowhere else. Its word, its meaning and its enum are one entry; the grammar, the
//! JSON Schema, the model, its dump and every product ask it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A member of a closed set, for what does the same with each of them.
pub(crate) trait Word: Copy + PartialEq + 'static {
    /// All of them.
    const SET: &'static [Self];

    /// Its word in the spec.
    fn word(self) -> &'static str;

    /// The one with this word, if there is one.
    fn named(word: &str) -> Option<Self> {
        Self::SET.iter().copied().find(|known| known.word() == word)
    }
}

/// Declares an enum whose variants are words of the spec, each with one sentence that says what it means.
macro_rules! words {
    (
        $(#[$about:meta])+
        pub enum $Set:ident {
            $($(#[doc = $meaning:literal])+ $Word:ident = $word:literal,)+
        }
    ) => {
        $(#[$about])+
        #[allow(clippy::doc_markdown, reason = "the JSON Schema has the same sentences")]
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
        )]
        pub enum $Set {
            $($(#[doc = $meaning])+ #[serde(rename = $word)] $Word,)+
        }

        impl $Set {
            /// All of them, in the order in which they are listed.
            pub const ALL: &'static [Self] = &[$(Self::$Word,)+];

            /// The words and what they mean.
            pub const WORDS: &'static [(&'static str, &'static str)] = &[$(Self::$Word.entry(),)+];

            /// Its word in the spec, and in all that is made from it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                self.entry().0
            }

            /// What it means.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                self.entry().1
            }

            /// Its word and what it means.
            #[must_use]
            pub const fn entry(self) -> (&'static str, &'static str) {
                match self {
                    $(Self::$Word => ($word, concat!($($meaning,)+).trim_ascii_start()),)+
                }
            }

        }

        impl Word for $Set {
            const SET: &'static [Self] = Self::ALL;

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
        Big = "big",
        /// Least significant byte first.
        Little = "little",
    }
}

words! {
    /// What the engine uses a header field for. A checked model has each role but `Status` exactly once, the head
    /// first, with the width that the role asks for.
    pub enum HeaderRole {
        /// The bytes that open a frame.
        Head = "head",
        /// One of `kinds`; u8.
        Kind = "kind",
        /// The code of the operation; u16.
        Code = "code",
        /// Ties a response to its request; u32.
        Id = "id",
        /// One of `encodings`; u8.
        Encoding = "encoding",
        /// Sent as `value`, kept as received, never interpreted.
        Status = "status",
        /// Header and data as sent, in bytes; u32.
        TotalLength = "total_length",
        /// Data before compression, in bytes; u32.
        PlainLength = "plain_length",
        /// MD5 over the data as sent; bytes(16).
        Digest = "digest",
    }
}

words! {
    /// Where the decoder of a header is lenient.
    pub enum HeaderQuirk {
        /// A received 0 on an uncompressed frame is accepted.
        ZeroWhenPlain = "zero_when_plain",
    }
}

words! {
    /// What a port carries; also its key in `transport.ports` and the value of an operation's port.
    pub enum PortRole {
        /// The port of commands and reports.
        Command = "command",
        /// The port of streams.
        Data = "data",
    }
}

words! {
    /// What a frame of some kind carries, as JSON but for a stream.
    pub enum KindRole {
        /// Raw bytes.
        Stream = "stream",
        /// A command or its answer.
        Command = "command",
        /// A report or its acknowledgement.
        Report = "report",
        /// Refused by name.
        Reserved = "reserved",
    }
}

words! {
    /// How the data of a frame is packed.
    pub enum EncodingRole {
        /// As it is.
        Plain = "plain",
        /// One gzip member (RFC 1952).
        Gzip = "gzip",
    }
}

words! {
    /// What the engine uses an envelope key for.
    pub enum EnvelopeRole {
        /// When the message was made; timestamp_ms.
        Time = "time",
        /// One of `results`; responses only.
        ResultCode = "result_code",
        /// Text beside the result code; responses only.
        ResultText = "result_text",
    }
}

words! {
    /// When the engine itself answers with a result code. A checked model has each role exactly once.
    pub enum ResultRole {
        /// All went well.
        Success = "success",
        /// Unknown command, reserved kind or bad digest.
        Protocol = "protocol",
        /// No answer from the handler in time.
        Timeout = "timeout",
        /// A body that does not parse or violates a constraint.
        Invalid = "invalid",
        /// A message older than the configured age.
        Expired = "expired",
    }
}

words! {
    /// A place where RFC 8259 leaves open what a JSON text means. What is done there is fixed, the same in
    /// every protocol and language; the vectors have it as examples, and `json:` of the spec says it in words.
    pub enum JsonRule {
        /// What a body is: UTF-8, one object, nothing around it.
        Text = "text",
        /// A known key that comes twice is refused.
        KnownKeys = "known_keys",
        /// Unknown keys are passed on unchanged.
        UnknownKeys = "unknown_keys",
        /// A number that is integral is an integer, however it is written.
        Integers = "integers",
        /// A float is the nearest to the number; one beyond its type is refused.
        Floats = "floats",
        /// Half of a surrogate pair is no text.
        Strings = "strings",
    }
}

words! {
    /// Purpose of a range of codes.
    pub enum RangeUse {
        /// Handed to the upper body as it comes.
        PassThrough = "pass_through",
        /// New commands count up here.
        Commands = "commands",
        /// New reports count up here.
        Reports = "reports",
        /// Not to be given out.
        Reserved = "reserved",
        /// Given out in the past, closed for new operations.
        Historic = "historic",
    }
}

words! {
    /// What an operation is.
    pub enum Kind {
        /// The app asks, the robot answers.
        Command = "command",
        /// The robot sends it by itself, the app acknowledges.
        Report = "report",
        /// Raw bytes on the data port.
        Stream = "stream",
    }
}

words! {
    /// Who sends.
    pub enum Side {
        /// The robot sends it.
        Robot = "robot",
        /// The app sends it.
        App = "app",
    }
}

words! {
    /// Which way a message goes.
    pub enum Direction {
        /// What a command asks, what a report says, what a stream carries.
        Request = "request",
        /// The answer to a command, the acknowledgement of a report.
        Response = "response",
    }
}

words! {
    /// What a command does to the robot.
    pub enum Effect {
        /// Nothing changes; it may be repeated at will.
        Read = "read",
        /// Changes what the robot remembers.
        Config = "config",
        /// Moves the robot.
        Motion = "motion",
        /// Nothing says what it does; it counts as one that moves the robot.
        Unknown = "unknown",
    }
}

words! {
    /// How sure a fact is, the surest first.
    pub enum BodyState {
        /// The source says it.
        Stated = "stated",
        /// The source gives the evidence.
        Inferred = "inferred",
        /// Lost; for a code: not assigned; for an effect: unknown.
        Open = "open",
    }
}

words! {
    /// What of an operation is lost in the source.
    pub enum Lost {
        /// The heading.
        Title = "title",
        /// The type byte; it is inferred from the other operations of the kind.
        Type = "type",
        /// The code.
        Code = "code",
        /// The request.
        Request = "request",
        /// The response.
        Response = "response",
    }
}

words! {
    /// Integers, named as in Rust.
    pub enum IntKind {
        /// 8 bits, signed.
        I8 = "i8",
        /// 16 bits, signed.
        I16 = "i16",
        /// 32 bits, signed.
        I32 = "i32",
        /// 64 bits, signed.
        I64 = "i64",
        /// 8 bits, unsigned.
        U8 = "u8",
        /// 16 bits, unsigned.
        U16 = "u16",
        /// 32 bits, unsigned.
        U32 = "u32",
        /// 64 bits, unsigned.
        U64 = "u64",
    }
}

impl IntKind {
    /// Smallest and largest value.
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
        F32 = "f32",
        /// 64 bits (IEEE 754).
        F64 = "f64",
    }
}

words! {
    /// How a value is sent. A spec says it only where it differs from the type.
    pub enum WireForm {
        /// As its type says.
        Plain = "plain",
        /// A number or bool inside a JSON string.
        String = "string",
    }
}

words! {
    /// Where a decoder is lenient. The encoder is not: it sends the canonical form.
    pub enum Quirk {
        /// null, {}, [] and "" are read as an absent optional field.
        EmptyIsAbsent = "empty_is_absent",
        /// A number is also read from a string, decimal or 0x.
        LenientNumber = "lenient_number",
        /// A bool is also read from "true"/"false" and 0/1.
        LenientBool = "lenient_bool",
    }
}

words! {
    /// How a gap of the source is answered.
    pub enum AnswerKind {
        /// Decided here until the protocol owner says otherwise.
        Decision = "decision",
        /// Messages are irregular here and stay so; the decoder is lenient in this place.
        Quirk = "quirk",
        /// Nothing to decide; said so that nobody wonders.
        Note = "note",
        /// Nobody knows yet.
        Question = "question",
    }
}

words! {
    /// How much depends on a gap.
    pub enum Severity {
        /// Until it is settled, peers disagree about bytes or meaning.
        High = "high",
        /// A careful reader can get it wrong.
        Medium = "medium",
        /// A slip of the pen.
        Low = "low",
    }
}
