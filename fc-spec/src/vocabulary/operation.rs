//! The words of operations and their codes.

use super::KindRole;
use super::{Meaning, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
