"""Operations of the sample, with all that its spec says of them. Reports come first: commands name them."""

from __future__ import annotations

from typing import Final

import fc_runtime as rt

from . import messages

DOCKING: Final = rt.Report(
    name="docking",
    code=0x0300,
    zh="回充进度",
    en="Progress of docking",
    request=messages.Docking,
    response=messages.DockingAck,
    ack=rt.AckPolicy(timeout=2.0, retries=3),
    cadence=rt.Cadence(on_change="phase"),
    state="phase",
)

GET_BATTERY: Final = rt.Command(
    name="get_battery",
    code=0x0100,
    zh="查询电量",
    en="Get the battery",
    request=messages.GetBatteryRequest,
    response=messages.GetBatteryResponse,
    effect=rt.Effect.READ,
    docs="reference/commands/get_battery.md",
    spec="spec/commands/battery.yaml",
)

DOCK: Final = rt.Command(
    name="dock",
    code=0x0200,
    zh="回充",
    en="Dock",
    request=messages.DockRequest,
    response=messages.DockResponse,
    effect=rt.Effect.MOTION,
    preconditions=rt.Preconditions(
        states=(rt.States(messages.Phase, frozenset({messages.Phase.IDLE, messages.Phase.FAILED})),),
        after=("get_battery",),
    ),
    errors=messages.DockError,
    sets_off=(rt.SetsOff(report=DOCKING, ties=(rt.Tie(of_response=True, command="job", report="job"),)),),
)

SCAN: Final = rt.Stream(
    name="scan",
    code=0x0400,
    zh="激光扫描",
    en="Laser scan",
    body=messages.Scan,
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
