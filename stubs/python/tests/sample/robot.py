"""The robot's side: one method per command."""

from __future__ import annotations

from abc import ABC
from typing import ClassVar

import fc_runtime as rt

from .groups.battery import BatteryHandlers, BatteryPartialHandlers, BatteryReporter, BatteryStreamer
from .protocol import SAMPLE


class Robot(BatteryHandlers, rt.Robot, ABC):
    """完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，类型检查器会指出。

    A complete robot, which handles all commands of the spec. When the spec gains a command, the type checker reports
    a missing method, and Python refuses to create the robot.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE

    @rt.left_out
    async def pass_through(self, context: rt.Context, request: rt.RawRequest) -> rt.Json:
        """直接透传

        Passed straight through. Codes 0x0500 to 0x05FF without a separate method.
        """
        raise NotImplementedError


class PartialRobot(BatteryPartialHandlers, Robot):
    """有一部分指令的机器人：方法相同，都可以不写；没有写的指令以“未实现”拒绝。

    A robot with some of the commands. It refuses the others as not implemented.
    """


class ExampleRobot(rt.ExampleRobot):
    """按规范的示例应答的演示机器人。

    A robot that responds with the examples in the spec.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE


class Reporter(BatteryReporter, rt.Reporter):
    """主动上报：每种上报一个方法。

    Pushes reports: one method per report.
    """


class Streamer(BatteryStreamer, rt.Streamer):
    """机器人发送的数据流：每个数据流一个方法。

    Sends the robot's streams: one method per stream.
    """
