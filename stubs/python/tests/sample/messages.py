"""Messages of the sample."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated, ClassVar, NewType

import fc_runtime as rt

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

        What the spec says of the values as states.
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
    """没有 `speed` 时的取值。What it is where there is no `speed`."""

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
        """速度；没有时为默认值。Speed, or its default where there is none."""
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
