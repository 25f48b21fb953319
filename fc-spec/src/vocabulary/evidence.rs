//! The words for the confidence in facts, and for open questions.

use super::{Meaning, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
