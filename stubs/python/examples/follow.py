"""A command followed from its response to its end: the robot returns to its charging dock and reports each step.

They meet on loopback.

    ./run follow
"""

from __future__ import annotations

import asyncio

import fc
import fc_runtime as rt
from fc import RechargeError, RechargeProgress, RechargeStatus


class Docking(fc.PartialRobot):
    """A robot that starts to recharge on request."""

    def __init__(self) -> None:
        self.asked = asyncio.Event()

    async def start_recharge(self, context: rt.Context, request: fc.StartRechargeRequest) -> fc.StartRechargeResponse:
        """Starts to recharge."""
        self.asked.set()
        return fc.StartRechargeResponse()


async def drive(robot: Docking, reporter: fc.Reporter) -> None:
    """Drives to the dock on request, and fails there."""
    await robot.asked.wait()
    report = RechargeProgress.example()
    for status in (RechargeStatus.NAVIGATING, RechargeStatus.AT_UNDOCK_POINT):
        report.data.recharge_status = status
        await reporter.recharge_progress(report)
    report.data.error_status = RechargeError.FAILED
    await reporter.recharge_progress(report)


# region follow
# 一条上报最多等多久；由 app 自己决定。
# Longest wait for a report, in seconds; the app decides.
PATIENCE = 60.0


async def recharge(client: fc.Client) -> None:
    """Recharges the robot, and prints its progress."""
    async with client.start_recharge().follow() as following:
        print("app: the robot has answered")
        while (event := await asyncio.wait_for(following.recv(), PATIENCE)) is not None:
            match event:
                case rt.Going(report) if report.data.recharge_status is RechargeStatus.CHARGING:
                    print("app: charging")
                    # 不再跟踪。
                    # Stops following.
                    break
                case rt.Going(report):
                    print(f"app: {report.data.recharge_status}")
                case rt.Ended(report):
                    print(f"app: ended at {report.data.recharge_status}")
                case rt.Failed(_):
                    print("app: failed")
                case rt.Missed(count):
                    print(f"app: {count} reports missed")
                case rt.Interrupted(why):
                    print(f"app: {why}; waiting")
                case rt.Resumed():
                    print("app: connected again")


# endregion follow


async def main() -> None:
    """Runs both."""
    robot = Docking()
    async with rt.Server(robot, rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0)) as server:
        port = server.command_address[1]
        async with fc.Client.connect(rt.ClientConfig(host="127.0.0.1", command_port=port)) as client:
            await asyncio.gather(recharge(client), drive(robot, fc.Reporter(server)))


if __name__ == "__main__":
    asyncio.run(main())
