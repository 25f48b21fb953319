//! Groups and operations.

use super::common::{COMMON, Deprecated, TEXT};
use super::form::{
    Body, Code, Entries, FactState, Int, KnownEffect, List, Name, ResultNumber, SourceFact, State,
    Str, Unassigned,
};
use super::key::Key;
use super::wire::Ack;
use crate::vocabulary::{Effect, Side};

/// The key of a body.
pub(crate) type BodyKey = Key<Body>;
/// The key of how sure a body is.
pub(crate) type StateKey = Key<(State, BodyState)>;

grammar! {
    /// A group of operations that belong together.
    /// 一组相关的接口。
    GROUP: Group = "group" "分组" {
        /// Short name; the name of the Rust module.
        /// 短名，也是 Rust 模块的名称。
        required id: Name;
        use TEXT.zh, TEXT.en, COMMON.about;
    }

    /// Keys of operations of several kinds.
    /// 几种接口都有的键。
    OPERATION: Operation = "operation" "接口" {
        /// Code in the frame header, such as `0x0A01`; `unassigned` until there is one.
        /// 包头里的功能码，例如 `0x0A01`；还没有时写 `unassigned`。
        required code: (Code, Unassigned, InferredCode);
        /// Where it comes from in the source document.
        /// 出自源文档的哪里。
        required source: Source;
        /// Result text that the source prints with it; composed examples show it.
        /// 源文档中随它印出的结果说明；生成的示例会显示。
        optional result_text: Str;
        /// Confidence in the request; `stated` by default.
        /// 请求有多可靠；不写时为 `stated`。
        optional request_state: (State, BodyState);
        /// Confidence in the response; `stated` by default.
        /// 响应有多可靠；不写时为 `stated`。
        optional response_state: (State, BodyState);
        /// Result codes it may return besides success; with what one means here, where that is known.
        /// 除成功以外可能返回的结果码；知道在这里是什么意思时一并写明。
        optional errors: List<(ResultNumber, DeclaredError)>;
        /// Withdrawn.
        /// 已停用。
        optional deprecated: Deprecated;
    }

    /// A command: the app asks, the robot answers.
    /// 指令：app 请求，机器人响应。
    COMMAND: Command = "command" "指令" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about;
        /// What it does to the robot. Evidence is a title or description that says so (get, set, delete, start), or, as inferred, a body that only asks or only sets. A code, a neighbouring operation or the type of a field is not evidence.
        /// 对机器人的影响。标题或说明写明了（获取、设置、删除、开始）才算依据；消息体只查询或只设置的，按推断处理。功能码、相邻的接口和字段的类型都不算依据。
        required effect: (Effect, InferredEffect);
        /// Reports that the robot sends because of it, beside the response: those of which the source says so. Each by its name, or with the keys that tie it to the command.
        /// 除响应以外，它会引起哪些主动上报；只列源文档写明的。写名称；上报与指令有字段相对应时，连同字段一起写。
        optional sets_off: List<(Name, SetOff), 1>;
        use COMMON.since, OPERATION.source, OPERATION.result_text, OPERATION.request_state, OPERATION.response_state;
        /// Keys of the request besides the envelope, in the order sent.
        /// 请求中公共字段以外的键，按发送的顺序书写。
        optional request: Body;
        /// Keys of the response besides the envelope, in the order sent.
        /// 响应中公共字段以外的键，按发送的顺序书写。
        optional response: Body;
        use OPERATION.errors, OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A report that a command sets off, and the keys by which it belongs to that command.
    /// 由指令引起的上报，以及靠哪些字段对应。
    SET_OFF: SetOff = "report set off" "引起的上报" {
        /// Name of the report.
        /// 上报的名称。
        required report: Name;
        /// Keys of the command, each with the key of the report that has the same value, such as `response.data.taskId: data.taskId`; an integer or a string, of the same type.
        /// 指令的字段与上报中取值相同的字段，例如 `response.data.taskId: data.taskId`；为整数或字符串，类型相同。
        required tied: Entries<Str, Str, 1>;
    }

    /// A report: the robot sends it by itself, the app acknowledges.
    /// 主动上报：机器人主动发送，app 应答。
    REPORT: Report = "report" "上报" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about, COMMON.since, OPERATION.source,
            OPERATION.result_text, OPERATION.request_state, OPERATION.response_state;
        /// Keys of the report besides the envelope, in the order sent.
        /// 上报中公共字段以外的键，按发送的顺序书写。
        optional body: Body;
        /// The key that says how far a process has come, such as `data.status`; needed only where several have states.
        /// 哪个字段表示过程进行到哪一步，例如 `data.status`；只有一个字段有状态时不必写。
        optional state_in: Str;
        /// Keys of the acknowledgement besides the envelope, in the order sent.
        /// 应答中公共字段以外的键，按发送的顺序书写。
        optional response: Body;
        /// How often it is resent until it is acknowledged.
        /// 没有应答时重发几次。
        optional ack: Ack;
        use OPERATION.errors, OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A stream of raw bytes on the data port.
    /// 数据端口上的原始字节流。
    STREAM: Stream = "stream" "数据流" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about;
        /// Who sends it.
        /// 由谁发送。
        required from: Side;
        use COMMON.since, OPERATION.source, OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A code and its confidence.
    /// 功能码及其可靠程度。
    CODE: InferredCode = "inferred code" "推断的功能码" {
        /// The code.
        /// 功能码。
        required value: Code;
        /// Its confidence.
        /// 有多可靠。
        required state: FactState;
    }

    /// An effect and its confidence.
    /// 影响及其可靠程度。
    EFFECT: InferredEffect = "inferred effect" "推断的影响" {
        /// What it does to the robot.
        /// 对机器人的影响。
        required value: KnownEffect;
        use CODE.state;
    }

    /// The confidence of a body, and the reason.
    /// 消息体有多可靠，以及理由。
    BODY_STATE: BodyState = "body state" "消息体的可靠程度" {
        /// Its confidence.
        /// 有多可靠。
        required state: State;
        use TEXT.zh, TEXT.en;
    }

    /// A result code and what it means for this very operation.
    /// 结果码，以及它对这个接口是什么意思。
    ERROR: DeclaredError = "error" "错误" {
        /// The result code.
        /// 结果码。
        required code: ResultNumber;
        use TEXT.zh, TEXT.en;
    }

    /// Where in the source document it stands, and what of that is lost.
    /// 在源文档的哪里，其中缺了什么。
    SOURCE: Source = "source" "出处" {
        /// Section numbers; empty if it is not in the source document.
        /// 节号；源文档中没有时留空。
        required sections: List<Int<u16, 1>>;
        /// What is missing from the section.
        /// 这一节缺了什么。
        optional lost: List<SourceFact>;
    }
}
