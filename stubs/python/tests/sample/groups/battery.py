"""The one group of the sample: its messages, its operations, its part of each stub."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated, ClassVar, Final, NewType, TypeAlias

import fc_runtime as rt

__all__ = [
    "DOCK",
    "DOCKING",
    "FIRMWARE",
    "GET_BATTERY",
    "SCAN",
    "DockError",
    "DockId",
    "DockRequest",
    "DockResponse",
    "Docking",
    "DockingAck",
    "GetBatteryRequest",
    "GetBatteryResponse",
    "Phase",
    "Scan",
    "Unit",
]

DockId = NewType("DockId", str)
"""充电桩：ID

Dock: its ID
"""


@rt.wire_enum("u8")
class Phase(rt.State):
    """回充阶段

    Phase of docking
    """

    IDLE = 0
    """空闲

    Idle
    """

    DRIVING = 1
    """前往充电桩

    Driving to the dock
    """

    CHARGING = 2
    """充电中

    Charging
    """

    FAILED = 9
    """失败

    Failed
    """

    @classmethod
    def process(cls) -> rt.Process:
        """规范对各个状态的说明。

        The description of these states in the spec.
        """
        return rt.Process(
            normal={cls.IDLE: [cls.DRIVING], cls.DRIVING: [cls.CHARGING]},
            final=[cls.CHARGING],
            error=[cls.FAILED],
        )


@rt.wire_enum("string", is_open=False)
class Unit(Enum):
    """单位

    Unit
    """

    METRE = "m"
    """米

    Metre
    """


@dataclass(slots=True, kw_only=True)
class GetBatteryRequest(rt.Message):
    """查询电量：请求

    Get the battery: request
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


@dataclass(slots=True, kw_only=True)
class GetBatteryResponse(rt.Message):
    """查询电量：响应

    Get the battery: response
    """

    __example__: ClassVar[str] = '{"level":80,"phase":0}'

    level: Annotated[rt.U8, rt.Key("level", max=100)]
    """电量，%

    Battery level, %
    """

    phase: Annotated[Phase | rt.Unknown[int], rt.Key("phase")]
    """回充阶段

    Phase of docking
    """

    owner: Annotated[str | None, rt.Key("owner")] = field(default=None, repr=False)
    """所有者；不打印

    Owner; not printed
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


@dataclass(slots=True, kw_only=True)
class DockRequest(rt.Message):
    """回充：请求

    Dock: request
    """

    __example__: ClassVar[str] = '{"dock":"A"}'

    DEFAULT_SPEED: ClassVar[int] = 3
    """没有 `speed` 时的取值。The default of `speed`."""

    dock: Annotated[DockId, rt.Key("dock", length=(1, 8))]
    """充电桩

    Dock
    """

    speed: Annotated[rt.U8 | None, rt.Key("speed")] = None
    """速度

    Speed
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""

    @property
    def speed_or_default(self) -> int:
        """速度；没有时为默认值。Speed, or its default."""
        return self.DEFAULT_SPEED if self.speed is None else self.speed


@dataclass(slots=True, kw_only=True)
class DockResponse(rt.Message):
    """回充：响应

    Dock: response
    """

    __example__: ClassVar[str] = '{"job":7}'

    job: Annotated[rt.U32 | None, rt.Key("job")] = None
    """动作编号

    Number of the movement
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


class DockError(rt.Result):
    """回充声明的错误

    Errors that `dock` declares
    """

    NO_DOCK = 3001, "no dock"
    """没有充电桩

    There is no dock
    """


@dataclass(slots=True, kw_only=True)
class Docking(rt.Message):
    """回充进度

    Progress of docking
    """

    __example__: ClassVar[str] = '{"phase":1,"job":7}'

    phase: Annotated[Phase | rt.Unknown[int], rt.Key("phase")]
    """回充阶段

    Phase of docking
    """

    job: Annotated[rt.U32 | None, rt.Key("job")] = None
    """动作编号

    Number of the movement
    """

    cause: Annotated[str | None, rt.Key("cause", when={"phase": (Phase.FAILED,)})] = None
    """失败的原因

    Why it failed
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


@dataclass(slots=True, kw_only=True)
class DockingAck(rt.Message):
    """回充进度：确认

    Progress of docking: acknowledgement
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


@dataclass(slots=True, kw_only=True)
class Scan(rt.Message):
    """激光扫描

    Laser scan
    """

    __example__: ClassVar[str] = '{"metres":[1.5]}'

    metres: Annotated[list[rt.F64], rt.Key("metres", length=(1, 4096))]
    """距离，m

    Distances, m
    """

    extra: rt.Extra = field(default_factory=rt.Extra)
    """其他键，原样保留。Other keys, kept unchanged."""


DOCKING: Final = rt.Report(
    name="docking",
    code=0x0300,
    zh="回充进度",
    en="Progress of docking",
    request=Docking,
    response=DockingAck,
    ack=rt.AckPolicy(timeout=2.0, retries=3),
    cadence=rt.Cadence(on_change="phase"),
    state="phase",
)

GET_BATTERY: Final = rt.Command(
    name="get_battery",
    code=0x0100,
    zh="查询电量",
    en="Get the battery",
    request=GetBatteryRequest,
    response=GetBatteryResponse,
    effect=rt.Effect.READ,
    docs="reference/commands/get_battery.md",
    spec="spec/commands/battery.yaml",
)

DOCK: Final = rt.Command(
    name="dock",
    code=0x0200,
    zh="回充",
    en="Dock",
    request=DockRequest,
    response=DockResponse,
    effect=rt.Effect.MOTION,
    preconditions=rt.Preconditions(
        states=(rt.States(Phase, frozenset({Phase.IDLE, Phase.FAILED})),),
        after=("get_battery",),
    ),
    errors=DockError,
    sets_off=(rt.SetsOff(report=DOCKING, ties=(rt.Tie(of_response=True, command="job", report="job"),)),),
)

SCAN: Final = rt.Stream(
    name="scan",
    code=0x0400,
    zh="激光扫描",
    en="Laser scan",
    body=Scan,
    from_robot=True,
)

FIRMWARE: Final = rt.Stream(
    name="firmware",
    code=0x0401,
    zh="固件",
    en="Firmware",
    body=bytes,
    from_robot=False,
    content="application/octet-stream",
)

BATTERY_REPORTS: Final = (DOCKING,)

BATTERY_COMMANDS: Final = (
    GET_BATTERY,
    DOCK,
)

BATTERY_STREAMS: Final = (
    SCAN,
    FIRMWARE,
)

AnyBatteryReport: TypeAlias = Docking


class BatteryCalls(rt.Calls):
    """`Client` 的一部分：`battery` 组的指令。

    The part of `Client` with the commands of the group `battery`.
    """

    async def get_battery(
        self,
        request: GetBatteryRequest | None = None,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> GetBatteryResponse:
        """查询电量

        Get the battery
        """
        return await self.connection.call(GET_BATTERY, request, timeout=timeout, repeat=repeat)

    def dock(
        self,
        request: DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> rt.Followable[DockResponse, Docking]:
        """回充

        Dock
        """
        return self._followable(DOCK, DOCKING, request=request, timeout=timeout, repeat=repeat)


class BatterySyncCalls(rt.SyncCalls):
    """`sync.Client` 的一部分：`battery` 组的指令。

    The part of `sync.Client` with the commands of the group `battery`.
    """

    def get_battery(
        self,
        request: GetBatteryRequest | None = None,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> GetBatteryResponse:
        """查询电量

        Get the battery
        """
        return self._call(GET_BATTERY, request, timeout, repeat)

    def dock(
        self,
        request: DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> DockResponse:
        """回充

        Dock
        """
        return self._call(DOCK, request, timeout, repeat)

    def follow_dock(
        self,
        request: DockRequest,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> rt.SyncFollowing[DockResponse, Docking]:
        """回充

        Dock

        先取得响应，再逐个取得它引起的 `Docking`。
        Returns the response, and then each `Docking` that it sets off.
        """
        return self._follow(DOCK, DOCKING, request, timeout, repeat)


class BatteryStreams(rt.Streams):
    """`Streams` 的一部分：`battery` 组的数据流。

    The part of `Streams` with the streams of the group `battery`.
    """

    def subscribe_scan(self) -> rt.Subscription[Scan]:
        """激光扫描

        Laser scan
        """
        return self.data.subscribe(SCAN)

    async def send_firmware(self, message_id: int, content: bytes) -> None:
        """固件

        Firmware
        """
        await self.data.send_stream(FIRMWARE, message_id, content)


class BatteryHandlers(ABC):
    """`Robot` 的一部分：`battery` 组的指令。

    The part of `Robot` with the commands of the group `battery`.
    """

    @abstractmethod
    async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
        """查询电量

        Get the battery
        """

    @abstractmethod
    async def dock(self, context: rt.Context, request: DockRequest) -> DockResponse:
        """回充

        Dock
        """


class BatteryPartialHandlers(BatteryHandlers):
    """`PartialRobot` 的一部分：`battery` 组的指令。

    The part of `PartialRobot` with the commands of the group `battery`.
    """

    @rt.left_out
    async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
        """See `Robot.get_battery`."""
        raise NotImplementedError

    @rt.left_out
    async def dock(self, context: rt.Context, request: DockRequest) -> DockResponse:
        """See `Robot.dock`."""
        raise NotImplementedError


class BatteryReporter(rt.Reporter):
    """`Reporter` 的一部分：`battery` 组的上报。

    The part of `Reporter` with the reports of the group `battery`.
    """

    async def docking(self, report: Docking, to: int | None = None) -> list[rt.Acknowledgement]:
        """回充进度

        Progress of docking
        """
        return await self.server.push(DOCKING, report, to)


class BatteryStreamer(rt.Streamer):
    """`Streamer` 的一部分：`battery` 组的数据流。

    The part of `Streamer` with the streams of the group `battery`.
    """

    async def send_scan(self, message_id: int, content: Scan, to: int | None = None) -> int:
        """激光扫描

        Laser scan
        """
        return await self.server.send_stream(SCAN, message_id, content, to)
