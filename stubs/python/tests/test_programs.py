"""The programs as their users run them: app and robot with each other and with those of Rust, and the tool."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
import unittest
from pathlib import Path

import fc
import fc_runtime as rt
from support import AsyncCase

HERE = Path(__file__).resolve().parents[1]
PATIENCE = 60.0
# Folder of the Rust example programs, if they are built.
RUST = os.environ.get("FC_RUST_EXAMPLES")

Process = asyncio.subprocess.Process


def program(language: str, name: str) -> list[str]:
    return [str(HERE / "run"), name] if language == "python" else [str(Path(RUST or "") / name)]


async def start(command: list[str]) -> Process:
    environment = {**os.environ, "PYTHON": sys.executable}
    return await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE, env=environment
    )


def end(process: Process) -> None:
    if process.returncode is None:
        process.kill()


async def refuses(port: int) -> bool:
    """Returns `True` if no program listens on a port."""
    try:
        _, writer = await asyncio.open_connection("127.0.0.1", port)
    except OSError as error:
        # A connection that was about to be accepted is reset.
        return isinstance(error, ConnectionRefusedError)
    writer.close()
    return False


async def outcome(process: Process) -> tuple[int | None, str, str]:
    out, error = await asyncio.wait_for(process.communicate(), PATIENCE)
    return process.returncode, out.decode(), error.decode()


class Programs(AsyncCase):
    async def robot(self, language: str, *more: str) -> tuple[Process, str, str]:
        process = await start([*program(language, "robot"), "--command-port", "0", "--data-port", "0", *more])
        self.addCleanup(end, process)
        assert process.stdout is not None
        words = (await asyncio.wait_for(process.stdout.readline(), PATIENCE)).decode().split()
        self.assertEqual((words[0], words[2]), ("commands", "data"))
        return process, words[1].rpartition(":")[2], words[3].rpartition(":")[2]

    async def tour(self, app: str, robot: str) -> None:
        process, commands, data = await self.robot(robot)
        options = ["--host", "127.0.0.1", "--command-port", commands, "--data-port", data, "--lang", "zh"]
        code, table, error = await outcome(await start([*program(app, "app"), *options]))
        self.assertEqual((code, error), (0, ""), table)
        rows = table.splitlines()
        expected = 1 + len(fc.FC.commands_by_code) + len(fc.FC.reports_by_code) + 1
        self.assertEqual(len(rows), expected, table)
        self.assertIn("MD5 一致", rows[-1])
        process.send_signal(signal.SIGTERM)
        code, out, _ = await outcome(process)
        self.assertEqual(code, 0)
        # Every report is acknowledged; each language prints that with another spelling.
        self.assertEqual(out.lower().count("acknowledged"), len(fc.FC.reports_by_code), out)

    async def test_the_app_tours_the_robot(self) -> None:
        await self.tour("python", "python")

    @unittest.skipUnless(RUST, "FC_RUST_EXAMPLES does not say where the programs of Rust are")
    async def test_the_app_tours_the_robot_of_rust(self) -> None:
        await self.tour("python", "rust")

    @unittest.skipUnless(RUST, "FC_RUST_EXAMPLES does not say where the programs of Rust are")
    async def test_the_app_of_rust_tours_the_robot(self) -> None:
        await self.tour("rust", "python")

    async def comes_back(self, language: str) -> None:
        process, commands, data = await self.robot(language)
        config = rt.ClientConfig(
            host="127.0.0.1",
            command_port=int(commands),
            data_port=int(data),
            call_timeout=PATIENCE,
            reconnect=rt.Backoff(first=0.01, longest=0.05),
        )
        async with fc.Client.connect(config) as client:
            self.assertEqual(await client.get_robot_sn(), fc.GetRobotSnResponse.example())
            process.kill()
            await process.wait()
            async for state in client.states():
                if isinstance(state, rt.Connecting):
                    break
            # It waits for the robot, within its timeout.
            calling = asyncio.ensure_future(client.get_floors())
            ports = ["--command-port", commands, "--data-port", data]
            process = await start([*program(language, "robot"), *ports])
            self.addCleanup(end, process)
            self.assertEqual(await calling, fc.GetFloorsResponse.example())
            # A connection to a robot that is still starting may be lost once more.
            self.assertIsInstance(client.state, rt.Connected)
            self.assertGreaterEqual(client.state.connects, 2)
        process.send_signal(signal.SIGTERM)
        self.assertEqual((await outcome(process))[0], 0)

    async def test_a_robot_that_is_killed_comes_back(self) -> None:
        await self.comes_back("python")

    @unittest.skipUnless(RUST, "FC_RUST_EXAMPLES does not say where the programs of Rust are")
    async def test_the_robot_of_rust_that_is_killed_comes_back(self) -> None:
        await self.comes_back("rust")

    async def test_app_reports_a_missing_robot(self) -> None:
        process, commands, data = await self.robot("python")
        process.send_signal(signal.SIGINT)
        self.assertEqual((await outcome(process))[0], 0)
        ports = ["--command-port", commands, "--data-port", data]
        code, out, error = await outcome(await start([*program("python", "app"), *ports]))
        self.assertEqual((code, out), (1, ""))
        self.assertIn("cannot connect to", error)
        self.assertNotIn("Traceback", error)

    async def test_the_robot_ends_at_once_when_it_is_asked_twice(self) -> None:
        for number in (signal.SIGTERM, signal.SIGINT):
            process, commands, _ = await self.robot("python", "--delay", "3600000")
            config = rt.ClientConfig(
                host="127.0.0.1", command_port=int(commands), reconnect=None, call_timeout=PATIENCE
            )
            async with fc.Client.connect(config) as client:
                calling = asyncio.ensure_future(client.get_robot_sn(repeat=False))
                moving = asyncio.ensure_future(client.start_recharge())
                await asyncio.wait_for(client.reports().recv(), PATIENCE)
                process.send_signal(number)
                # It has noticed the signal, and waits for the requests in handlers.
                while not await refuses(int(commands)):
                    pass
                self.assertFalse(calling.done())
                process.send_signal(number)
                code, _, error = await outcome(process)
                self.assertEqual((code, "Traceback" in error), (0, False), error)
                for call in (calling, moving):
                    with self.assertRaises(rt.LostError):
                        await call

    async def test_the_robot_is_never_killed_by_being_asked_to_end(self) -> None:
        for number in (signal.SIGTERM, signal.SIGINT):
            process, _, _ = await self.robot("python")
            ending = asyncio.ensure_future(process.wait())
            while not ending.done():
                # Until the process ends. `send_signal` would take its exit status from the event loop.
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process.pid, number)
                await asyncio.sleep(0.001)
            code, _, error = await outcome(process)
            self.assertEqual((code, "Traceback" in error), (0, False), error)

    async def test_the_robot_ends_with_its_app_if_it_is_to(self) -> None:
        process, commands, data = await self.robot("python", "--once")
        app = await start([*program("python", "app"), "--command-port", commands, "--data-port", data])
        self.assertEqual((await outcome(app))[0], 0)
        self.assertEqual((await outcome(process))[0], 0)

    async def test_the_app_ends_with_1_when_it_fails(self) -> None:
        class Leaves(fc.PartialRobot):
            async def get_robot_sn(self, context: rt.Context, request: fc.GetRobotSnRequest) -> fc.GetRobotSnResponse:
                leaving.set()
                return fc.GetRobotSnResponse.example()

        leaving = asyncio.Event()
        config = rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0)
        async with rt.Server(Leaves(), config) as server:
            ports = ["--command-port", str(server.command_address[1]), "--data-port", str(server.data_address[1])]
            app = await start([*program("python", "app"), *ports])
            await asyncio.wait_for(leaving.wait(), PATIENCE)
            await server.shutdown(0)
            code, _, error = await outcome(app)
        self.assertEqual((code, "Traceback" in error), (1, False), error)
        self.assertIn("the connection", error)

    async def test_wrong_options_are_refused(self) -> None:
        for name, *options in (
            ("robot", "--command-port", "65536"),
            ("robot", "--host", ""),
            ("robot", "--delay", "nan"),
            ("robot", "--delay", "-1"),
            ("robot", "--picture-scale", "0"),
            ("app", "--command-port", "0"),
            ("app", "--gzip-from", "-1"),
            ("ask", "--host", " "),
            ("drill", "--data-port", "-5"),
        ):
            with self.subTest(name, options=options):
                code, out, error = await outcome(await start([*program("python", name), *options]))
                self.assertEqual((code, out, "Traceback" in error), (2, "", False), error)

    async def test_the_tool_without_async_asks(self) -> None:
        process, commands, _ = await self.robot("python")
        code, out, error = await outcome(await start([*program("python", "ask"), "--command-port", commands]))
        self.assertEqual((code, error), (0, ""))
        self.assertEqual([line.split()[0] for line in out.splitlines()], ["robot", "charging", "faults"])
        process.send_signal(signal.SIGTERM)
        await outcome(process)

    async def test_the_first_call_is_made_from_both_ends(self) -> None:
        code, out, error = await outcome(await start(program("python", "first_call")))
        self.assertEqual((code, error), (0, ""))
        lines = ["app: the robot is", "app: recharging is at", "robot: 1 app has acknowledged"]
        for line, said in zip(out.splitlines(), lines, strict=True):
            self.assertTrue(line.startswith(said), out)

    async def test_the_example_follows_to_the_end(self) -> None:
        code, out, error = await outcome(await start(program("python", "follow")))
        self.assertEqual((code, error), (0, ""))
        self.assertEqual(out.splitlines()[0], "app: the robot has answered")
        self.assertEqual(out.splitlines()[-1], "app: failed")

    async def call(self, *arguments: str) -> tuple[int | None, str, str]:
        return await outcome(await start([sys.executable, "-m", "fc.call", *arguments]))

    async def test_tool_calls_and_reports_errors(self) -> None:
        process, commands, _ = await self.robot("python")
        robot = ["--host", "127.0.0.1", "--command-port", commands]
        code, out, error = await self.call("get_robot_sn", *robot)
        self.assertEqual((code, out.strip(), error), (0, fc.GetRobotSnResponse.example().to_json(), ""))
        code, out, error = await self.call("start_recharge", *robot)
        self.assertEqual((code, out), (2, ""))
        self.assertIn("--move", error)
        code, out, _ = await self.call("start_recharge", "--move", *robot)
        self.assertEqual((code, out.strip()), (0, fc.StartRechargeResponse.example().to_json()))
        code, _, error = await self.call("get_station", '{"data":1}', *robot)
        self.assertEqual(code, 1)
        self.assertIn("wrong_type", error)
        code, _, error = await self.call("no_such", *robot)
        self.assertEqual((code, error), (2, "no such command: no_such; see --list\n"))
        for wrong in (("--timeout", "nan"), ("--timeout", "-1"), ("--host", ""), ("--command-port", "99999")):
            code, out, error = await self.call("get_robot_sn", *robot, *wrong)
            self.assertEqual((code, out), (2, ""), error)
            self.assertIn("expected", error)
            self.assertNotIn("Traceback", error)
        code, out, _ = await self.call("--list")
        self.assertEqual((code, len(out.splitlines())), (0, len(fc.FC.commands)))
        process.send_signal(signal.SIGTERM)
        await outcome(process)
        code, _, error = await self.call("get_robot_sn", *robot)
        self.assertEqual(code, 1)
        self.assertIn("cannot connect", error)


if __name__ == "__main__":
    unittest.main()
