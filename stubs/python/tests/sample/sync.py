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
        """See `sample.Client.get_battery`."""
        return self._call(operations.GET_BATTERY, request, timeout, repeat)

    def dock(
        self,
        request: messages.DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> messages.DockResponse:
        """See `sample.Client.dock`."""
        return self._call(operations.DOCK, request, timeout, repeat)

    def follow_dock(
        self,
        request: messages.DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> rt.SyncFollowing[messages.DockResponse, messages.Docking]:
        """See `sample.Client.dock` and its `follow()`."""
        return self._follow(operations.DOCK, operations.DOCKING, request, timeout, repeat)
