"""The app's side: one method per command."""

from __future__ import annotations

from typing import ClassVar, TypeAlias

import fc_runtime as rt

from . import messages, operations
from .protocol import SAMPLE

AnyReport: TypeAlias = messages.Docking | rt.RawReport
"""任意一个主动上报；编码不在规范中的为 `RawReport`。Any report; `RawReport` where the spec does not know the code."""


class Client(rt.Client[AnyReport]):
    """一个机器人，从 app 一侧看：每条指令一个方法。

    A robot as seen from the app: one method per command.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE

    async def get_battery(
        self,
        request: messages.GetBatteryRequest | None = None,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> messages.GetBatteryResponse:
        """查询电量

        Get the battery
        """
        return await self.connection.call(operations.GET_BATTERY, request, timeout=timeout, repeat=repeat)

    def dock(
        self,
        request: messages.DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> rt.Followable[messages.DockResponse, messages.Docking]:
        """回充

        Dock
        """
        return self._followable(operations.DOCK, operations.DOCKING, request=request, timeout=timeout, repeat=repeat)


class Streams(rt.Streams):
    """数据端口上的数据流。

    The streams of the data port.
    """

    def subscribe_scan(self) -> rt.Subscription[messages.Scan]:
        """激光扫描

        Laser scan
        """
        return self.data.subscribe(operations.SCAN)

    async def send_firmware(self, message_id: int, content: bytes) -> None:
        """固件

        Firmware
        """
        await self.data.send_stream(operations.FIRMWARE, message_id, content)
