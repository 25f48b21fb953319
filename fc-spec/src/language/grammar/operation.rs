//! Groups and operations.

use super::common::{BothLanguages, COMMON, Deprecated, TEXT};
use super::field::Enum;
use super::form::{
    AnyState, Body, Code, Entries, FactState, Int, KnownEffect, List, MediaType, Name, Number,
    Scalar, SourceFact, State, Str, Unassigned,
};
use super::key::Key;
use super::refers::Ref;
use super::wire::{Ack, ResultCode};
use crate::model;
use crate::vocabulary::{Effect, Side};

/// The key of a body.
pub(crate) type BodyKey = Key<Body>;
/// The key of the state of a body.
pub(crate) type StateKey = Key<(State, BodyState)>;

/// The state of a body or a fact without a written state.
pub(crate) const STATED: model::BodyState = model::BodyState::Stated;

grammar! {
    /// A group of related operations.
    /// 一组相关的接口。
    GROUP: Group = "group" "分组" {
        /// Short name; the name of the Rust module.
        /// 短名，也是 Rust 模块的名称。
        required id: Name, example "navigation", faults [DuplicateGroup, ReservedName];
        use TEXT.zh, TEXT.en, COMMON.about;
    }

    /// Keys of operations of several kinds.
    /// 几种接口都有的键。
    OPERATION: Operation = "operation" "接口" {
        /// Code in the frame header, such as `0x0A01`, or `unassigned`.
        /// 包头里的功能码，例如 `0x0A01`；还没有时写 `unassigned`。
        required code: (Code, Unassigned, InferredCode),
            faults [DuplicateCode, RetiredCode, CodeOutsideRanges, CodeInWrongRange];
        /// Its sections in the source document.
        /// 在源文档中的出处。
        required source: Source;
        /// Result text in the source document; generated examples show it.
        /// 源文档中的结果说明；生成的示例会显示。
        optional result_text: Str, example "操作成功";
        /// Confidence in the request.
        /// 请求的可靠程度。
        optional request_state: (State, BodyState), default STATED.name();
        /// Confidence in the response.
        /// 响应的可靠程度。
        optional response_state: (State, BodyState), default STATED.name();
        /// Result codes it may return besides success, each with its meaning for this operation if known.
        /// 除成功以外可能返回的结果码；知道对这个接口的含义时一并写明。
        optional errors: List<(Ref<ResultCode>, DeclaredError)>, example "[2, 3]", faults [UnknownResult, SuccessAsError];
        /// Deprecated.
        /// 已弃用。
        optional deprecated: Deprecated;
    }

    /// A command: the app sends a request, the robot sends a response.
    /// 指令：app 请求，机器人响应。
    COMMAND: Command = "command" "指令" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about;
        /// Its effect on the robot. Evidence is a title or description with a verb such as get, set, delete or start. A body that only reads or only sets is evidence for `inferred`. A code, a neighbouring operation or the type of a field is no evidence.
        /// 对机器人的影响。标题或说明写明了（获取、设置、删除、开始）才算依据；消息体只查询或只设置的，按推断处理。功能码、相邻的接口和字段的类型都不算依据。
        required effect: (Effect, InferredEffect);
        /// Reports that the robot sends because of it, according to the source. Each is a name, or a name with the keys that tie the report to the command.
        /// 除响应以外，它会引起哪些主动上报；只列源文档写明的。写名称；上报与指令有字段相对应时，连同字段一起写。
        optional sets_off: List<(Ref<Report>, SetOff), 1>,
            example "[task_finished]",
            faults [UnknownOperation, NotAReport, DuplicateItem];
        /// Its preconditions, according to the source.
        /// 机器人受理它的条件；只写源文档写明的。
        optional accepted: Precondition, faults [NoPrecondition];
        use COMMON.kept, COMMON.since, COMMON.available, OPERATION.source, OPERATION.result_text, OPERATION.errors, OPERATION.request_state;
        /// Keys of the request without the envelope, in the order sent.
        /// 请求中公共字段以外的键，按发送的顺序书写。
        optional request: Body, faults [EnvelopeKey, BodyTooLarge, OpenBodyFields];
        use OPERATION.response_state;
        /// Keys of the response without the envelope, in the order sent.
        /// 响应中公共字段以外的键，按发送的顺序书写。
        optional response: Body, faults [EnvelopeKey, BodyTooLarge, OpenBodyFields];
        use OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A report that a command sets off, and the keys that tie it to the command.
    /// 由指令引起的上报，以及与指令对应的字段。
    SET_OFF: SetOff = "report set off" "引起的上报" {
        /// Name of the report.
        /// 上报的名称。
        required report: Ref<Report>, example "task_finished", faults [UnknownOperation, NotAReport, DuplicateItem];
        /// Keys of the command, each with the key of the report that has the same value, such as `response.data.taskId: data.taskId`. Both are integers or both strings, of the same type.
        /// 指令的字段与上报中取值相同的字段，例如 `response.data.taskId: data.taskId`。两者同为整数或同为字符串，类型相同。
        required tied: Entries<Str, Str, 1>,
            example "{ response.data.taskId: data.taskId }",
            faults [UnknownBodyKey, TieType];
    }

    /// A report: the robot sends it without a request, the app acknowledges it.
    /// 主动上报：机器人主动发送，app 应答。
    REPORT: Report = "report" "上报" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about, COMMON.kept, COMMON.since, COMMON.available, OPERATION.source,
            OPERATION.result_text, OPERATION.errors;
        /// When the robot sends it, according to the source.
        /// 机器人在什么时候上报；只写源文档写明的。
        optional cadence: ReportCadence, faults [CadenceRules];
        /// Resending until it is acknowledged.
        /// 没有应答时的重发。
        optional ack: Ack;
        use OPERATION.request_state;
        /// Keys of the report without the envelope, in the order sent.
        /// 上报中公共字段以外的键，按发送的顺序书写。
        optional body: Body, faults [EnvelopeKey, BodyTooLarge, OpenBodyFields];
        /// Key with the state of the process, such as `data.status`; needed only if several keys have states.
        /// 表示过程状态的字段，例如 `data.status`；只有一个字段有状态时不必写。
        optional state_in: Str, example "data.status", faults [UnknownBodyKey, NotAState];
        use OPERATION.response_state;
        /// Keys of the acknowledgement without the envelope, in the order sent.
        /// 应答中公共字段以外的键，按发送的顺序书写。
        optional response: Body, faults [EnvelopeKey, BodyTooLarge, OpenBodyFields];
        use OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A stream: frames that one side sends on the data port, without a response.
    /// 数据流：一方在数据端口上连续发送的帧，没有应答。
    STREAM: Stream = "stream" "数据流" {
        use OPERATION.code, TEXT.zh, TEXT.en, COMMON.aliases, COMMON.about;
        /// Its sender.
        /// 由谁发送。
        required from: Side;
        /// Command that starts it. The stream may share the code of this command: the data type tells their frames apart.
        /// 开始它的指令。数据流可以与这条指令共用功能码，两者的帧靠数据类型区分。
        optional started_by: Ref<Command>, example "start_mapping", faults [UnknownOperation, NotACommand];
        /// Command that stops it; it may be the same one.
        /// 停止它的指令，可以就是开始它的那一条。
        optional stopped_by: Ref<Command>, example "stop_mapping", faults [UnknownOperation, NotACommand];
        /// Media type of the bytes in a frame, such as `image/png`. For JSON, write `body` instead.
        /// 每帧所装字节的媒体类型，例如 `image/png`；内容是 JSON 时改写 `body`。
        optional content: MediaType, faults [StreamContent];
        use COMMON.kept, COMMON.since, COMMON.available, OPERATION.source;
        /// Keys of the JSON object in each frame, in the order sent. The object has no envelope.
        /// 每帧是一个 JSON 对象：列出它的键，按发送的顺序书写；没有公共字段。
        optional body: Body, faults [BodyTooLarge];
        use OPERATION.deprecated, COMMON.changes, COMMON.answers;
    }

    /// A code and its confidence.
    /// 功能码及其可靠程度。
    CODE: InferredCode = "inferred code" "推断的功能码" {
        /// The code.
        /// 功能码。
        required value: Code, faults [DuplicateCode, RetiredCode, CodeOutsideRanges, CodeInWrongRange];
        /// Its confidence.
        /// 可靠程度。
        required state: FactState;
    }

    /// An effect and its confidence.
    /// 影响及其可靠程度。
    EFFECT: InferredEffect = "inferred effect" "推断的影响" {
        /// Its effect on the robot.
        /// 对机器人的影响。
        required value: KnownEffect;
        use CODE.state;
    }

    /// Preconditions of a command: states of the robot, commands that come first, or both.
    /// 受理指令的条件：机器人所处的状态、须先发送的指令，或两者都有。
    ACCEPTED: Precondition = "precondition" "受理条件" {
        /// `any`, or enums with their accepted values in the form that is sent. Reports or responses must carry each enum.
        /// `any`，或若干枚举及受理时的取值，按发送的形式书写。每个枚举须在上报或响应中出现。
        optional r#in: (AnyState, Entries<Ref<Enum>, List<Scalar, 1>, 1>),
            example "{ RobotState: [1, 2] }",
            faults [UnknownType, NotAnEnum, UnseenState, StateValue, DuplicateItem];
        /// Commands to be sent first.
        /// 须先发送的指令。
        optional after: List<Ref<Command>, 1>,
            example "[start_mapping]",
            faults [UnknownOperation, NotACommand, ComesBeforeItself];
        /// Additional notes.
        /// 补充说明。
        optional note: BothLanguages;
    }

    /// When a report is sent; exactly one of the keys.
    /// 上报的时机；各键只写其一。
    CADENCE: ReportCadence = "cadence" "上报时机" {
        /// At each change of this field. Write its wire keys from the body on, such as `data.status`; a key of a list leads to its items.
        /// 该字段每变化一次上报一次。从正文起按键名书写，例如 `data.status`；列表的键指其中的每一项。
        optional on_change: Str, example "data.status", faults [UnknownField];
        /// At each step of a number.
        /// 数值每变化一个步长上报一次。
        optional step: ReportStep, faults [CadenceRules];
        /// At intervals of this many milliseconds. An app counts a report as late if it comes more than one and a half intervals after the last one.
        /// 每隔多少毫秒上报一次。与上一次相隔超过一个半间隔的，app 计为迟到。
        optional every_ms: Int<u32, 1>, example "1000", faults [CadenceRules];
        /// At the latest this many milliseconds after a command that sets it off (`sets_off`).
        /// 最晚在引起它的指令（见 `sets_off`）之后多少毫秒上报。
        optional within_ms: Int<u32, 1>, example "500", faults [CadenceRules, DeadlineOfNothing];
    }

    /// A number of a report, and its step from one report to the next.
    /// 上报中的一个数值，以及它的步长。
    STEP: ReportStep = "step" "步长" {
        /// The field, named as in `on_change`.
        /// 字段，写法与 `on_change` 相同。
        required field: Str, example "data.battery", faults [UnknownField, StepOnWrongType];
        /// The step, greater than 0.
        /// 步长，大于 0。
        required by: Number, example "5", faults [StepOfNothing];
    }

    /// The confidence of a body, and the reason.
    /// 消息体的可靠程度，以及理由。
    BODY_STATE: BodyState = "body state" "消息体的可靠程度" {
        /// Its confidence.
        /// 可靠程度。
        required state: State;
        use TEXT.zh, TEXT.en;
    }

    /// A result code and its meaning for this operation.
    /// 结果码，以及它对这个接口的含义。
    ERROR: DeclaredError = "error" "错误" {
        /// The result code.
        /// 结果码。
        required code: Ref<ResultCode>, example "2", faults [UnknownResult, SuccessAsError, DuplicateItem];
        use TEXT.zh, TEXT.en;
    }

    /// Its sections in the source document, and the facts missing from them.
    /// 在源文档中的节号，以及其中缺失的内容。
    SOURCE: Source = "source" "出处" {
        /// Section numbers; empty if it is not in the source document.
        /// 节号；源文档中没有时留空。
        required sections: List<Int<u16, 1>>, example "[12]", faults [SectionGap];
        /// Facts missing from the sections.
        /// 这些节中缺失的内容。
        optional lost: List<SourceFact>, faults [LostButStated];
    }
}
