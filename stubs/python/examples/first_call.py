"""The first call, from both ends: a robot that has one command so far, and an app that calls it and takes a report.

They meet on loopback; the guide of this name tells the story.

    ./run first_call
"""

from __future__ import annotations

import asyncio

import fc
import fc_runtime as rt


# region robot
class MyRobot(fc.PartialRobot):
    """Implements `get_robot_sn` so far; all other commands are refused as not implemented.

    目前只实现 `get_robot_sn`，其余指令以“未实现”拒绝。
    """

    async def get_robot_sn(self, context: rt.Context, request: fc.GetRobotSnRequest) -> fc.GetRobotSnResponse:
        """Returns the serial number."""
        # 其余字段先用规范中的示例。
        # The other keys are those of the spec's example for now.
        response = fc.GetRobotSnResponse.example()
        response.data.robot_sn = "100132007654321"
        return response


# endregion robot


# region report
async def report(reporter: fc.Reporter) -> None:
    """Reports the progress of recharging."""
    report = fc.RechargeProgress.example()
    report.data.recharge_status = fc.RechargeStatus.AT_UNDOCK_POINT
    # 等到每个 app 应答，或重发次数用完。
    # Waits until every app has acknowledged it, or the repetitions are used up.
    acknowledgements = await reporter.recharge_progress(report)
    print(f"robot: {len(acknowledgements)} app has acknowledged")


# endregion report


# region app
async def app(client: fc.Client) -> None:
    """Reads the robot's serial number."""
    answer = await client.get_robot_sn()
    print("app: the robot is", answer.data.robot_sn)


# endregion app


# region listen
async def listen(client: fc.Client) -> None:
    """Takes the first report about recharging."""
    async with client.reports() as reports:
        async for report in reports:
            if isinstance(report, fc.RechargeProgress):
                print("app: recharging is at", report.data.recharge_status)
                break


# endregion listen


async def main() -> None:
    """Runs both."""
    # region serve
    # 端口 0：由系统分配。不写就是协议规定的端口。
    # Port 0 is any that is free; without it, the ports of the protocol.
    config = rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0)
    async with rt.Server(MyRobot(), config) as server:
        port = server.command_address[1]
        # endregion serve
        # region connect
        async with fc.Client.connect(rt.ClientConfig(host="127.0.0.1", command_port=port)) as client:
            await app(client)
            await asyncio.gather(listen(client), report(fc.Reporter(server)))
        # endregion connect


if __name__ == "__main__":
    asyncio.run(main())
