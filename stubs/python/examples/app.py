"""An app that tries out a robot: calls every command of the spec with its example, takes the reports and a picture.

./run robot &
./run app
"""

from __future__ import annotations

import asyncio
import sys
import warnings
from typing import TypeVar

import fc
import fc_runtime as rt
from common import Table, arguments, client_config

T = TypeVar("T")

# Time the app waits for reports and pictures, in seconds.
PATIENCE = 20.0


class Tour:
    """Results of the operations so far."""

    def __init__(self, lang: str) -> None:
        """Creates the table without results."""
        self.is_chinese = lang == "zh"
        head = ["功能码", "类型", "名称", "说明", "结果"], ["Code", "Kind", "Name", "Title", "Outcome"]
        self.table = Table(*self.pick(*head))
        self.failed = 0

    def pick(self, zh: T, en: T) -> T:
        """Returns the text in the chosen language."""
        return zh if self.is_chinese else en

    def add(self, code: int, kind: str, outcome: str, *, ok: bool = True) -> None:
        """Adds a row."""
        known = fc.FC.operation(code)
        name, title = (known.name, self.pick(known.zh, known.en)) if known else ("", "")
        self.table.row(f"0x{code:04X}", kind, name, title, outcome)
        self.failed += not ok


async def call_all(client: fc.Client, tour: Tour) -> None:
    """Calls every command with the spec's example."""
    # A robot still handles deprecated commands.
    warnings.simplefilter("ignore", DeprecationWarning)
    kind = tour.pick("指令", "command")
    for code, command in fc.FC.commands_by_code.items():
        try:
            await getattr(client, command.method_name)(command.request.example())
            tour.add(code, kind, tour.pick("成功", "answered"))
        except rt.CallError as error:
            if error.loss is not None:
                # The robot has gone, and the other calls would only wait for it.
                raise
            tour.add(code, kind, str(error), ok=False)


async def receive_all(reports: rt.Reports[fc.AnyReport], tour: Tour) -> None:
    """Waits until every report has come once."""
    missing = {report.request: code for code, report in fc.FC.reports_by_code.items()}
    while missing:
        try:
            report = await asyncio.wait_for(reports.recv(), PATIENCE)
        except asyncio.TimeoutError:
            sys.exit(f"no report for a while; missing: {[hex(code) for code in missing.values()]}")
        if report is None:
            sys.exit("the robot has left")
        code = missing.pop(type(report), None)
        if code is not None:
            tour.add(code, tour.pick("主动上报", "report"), tour.pick("收到", "received"))


async def receive_picture(data: rt.DataConnection, tour: Tour) -> None:
    """Waits for the picture requested by the call for a map image. Its digest has already been verified."""
    try:
        frame = await asyncio.wait_for(data.recv(), PATIENCE)
    except asyncio.TimeoutError:
        sys.exit("no picture came")
    is_asked_for = frame.code == fc.operations.GET_MAP_IMAGE.code
    size = len(frame.data)
    outcome = tour.pick(
        f"收到 {size} 字节，msgId {frame.id}，MD5 一致", f"received {size} bytes, msgId {frame.id}, MD5 verified"
    )
    kind = tour.pick("数据流", "stream")
    tour.add(frame.code, kind, outcome if is_asked_for else "unexpected picture", ok=is_asked_for)


async def run() -> int:
    """Runs the tour. Returns the number of failed operations."""
    asked = arguments("Calls every command of a robot and prints what came of it.")
    async with fc.Client.connect(client_config(asked)) as client, client.reports() as reports:
        # region data
        data = client.data()
        await data.connected()
        # endregion data
        tour = Tour(asked.lang)
        await call_all(client, tour)
        await receive_all(reports, tour)
        await receive_picture(data, tour)
        print(tour.table)
        return tour.failed


if __name__ == "__main__":
    try:
        failed = asyncio.run(run())
    except (rt.ConnectError, rt.CallError, rt.DataError) as error:
        sys.exit(str(error))
    if failed:
        sys.exit(f"{failed} operations failed")
