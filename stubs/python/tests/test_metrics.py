"""The hook for metrics: the end of each call."""

from __future__ import annotations

import asyncio
import unittest
from typing import Any

import fc_runtime as rt
import sample
from virtual import Listener, Raw, clocked, serve, until

GET, DOCK, UNKNOWN = 0x0100, 0x0200, 0x0999
DOCKED = b'{"dock":"A"}'


class Slow(sample.PartialRobot):
    """A robot whose handler takes as long as the test says."""

    def __init__(self, seconds: float = 0.0) -> None:
        self.seconds = seconds

    def handlers_by_code(self) -> dict[int, Any]:
        return {GET: self.handle, DOCK: self.handle}

    async def handle(self, context: rt.Context, request: Any) -> Any:
        await asyncio.sleep(self.seconds)
        if context.code == GET:
            raise LookupError("secret")
        raise rt.Refusal(7, "no")


def fails(call: rt.EndedCall) -> None:
    raise LookupError(call.result)


class Metrics(unittest.TestCase):
    """Calls as the hook of each side gets them."""

    def check(self, calls: list[rt.EndedCall], since: float, expected: list[tuple[str, str, float]]) -> None:
        """Compares calls one after another. Each takes its seconds, and all together no more than the time since then.

        A busy machine may add time to any call.
        """
        found = [(call.operation, call.result) for call in calls]
        self.assertEqual(found, [(operation, result) for operation, result, _ in expected])
        for call, (*_, seconds) in zip(calls, expected, strict=True):
            self.assertGreater(call.seconds, seconds - 0.01, call)
        self.assertLessEqual(sum(call.seconds for call in calls), asyncio.get_running_loop().time() - since)

    @clocked
    async def test_client_tells_the_end_of_each_call(self) -> None:
        listener, calls = Listener(), list[rt.EndedCall]()
        config = rt.ClientConfig(host="127.0.0.1", command_port=await listener.listen(), on_call=calls.append)
        connection = rt.Connection(sample.SAMPLE, config)
        await connection.connect()
        robot = await listener.accept()
        since = asyncio.get_running_loop().time()

        async def answered(body: bytes, code: int = UNKNOWN) -> None:
            call = asyncio.ensure_future(connection.call_raw(code))
            frame = await robot.next()
            assert frame is not None
            await asyncio.sleep(0.2)
            robot.answer(frame, body)
            await asyncio.gather(call, return_exceptions=True)

        await answered(b'{"resultCode":1001}')
        await answered(b'{"resultCode":1001}', GET)
        await answered(b"[]", GET)
        with self.assertRaises(rt.CallTimeoutError):
            await connection.call_raw(DOCK, timeout=0.5)
        waiting = asyncio.ensure_future(connection.call_raw(DOCK))
        await until(lambda: connection.in_flight == 1)
        waiting.cancel()
        await asyncio.gather(waiting, return_exceptions=True)
        connection.close()
        with self.assertRaises(rt.ClosedError):
            await connection.call_raw(DOCK)
        with self.assertRaises(ValueError):
            await connection.call_raw(-1)
        names = sample.SAMPLE.commands_by_code
        self.check(
            calls,
            since,
            [
                ("unknown", "success", 0.2),
                (names[GET].name, "success", 0.2),
                (names[GET].name, "invalid_response", 0.2),
                (names[DOCK].name, "timeout", 0.5),
                (names[DOCK].name, "dropped", 0.0),
                (names[DOCK].name, "closed", 0.0),
            ],
        )
        listener.close()

    @clocked
    async def test_robot_tells_the_result_and_the_time_of_each_call(self) -> None:
        calls: list[rt.EndedCall] = []
        robot = Slow()
        server = await serve(robot, on_call=calls.append, handler_timeout=1.0)
        app = await Raw.connect(server.command_address)
        since = asyncio.get_running_loop().time()
        for number, (code, body, seconds) in enumerate(
            [(GET, b"{}", 0.0), (GET, b"[]", 0.0), (UNKNOWN, b"{}", 0.0), (DOCK, DOCKED, 0.2), (DOCK, DOCKED, 2.0)]
        ):
            robot.seconds = seconds
            app.send(code, body, number)
            await app.next()
        names = sample.SAMPLE.commands_by_code
        self.check(
            calls,
            since,
            [
                (names[GET].name, "protocol", 0.0),
                (names[GET].name, "invalid", 0.0),
                ("unknown", "protocol", 0.0),
                (names[DOCK].name, "refused", 0.2),
                (names[DOCK].name, "timeout", 1.0),
            ],
        )

    @clocked
    async def test_hook_that_fails_is_logged_and_harms_nothing(self) -> None:
        with self.assertLogs("fc_runtime", "ERROR") as log:
            server = await serve(Slow(), on_call=fails)
            host, port = server.command_address
            connection = rt.Connection(sample.SAMPLE, rt.ClientConfig(host=host, command_port=port, on_call=fails))
            await connection.connect()
            response = await connection.call_raw(DOCK, rt.Json(DOCKED.decode()))
            self.assertEqual(response.refusal and response.refusal.code, 7)
        failed = [line for line in log.output if "`on_call` failed: LookupError at " in line]
        self.assertEqual(len(failed), 2, log.output)
        self.assertNotIn("success", "".join(failed))
        connection.close()
