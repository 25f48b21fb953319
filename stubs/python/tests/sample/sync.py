"""The app's side without `async`."""

from __future__ import annotations

from typing import ClassVar

import fc_runtime as rt

from . import messages, operations
from .client import AnyReport
from .protocol import SAMPLE


class Client(rt.SyncClient[AnyReport]):
    """一个机器人，从 app 一侧看：每条指令一个方法。

    A robot as seen from the app: one method per command.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE

    def get_battery(
        self,
        request: messages.GetBatteryRequest | None = None,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> messages.GetBatteryResponse:
        """查询电量

        Get the battery
        """
        return self._call(operations.GET_BATTERY, request, timeout, repeat)

    def dock(
        self,
        request: messages.DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> messages.DockResponse:
        """回充

        Dock
        """
        return self._call(operations.DOCK, request, timeout, repeat)

    def follow_dock(
        self,
        request: messages.DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> rt.SyncFollowing[messages.DockResponse, messages.Docking]:
        """回充

        Dock

        先取得响应，再逐个取得它引起的 `messages.Docking`。
        Gives the response, and then each `messages.Docking` that it sets off.
        """
        return self._follow(operations.DOCK, operations.DOCKING, request, timeout, repeat)
