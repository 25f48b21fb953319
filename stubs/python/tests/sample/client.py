"""The app's side: one method per command."""

from __future__ import annotations

from typing import ClassVar, TypeAlias

import fc_runtime as rt

from .groups.battery import AnyBatteryReport, BatteryCalls, BatteryStreams
from .protocol import SAMPLE

AnyReport: TypeAlias = AnyBatteryReport | rt.RawReport
"""任意一个主动上报；编码不在规范中的为 `RawReport`。Any report; `RawReport` where the spec does not know the code."""


class Client(BatteryCalls, rt.Client[AnyReport]):
    """一个机器人，从 app 一侧看：每条指令一个方法。

    A robot as seen from the app: one method per command.
    """

    protocol: ClassVar[rt.Protocol] = SAMPLE


class Streams(BatteryStreams, rt.Streams):
    """数据端口上的数据流。

    The streams of the data port.
    """
