"""The app's side without `async`."""

from __future__ import annotations

from typing import ClassVar

import fc_runtime as rt

from .client import AnyReport
from .groups.battery import BatterySyncCalls
from .protocol import SAMPLE


class Client(BatterySyncCalls, rt.SyncClient[AnyReport]):
    """一个机器人，从 app 一侧看：每条指令一个方法。

    A robot as seen from the app: one method per command.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE
