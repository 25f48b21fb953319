"""The robot's side: one method per command."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import fc_runtime as rt

from . import messages, operations
from .protocol import SAMPLE


class Robot(rt.Robot, ABC):
    """完整的机器人：处理规范中的全部指令。规范新增一条指令，这里就缺少一个方法，类型检查器会指出。

    A complete robot: it handles all commands of the spec. When the spec gains one, a method is missing here, and the
    type checker says so, and Python when the robot is made.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE

    @abstractmethod
    async def get_battery(
        self, context: rt.Context, request: messages.GetBatteryRequest
    ) -> messages.GetBatteryResponse:
        """查询电量

        Get the battery
        """

    @abstractmethod
    async def dock(self, context: rt.Context, request: messages.DockRequest) -> messages.DockResponse:
        """回充

        Dock
        """

    @rt.left_out
    async def pass_through(self, context: rt.Context, request: rt.RawRequest) -> rt.Json:
        """直接透传

        Passed straight through. Codes 0x0500 to 0x05FF that have no method of their own.
        """
        raise NotImplementedError


class PartialRobot(Robot):
    """有一部分指令的机器人：方法相同，都可以不写；没有写的指令以“未实现”拒绝。

    A robot that has some of them so far: what is left out is refused as not implemented.
    """

    @rt.left_out
    async def get_battery(
        self, context: rt.Context, request: messages.GetBatteryRequest
    ) -> messages.GetBatteryResponse:
        """See `Robot.get_battery`."""
        raise NotImplementedError

    @rt.left_out
    async def dock(self, context: rt.Context, request: messages.DockRequest) -> messages.DockResponse:
        """See `Robot.dock`."""
        raise NotImplementedError


class ExampleRobot(rt.ExampleRobot):
    """按规范的示例应答的演示机器人。

    A robot that answers with the examples in the spec.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE


class Reporter(rt.Reporter):
    """主动上报：每种上报一个方法。

    Pushes reports: one method per report.
    """

    async def docking(self, report: messages.Docking, to: int | None = None) -> list[rt.Acknowledgement]:
        """回充进度

        Progress of docking
        """
        return await self.server.push(operations.DOCKING, report, to)


class Streamer(rt.Streamer):
    """机器人发送的数据流：每个数据流一个方法。

    Sends the robot's streams: one method per stream.
    """

    async def send_scan(self, message_id: int, content: messages.Scan, to: int | None = None) -> int:
        """激光扫描

        Laser scan
        """
        return await self.server.send_stream(operations.SCAN, message_id, content, to)
